#pragma once

#include <cstdint>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_recording/byte_stream.hpp"
#include "furrow_recording/mcap_reader.hpp"
#include "records.hpp"

namespace furrow::mcap {

/// Where a record is in a file.
struct RecordPlace {
  Opcode opcode = Opcode::kHeader;
  std::uint64_t offset = 0;
  std::uint64_t content_bytes = 0;
  [[nodiscard]] std::uint64_t end() const { return offset + kRecordHeaderBytes + content_bytes; }
};

/// The record at `offset`. kParse when it does not end before `end`, kOutOfRange above the limits.
[[nodiscard]] Result<RecordPlace> place_record(const Source& source, std::uint64_t offset,
                                               std::uint64_t end, const ReaderLimits& limits);
/// Reads the record's content, at most `max_bytes` of it, into `content`, whose memory is reused.
[[nodiscard]] Status read_content(const Source& source, const RecordPlace& place, Bytes& content,
                                  std::uint64_t max_bytes = UINT64_MAX);

/// Unpacks the records of a Chunk record's content. kParse when they do not match their CRC, size
/// or compression.
[[nodiscard]] Status unpack_chunk(ByteView content, const ReaderLimits& limits, bool check_crc,
                                  Bytes& records);

/// Serves small reads from one buffer, so that a walk over record headers needs one system call for
/// several of them. Not thread-safe.
class BufferedSource final : public Source {
 public:
  explicit BufferedSource(const Source& source) : source_(source) {}
  [[nodiscard]] std::uint64_t size() const override { return source_.size(); }
  [[nodiscard]] Status read(std::uint64_t offset, std::span<std::byte> bytes) const override;

 private:
  const Source& source_;
  mutable Bytes buffer_;
  mutable std::uint64_t start_ = 0;
};

}  // namespace furrow::mcap
