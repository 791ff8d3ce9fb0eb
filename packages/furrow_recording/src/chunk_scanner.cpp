#include "chunk_scanner.hpp"

#include <algorithm>
#include <utility>

namespace furrow::mcap {

void ChunkScanner::begin(const RecordPlace& place, ByteView content) {
  auto head = parse_chunk_head(content);
  if (!head || head->records_bytes > place.content_bytes - head->records_offset()) {
    faults_.add(place.offset, "a chunk is malformed");
    return;
  }
  OpenChunk chunk;
  chunk.place = place;
  chunk.index.offset = place.offset;
  chunk.index.length = place.end() - place.offset;
  chunk.index.compression = head->compression;
  chunk.index.compressed_size = head->records_bytes;
  chunk.index.uncompressed_size = head->uncompressed_size;
  chunk.head = std::move(*head);
  if (!contents_ || unpack(chunk, content)) {
    chunk_ = std::move(chunk);
  }
}

/// Reads the messages; false when the chunk is damaged, which is a fault.
bool ChunkScanner::unpack(OpenChunk& chunk, ByteView content) {
  if (Status status = unpack_chunk(content, limits_, true, records_); !status) {
    faults_.add(chunk.place.offset, status.error().message);
    return false;
  }
  chunk.unpacked = true;
  chunk.tally = {};
  const Status status =
      for_each_record(records_, [&](Opcode opcode, ByteView record, std::size_t offset) -> Status {
        if (opcode == Opcode::kSchema || opcode == Opcode::kChannel) {
          add_definition(definitions_, opcode, record, chunk.place.offset, faults_);
        } else if (opcode == Opcode::kMessage) {
          take_message(chunk, record, offset);
        }
        return {};
      });
  if (!status) {
    faults_.add(chunk.place.offset, status.error().message);
  }
  return true;
}

void ChunkScanner::take_message(OpenChunk& chunk, ByteView content, std::size_t offset) {
  const auto message = parse_message(content);
  if (!message || !definitions_.has_channel(message->channel_id)) {
    faults_.add(chunk.place.offset,
                message ? "a message has an unknown channel" : "a message is malformed");
    return;
  }
  chunk.tally.add(message->channel_id, message->log_time);
  if (contents_) {
    chunk.entries[message->channel_id].emplace_back(message->log_time, offset);
  }
}

void ChunkScanner::add_index(const RecordPlace& place, ByteView content) {
  auto index = parse_message_index(content);
  if (!index) {
    faults_.add(place.offset, "a message index is malformed");
    return;
  }
  if (!chunk_) {
    return;  // of a damaged chunk, which was reported
  }
  chunk_->index.message_index_offsets[index->channel_id] = place.offset;
  chunk_->index.message_index_length += place.end() - place.offset;
  if (!chunk_->unpacked) {
    for (const auto& [time, offset] : index->entries) {
      chunk_->tally.add(index->channel_id, time);
    }
    return;
  }
  auto& expected = chunk_->entries[index->channel_id];
  std::ranges::sort(index->entries);
  std::ranges::sort(expected);
  if (index->entries != expected) {
    faults_.add(place.offset, "a message index does not match its chunk");
  }
}

/// True when the message indexes agree with the chunk's own fields and name defined channels only.
bool ChunkScanner::is_described(const OpenChunk& chunk) const {
  const MessageTally& tally = chunk.tally;
  return tally.messages > 0 && tally.start == chunk.head.start_time &&
         tally.end == chunk.head.end_time &&
         std::ranges::all_of(tally.by_channel, [this](const auto& entry) {
           return definitions_.has_described_channel(entry.first);
         });
}

Status ChunkScanner::finish(const Source& source, DataSection& found) {
  if (!chunk_) {
    return {};
  }
  OpenChunk chunk = *std::exchange(chunk_, std::nullopt);
  if (chunk.unpacked) {
    check(chunk);
  } else if (!is_described(chunk)) {
    if (Status status = read_content(source, chunk.place, content_); !status) {
      return status;
    }
    if (!unpack(chunk, content_)) {
      return {};
    }
  }
  const MessageTally& tally = chunk.tally;
  if (tally.messages > 0) {
    chunk.index.start_time = tally.start;
    chunk.index.end_time = tally.end;
    found.spans.push_back(
        {tally.start, tally.end, chunk.index.offset, chunk.index.length, true, tally.channels()});
  }
  add_to(*found.summary.statistics, tally);
  ++found.summary.statistics->chunk_count;
  found.summary.chunks.push_back(std::move(chunk.index));
  return {};
}

/// Compares what an unpacked chunk holds with what is said about it.
void ChunkScanner::check(const OpenChunk& chunk) {
  const MessageTally& tally = chunk.tally;
  if (tally.messages > 0 &&
      (tally.start != chunk.head.start_time || tally.end != chunk.head.end_time)) {
    faults_.add(chunk.place.offset, "a chunk's times are not those of its messages");
  }
  const auto& indexed = chunk.index.message_index_offsets;
  const bool partly =
      !indexed.empty() && std::ranges::any_of(tally.by_channel, [&indexed](const auto& entry) {
        return !indexed.contains(entry.first);
      });
  if (partly) {
    faults_.add(chunk.place.offset, "a chunk has channels without a message index");
  }
}

}  // namespace furrow::mcap
