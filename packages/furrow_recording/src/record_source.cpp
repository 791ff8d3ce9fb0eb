#include "record_source.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "compression.hpp"
#include "crc32.hpp"

namespace furrow::mcap {
namespace {

/// Larger reads go past the buffer. Message indexes of a chunk of images fit in.
constexpr std::size_t kBufferBytes = 1u << 13;

}  // namespace

Result<RecordPlace> place_record(const Source& source, std::uint64_t offset, std::uint64_t end,
                                 const ReaderLimits& limits) {
  if (offset > end || end - offset < kRecordHeaderBytes) {
    return Error{ErrorCode::kParse, "a record is cut short"};
  }
  std::array<std::byte, kRecordHeaderBytes> head{};
  if (Status status = source.read(offset, head); !status) {
    return status.error();
  }
  ByteReader in(head);
  RecordPlace place;
  place.opcode = static_cast<Opcode>(in.number<std::uint8_t>());
  place.offset = offset;
  place.content_bytes = in.number<std::uint64_t>();
  if (place.content_bytes > end - offset - kRecordHeaderBytes) {
    return Error{ErrorCode::kParse, "a record is cut short or its length is wrong"};
  }
  if (place.content_bytes > limits.record_bytes) {
    return Error{ErrorCode::kOutOfRange, "a record of " + std::to_string(place.content_bytes) +
                                             " bytes is larger than the limit of " +
                                             std::to_string(limits.record_bytes)};
  }
  return place;
}

Status read_content(const Source& source, const RecordPlace& place, Bytes& content,
                    std::uint64_t max_bytes) {
  content.resize(static_cast<std::size_t>(std::min(place.content_bytes, max_bytes)));
  return source.read(place.offset + kRecordHeaderBytes, content);
}

Status unpack_chunk(ByteView content, const ReaderLimits& limits, bool check_crc, Bytes& records) {
  const auto head = parse_chunk_head(content);
  if (!head || head->records_bytes > content.size() - head->records_offset()) {
    return Error{ErrorCode::kParse, "a chunk is malformed"};
  }
  const auto compression = compression_from_name(head->compression);
  if (!compression) {
    return Error{ErrorCode::kParse,
                 "a chunk has the unknown compression '" + head->compression.substr(0, 20) + "'"};
  }
  if (head->uncompressed_size > limits.record_bytes) {
    return Error{ErrorCode::kOutOfRange, "a chunk of " + std::to_string(head->uncompressed_size) +
                                             " bytes is larger than the limit of " +
                                             std::to_string(limits.record_bytes)};
  }
  const ByteView packed =
      content.subspan(head->records_offset(), static_cast<std::size_t>(head->records_bytes));
  if (Status status = unpack(*compression, packed, head->uncompressed_size, records); !status) {
    return status;
  }
  if (check_crc && head->uncompressed_crc != 0 && head->uncompressed_crc != crc32(records)) {
    return Error{ErrorCode::kParse, "the CRC of a chunk does not match its content"};
  }
  return {};
}

Status BufferedSource::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  if (bytes.size() > kBufferBytes || offset > source_.size() ||
      bytes.size() > source_.size() - offset) {
    return source_.read(offset, bytes);
  }
  if (offset < start_ || offset + bytes.size() > start_ + buffer_.size()) {
    buffer_.resize(
        static_cast<std::size_t>(std::min<std::uint64_t>(kBufferBytes, source_.size() - offset)));
    start_ = offset;
    if (Status status = source_.read(offset, buffer_); !status) {
      buffer_.clear();
      return status;
    }
  }
  std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(offset - start_), bytes.size(),
              bytes.begin());
  return {};
}

}  // namespace furrow::mcap
