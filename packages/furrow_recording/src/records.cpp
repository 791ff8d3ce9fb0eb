#include "records.hpp"

#include <algorithm>

#include "crc32.hpp"

namespace furrow::mcap {
namespace {

std::size_t begin(ByteWriter& out, Opcode opcode) {
  return out.begin_record(static_cast<std::uint8_t>(opcode));
}

template <class T>
std::optional<T> checked(const ByteReader& in, T value) {
  return in.ok() ? std::optional<T>(std::move(value)) : std::nullopt;
}

}  // namespace

void put(ByteWriter& out, const Header& header) {
  const auto at = begin(out, Opcode::kHeader);
  out.string(header.profile);
  out.string(header.library);
  out.end_record(at);
}

void put(ByteWriter& out, const Schema& schema) {
  const auto at = begin(out, Opcode::kSchema);
  out.number(schema.id);
  out.string(schema.name);
  out.string(schema.encoding);
  out.string(schema.data);
  out.end_record(at);
}

void put(ByteWriter& out, const Channel& channel) {
  const auto at = begin(out, Opcode::kChannel);
  out.number(channel.id);
  out.number(channel.schema_id);
  out.string(channel.topic);
  out.string(channel.message_encoding);
  out.map(channel.metadata);
  out.end_record(at);
}

void put_head(ByteWriter& out, const Message& message) {
  out.number(static_cast<std::uint8_t>(Opcode::kMessage));
  out.number(static_cast<std::uint64_t>(kMessageHeaderBytes + message.data.size()));
  out.number(message.channel_id);
  out.number(message.sequence);
  out.time(message.log_time);
  out.time(message.publish_time);
}

void put(ByteWriter& out, const MessageIndex& index) {
  const auto at = begin(out, Opcode::kMessageIndex);
  out.number(index.channel_id);
  out.number(static_cast<std::uint32_t>(index.entries.size() * 16));
  for (const auto& [time, offset] : index.entries) {
    out.time(time);
    out.number(offset);
  }
  out.end_record(at);
}

void put(ByteWriter& out, const ChunkIndex& index) {
  const auto at = begin(out, Opcode::kChunkIndex);
  out.time(index.start_time);
  out.time(index.end_time);
  out.number(index.offset);
  out.number(index.length);
  out.map(index.message_index_offsets);
  out.number(index.message_index_length);
  out.string(index.compression);
  out.number(index.compressed_size);
  out.number(index.uncompressed_size);
  out.end_record(at);
}

void put(ByteWriter& out, const Attachment& attachment) {
  const auto at = begin(out, Opcode::kAttachment);
  out.time(attachment.log_time);
  out.time(attachment.create_time);
  out.string(attachment.name);
  out.string(attachment.media_type);
  out.number(static_cast<std::uint64_t>(attachment.data.size()));
  out.raw(attachment.data);
  out.number(crc32(out.content_of(at)));
  out.end_record(at);
}

void put(ByteWriter& out, const AttachmentIndex& index) {
  const auto at = begin(out, Opcode::kAttachmentIndex);
  out.number(index.offset);
  out.number(index.length);
  out.time(index.log_time);
  out.time(index.create_time);
  out.number(index.data_size);
  out.string(index.name);
  out.string(index.media_type);
  out.end_record(at);
}

void put(ByteWriter& out, const Statistics& statistics) {
  const auto at = begin(out, Opcode::kStatistics);
  out.number(statistics.message_count);
  out.number(statistics.schema_count);
  out.number(statistics.channel_count);
  out.number(statistics.attachment_count);
  out.number(statistics.metadata_count);
  out.number(statistics.chunk_count);
  out.time(statistics.start_time);
  out.time(statistics.end_time);
  out.map(statistics.channel_message_counts);
  out.end_record(at);
}

void put(ByteWriter& out, const Metadata& metadata) {
  const auto at = begin(out, Opcode::kMetadata);
  out.string(metadata.name);
  out.map(metadata.values);
  out.end_record(at);
}

void put(ByteWriter& out, const MetadataIndex& index) {
  const auto at = begin(out, Opcode::kMetadataIndex);
  out.number(index.offset);
  out.number(index.length);
  out.string(index.name);
  out.end_record(at);
}

void put_data_end(ByteWriter& out, std::uint32_t crc) {
  const auto at = begin(out, Opcode::kDataEnd);
  out.number(crc);
  out.end_record(at);
}

void put_summary_offset(ByteWriter& out, Opcode group, std::uint64_t start, std::uint64_t length) {
  const auto at = begin(out, Opcode::kSummaryOffset);
  out.number(static_cast<std::uint8_t>(group));
  out.number(start);
  out.number(length);
  out.end_record(at);
}

std::optional<Header> parse_header(ByteView content) {
  ByteReader in(content);
  Header header;
  header.profile = in.string();
  header.library = in.string();
  return checked(in, std::move(header));
}

std::optional<Schema> parse_schema(ByteView content) {
  ByteReader in(content);
  Schema schema;
  schema.id = in.number<SchemaId>();
  schema.name = in.string();
  schema.encoding = in.string();
  schema.data = in.string();
  return checked(in, std::move(schema));
}

std::optional<Channel> parse_channel(ByteView content) {
  ByteReader in(content);
  Channel channel;
  channel.id = in.number<ChannelId>();
  channel.schema_id = in.number<SchemaId>();
  channel.topic = in.string();
  channel.message_encoding = in.string();
  channel.metadata = in.string_map();
  return checked(in, std::move(channel));
}

std::optional<Message> parse_message(ByteView content) {
  ByteReader in(content);
  Message message;
  message.channel_id = in.number<ChannelId>();
  message.sequence = in.number<std::uint32_t>();
  message.log_time = in.time();
  message.publish_time = in.described_time();
  message.data = in.rest();
  return checked(in, message);
}

std::optional<ChunkHead> parse_chunk_head(ByteView content) {
  ByteReader in(content);
  ChunkHead chunk;
  chunk.start_time = in.described_time();
  chunk.end_time = in.described_time();
  chunk.uncompressed_size = in.number<std::uint64_t>();
  chunk.uncompressed_crc = in.number<std::uint32_t>();
  chunk.compression = in.string();
  chunk.records_bytes = in.number<std::uint64_t>();
  return checked(in, std::move(chunk));
}

std::optional<MessageIndex> parse_message_index(ByteView content) {
  ByteReader in(content);
  MessageIndex index;
  index.channel_id = in.number<ChannelId>();
  ByteReader entries(in.raw(in.number<std::uint32_t>()));
  while (entries.ok() && entries.left() > 0) {
    const Time time = entries.time();
    index.entries.emplace_back(time, entries.number<std::uint64_t>());
  }
  return entries.ok() ? checked(in, std::move(index)) : std::nullopt;
}

std::optional<ChunkIndex> parse_chunk_index(ByteView content) {
  ByteReader in(content);
  ChunkIndex index;
  index.start_time = in.described_time();
  index.end_time = in.described_time();
  index.offset = in.number<std::uint64_t>();
  index.length = in.number<std::uint64_t>();
  index.message_index_offsets = in.number_map();
  index.message_index_length = in.number<std::uint64_t>();
  index.compression = in.string();
  index.compressed_size = in.number<std::uint64_t>();
  index.uncompressed_size = in.number<std::uint64_t>();
  return checked(in, std::move(index));
}

std::optional<AttachmentHead> parse_attachment_head(ByteView content) {
  ByteReader in(content);
  AttachmentHead head;
  head.log_time = in.described_time();
  head.create_time = in.described_time();
  head.name = in.string();
  head.media_type = in.string();
  head.data_bytes = in.number<std::uint64_t>();
  head.data_offset = content.size() - in.left();
  return checked(in, std::move(head));
}

std::optional<Attachment> parse_attachment(ByteView content) {
  const auto head = parse_attachment_head(content);
  if (!head) {
    return std::nullopt;
  }
  ByteReader in(content.subspan(head->data_offset));
  const ByteView data = in.raw(head->data_bytes);
  const std::size_t checked_bytes = content.size() - in.left();
  const auto crc = in.number<std::uint32_t>();
  if (!in.ok() || (crc != 0 && crc != crc32(content.first(checked_bytes)))) {
    return std::nullopt;
  }
  return Attachment{
      head->log_time, head->create_time, head->name, head->media_type, {data.begin(), data.end()}};
}

std::optional<AttachmentIndex> parse_attachment_index(ByteView content) {
  ByteReader in(content);
  AttachmentIndex index;
  index.offset = in.number<std::uint64_t>();
  index.length = in.number<std::uint64_t>();
  index.log_time = in.described_time();
  index.create_time = in.described_time();
  index.data_size = in.number<std::uint64_t>();
  index.name = in.string();
  index.media_type = in.string();
  return checked(in, std::move(index));
}

std::optional<Statistics> parse_statistics(ByteView content) {
  ByteReader in(content);
  Statistics statistics;
  statistics.message_count = in.number<std::uint64_t>();
  statistics.schema_count = in.number<std::uint16_t>();
  statistics.channel_count = in.number<std::uint32_t>();
  statistics.attachment_count = in.number<std::uint32_t>();
  statistics.metadata_count = in.number<std::uint32_t>();
  statistics.chunk_count = in.number<std::uint32_t>();
  statistics.start_time = in.described_time();
  statistics.end_time = in.described_time();
  statistics.channel_message_counts = in.number_map();
  return checked(in, std::move(statistics));
}

std::optional<Metadata> parse_metadata(ByteView content) {
  ByteReader in(content);
  Metadata metadata;
  metadata.name = in.string();
  metadata.values = in.string_map();
  return checked(in, std::move(metadata));
}

std::optional<MetadataIndex> parse_metadata_index(ByteView content) {
  ByteReader in(content);
  MetadataIndex index;
  index.offset = in.number<std::uint64_t>();
  index.length = in.number<std::uint64_t>();
  index.name = in.string();
  return checked(in, std::move(index));
}

std::optional<Footer> parse_footer(ByteView content) {
  ByteReader in(content);
  Footer footer;
  footer.summary_start = in.number<std::uint64_t>();
  footer.summary_offset_start = in.number<std::uint64_t>();
  footer.summary_crc = in.number<std::uint32_t>();
  return checked(in, footer);
}

Status for_each_record(
    ByteView records,
    const std::function<Status(Opcode opcode, ByteView content, std::size_t offset)>& visit) {
  ByteReader in(records);
  while (in.left() > 0) {
    const std::size_t offset = records.size() - in.left();
    const auto opcode = in.number<std::uint8_t>();
    const ByteView content = in.raw(in.number<std::uint64_t>());
    if (!in.ok()) {
      return Error{ErrorCode::kParse, "a record is cut short inside a chunk"};
    }
    if (Status status = visit(static_cast<Opcode>(opcode), content, offset); !status) {
      return status;
    }
  }
  return {};
}

}  // namespace furrow::mcap
