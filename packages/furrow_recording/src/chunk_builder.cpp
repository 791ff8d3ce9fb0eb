#include "chunk_builder.hpp"

#include "crc32.hpp"

namespace furrow::mcap {

void ChunkContent::add_head(const Message& message) {
  if (entries.size() <= message.channel_id) {
    entries.resize(message.channel_id + std::size_t{1});
  }
  entries[message.channel_id].emplace_back(message.log_time, records.size());
  ByteWriter out(records);
  put_head(out, message);
  tally.add(message.channel_id, message.log_time);
}

void ChunkContent::clear() {
  records.clear();
  for (auto& channel : entries) {
    channel.clear();
  }
  tally = {};
}

Result<PackedChunk> pack_chunk(Packer& packer, Compression compression,
                               const ChunkContent& content) {
  const auto packed = packer.pack(content.records);
  if (!packed) {
    return packed.error();
  }
  PackedChunk chunk;
  chunk.records = *packed;
  chunk.unpacked_crc = crc32(content.records);
  chunk.packed_crc = compression == Compression::kNone ? chunk.unpacked_crc : crc32(chunk.records);
  return chunk;
}

Result<ChunkIndex> append_chunk(FileAppender& file, const ChunkContent& content,
                                const PackedChunk& packed, Compression compression, ByteView tail) {
  const std::uint32_t tail_crc = crc32(tail);
  ChunkIndex index;
  index.start_time = content.tally.start;
  index.end_time = content.tally.end;
  index.offset = file.position();
  index.compression = compression_name(compression);
  index.compressed_size = packed.records.size() + tail.size();
  index.uncompressed_size = content.records.size() + tail.size();

  Bytes head;
  ByteWriter out(head);
  out.number(static_cast<std::uint8_t>(Opcode::kChunk));
  out.number(static_cast<std::uint64_t>(kChunkHeadBytes + index.compression.size() +
                                        index.compressed_size));
  out.time(index.start_time);
  out.time(index.end_time);
  out.number(index.uncompressed_size);
  out.number(crc32_combine(packed.unpacked_crc, tail_crc, tail.size()));
  out.string(index.compression);
  out.number(index.compressed_size);
  index.length = head.size() + index.compressed_size;

  Bytes indexes;
  ByteWriter index_out(indexes);
  for (std::size_t id = 0; id < content.entries.size(); ++id) {
    if (!content.entries[id].empty()) {
      const auto channel = static_cast<ChannelId>(id);
      index.message_index_offsets[channel] = index.offset + index.length + indexes.size();
      put(index_out, MessageIndex{channel, content.entries[id]});
    }
  }
  index.message_index_length = indexes.size();

  const FileAppender::Part body(packed.records, packed.packed_crc);
  const FileAppender::Part rest(tail, tail_crc);
  if (Status status = file.append({head, body, rest, indexes}); !status) {
    return status.error();
  }
  return index;
}

}  // namespace furrow::mcap
