#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "bytes.hpp"
#include "furrow_core/result.hpp"
#include "furrow_recording/mcap_types.hpp"

namespace furrow::mcap {

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

inline constexpr std::array<std::byte, 8> kMagic = {std::byte{0x89}, std::byte{'M'}, std::byte{'C'},
                                                    std::byte{'A'},  std::byte{'P'}, std::byte{'0'},
                                                    std::byte{'\r'}, std::byte{'\n'}};
inline constexpr std::size_t kRecordHeaderBytes = 9;  ///< opcode and length
inline constexpr std::size_t kMessageHeaderBytes = 22;
inline constexpr std::size_t kFooterBytes = 20;
/// The fixed fields of a Chunk record before its records.
inline constexpr std::size_t kChunkHeadBytes = 8 + 8 + 8 + 4 + 4 + 8;
/// Footer record and magic bytes at the end of a file.
inline constexpr std::size_t kTailBytes = kRecordHeaderBytes + kFooterBytes + kMagic.size();

/// The fields of a Chunk record before its records. Times are what its writer says: some writers
/// put any value into a chunk without messages.
struct ChunkHead {
  Time start_time;
  Time end_time;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;
  std::string compression;
  std::uint64_t records_bytes = 0;  ///< compressed

  /// Where the compressed records begin in the record's content.
  [[nodiscard]] std::size_t records_offset() const { return kChunkHeadBytes + compression.size(); }
};

/// The fields of an Attachment record before its data.
struct AttachmentHead {
  Time log_time;
  Time create_time;
  std::string name;
  std::string media_type;
  std::uint64_t data_bytes = 0;
  std::size_t data_offset = 0;  ///< in the record's content
};

using IndexEntry = std::pair<Time, std::uint64_t>;  ///< log time, offset in the unpacked chunk
struct MessageIndex {
  ChannelId channel_id = 0;
  std::vector<IndexEntry> entries;
};

struct Footer {
  std::uint64_t summary_start = 0;
  std::uint64_t summary_offset_start = 0;
  std::uint32_t summary_crc = 0;
};

// Each appends a whole record.
void put(ByteWriter& out, const Header& header);
void put(ByteWriter& out, const Schema& schema);
void put(ByteWriter& out, const Channel& channel);
/// Appends a Message record without its data.
void put_head(ByteWriter& out, const Message& message);
void put(ByteWriter& out, const MessageIndex& index);
void put(ByteWriter& out, const ChunkIndex& index);
void put(ByteWriter& out, const Attachment& attachment);
void put(ByteWriter& out, const AttachmentIndex& index);
void put(ByteWriter& out, const Statistics& statistics);
void put(ByteWriter& out, const Metadata& metadata);
void put(ByteWriter& out, const MetadataIndex& index);
void put_data_end(ByteWriter& out, std::uint32_t crc);
void put_summary_offset(ByteWriter& out, Opcode group, std::uint64_t start, std::uint64_t length);

// Each parses the content of a record; none when it is cut short or malformed. Extra bytes at the
// end are ignored, as the specification asks.
[[nodiscard]] std::optional<Header> parse_header(ByteView content);
[[nodiscard]] std::optional<Schema> parse_schema(ByteView content);
[[nodiscard]] std::optional<Channel> parse_channel(ByteView content);
/// `data` is a view of `content`.
[[nodiscard]] std::optional<Message> parse_message(ByteView content);
/// `content` may end behind the fields.
[[nodiscard]] std::optional<ChunkHead> parse_chunk_head(ByteView content);
[[nodiscard]] std::optional<MessageIndex> parse_message_index(ByteView content);
[[nodiscard]] std::optional<ChunkIndex> parse_chunk_index(ByteView content);
/// `content` may end behind the fields.
[[nodiscard]] std::optional<AttachmentHead> parse_attachment_head(ByteView content);
/// Also none when the CRC does not match the content.
[[nodiscard]] std::optional<Attachment> parse_attachment(ByteView content);
[[nodiscard]] std::optional<AttachmentIndex> parse_attachment_index(ByteView content);
[[nodiscard]] std::optional<Statistics> parse_statistics(ByteView content);
[[nodiscard]] std::optional<Metadata> parse_metadata(ByteView content);
[[nodiscard]] std::optional<MetadataIndex> parse_metadata_index(ByteView content);
[[nodiscard]] std::optional<Footer> parse_footer(ByteView content);

/// Calls `visit(opcode, content, offset)` for each record of an unpacked chunk, up to its first
/// error. kParse when the last record is cut short.
[[nodiscard]] Status for_each_record(
    ByteView records,
    const std::function<Status(Opcode opcode, ByteView content, std::size_t offset)>& visit);

}  // namespace furrow::mcap
