#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_recording/byte_stream.hpp"
#include "furrow_recording/mcap_reader.hpp"
#include "furrow_recording/mcap_types.hpp"

namespace furrow::mcap {

/// A part of a file that unpacks to messages: a chunk, or adjacent messages outside of chunks.
struct Span {
  Time start_time;           ///< of its first message by log time
  Time end_time;             ///< of its last
  std::uint64_t offset = 0;  ///< of the Chunk record, or of the first message
  std::uint64_t length = 0;
  bool chunk = true;
  std::vector<ChannelId> channels;  ///< of its messages, sorted
};

/// Faults of a file. The first hundred are kept.
class Faults {
 public:
  void add(std::uint64_t offset, const std::string& what);
  [[nodiscard]] const std::vector<std::string>& list() const { return list_; }

 private:
  std::vector<std::string> list_;
};

/// How far scan_data_section() looks into chunks.
enum class ScanDepth : std::uint8_t {
  /// Chunk headers and message indexes. Chunks are unpacked only where these are missing,
  /// contradict each other, or name a channel that is not defined outside of chunks.
  kIndexes,
  /// Every byte, with all CRCs and indexes compared.
  kContents,
};

/// What a pass over a file's data section found.
struct DataSection {
  Header header;
  Summary summary;          ///< what the end of the file should say; `statistics` is set
  std::vector<Span> spans;  ///< in the order of the file, none without messages
  std::vector<std::string> faults;
  bool data_end = false;          ///< the DataEnd record was reached
  std::uint64_t whole_bytes = 0;  ///< up to the end of the last whole record
  std::string stopped_by;         ///< why the pass ended, when not by DataEnd
};

/// What the end of a file repeats of its data section.
struct RepeatedSummary {
  Summary summary;
  bool checked = false;  ///< by the CRC of the summary
};

/// Passes over the records from the start of the file to DataEnd, or to the first record that is
/// not whole. Nothing that is optional is trusted: counts, times and channels come from the data
/// section. `repeated` is the file's summary, if it has one. It defines channels of chunks that are
/// not unpacked, and names the next record behind one whose length is damaged.
/// Records outside of chunks have no CRC. If one contradicts a checked summary, that is a fault,
/// and the summary is believed. kParse when not even the header is whole; kIo.
[[nodiscard]] Result<DataSection> scan_data_section(const Source& source,
                                                    const ReaderLimits& limits, ScanDepth depth,
                                                    const RepeatedSummary& repeated = {});

}  // namespace furrow::mcap
