#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_recording/byte_stream.hpp"
#include "furrow_recording/mcap_reader.hpp"
#include "furrow_recording/mcap_types.hpp"
#include "records.hpp"

namespace furrow::mcap {

/// A part of a file that unpacks to records: a chunk, or messages that stand outside of chunks.
struct Span {
  Time start_time;
  Time end_time;
  std::uint64_t offset = 0;  ///< of the Chunk record, or of the first record
  std::uint64_t length = 0;
  bool chunk = true;
};

/// Faults of a file, of which the first hundred are kept.
class Faults {
 public:
  void add(std::uint64_t offset, const std::string& what);
  [[nodiscard]] const std::vector<std::string>& list() const { return list_; }

 private:
  std::vector<std::string> list_;
};

/// What a walk from the beginning of a file found.
struct DataSection {
  Header header;
  Summary summary;  ///< as the end of the file should say it
  std::vector<Span> spans;
  std::vector<std::string> faults;
  bool data_end = false;          ///< the DataEnd record was there
  std::uint64_t whole_bytes = 0;  ///< up to the end of the last whole record
  std::string stopped_by;         ///< why the walk ended, when not by DataEnd
};

/// Reads every byte up to DataEnd or the first record that is not whole, unpacks and checks. kParse
/// when not even the header is whole; kIo. `known`: schemas and channels that count as defined.
[[nodiscard]] Result<DataSection> walk_data_section(const Source& source,
                                                    const ReaderLimits& limits,
                                                    const Summary& known = {});

struct RecordPlace {
  Opcode opcode = Opcode::kHeader;
  std::uint64_t offset = 0;
  std::uint64_t content_bytes = 0;
  [[nodiscard]] std::uint64_t end() const { return offset + kRecordHeaderBytes + content_bytes; }
};

/// The record at `offset`; kParse when it does not end before `end`, kOutOfRange above the limits.
[[nodiscard]] Result<RecordPlace> place_record(const Source& source, std::uint64_t offset,
                                               std::uint64_t end, const ReaderLimits& limits);
/// Its content, into memory that may be reused.
[[nodiscard]] Status read_content(const Source& source, const RecordPlace& place, Bytes& content);

/// The records of a chunk's content, unpacked and, unless told otherwise, checked.
[[nodiscard]] Status unpack_chunk(ByteView content, const ReaderLimits& limits, bool check_crc,
                                  Bytes& records);

}  // namespace furrow::mcap
