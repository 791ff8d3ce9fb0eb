#include "data_section.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "compression.hpp"
#include "crc32.hpp"

namespace furrow::mcap {
namespace {

constexpr std::size_t kMaxFaults = 100;
constexpr std::uint64_t kMaxLooseBytes = 4u << 20;

bool equal(const Schema& a, const Schema& b) {
  return a.name == b.name && a.encoding == b.encoding && a.data == b.data;
}
bool equal(const Channel& a, const Channel& b) {
  return a.schema_id == b.schema_id && a.topic == b.topic &&
         a.message_encoding == b.message_encoding && a.metadata == b.metadata;
}

class Walk {
 public:
  Walk(const Source& source, const ReaderLimits& limits, const Summary& known)
      : source_(source), limits_(limits) {
    found_.summary.schemas = known.schemas;
    found_.summary.channels = known.channels;
  }

  Result<DataSection> run() {
    if (Status status = begin(); !status) {
      return status.error();
    }
    while (!found_.data_end) {
      const auto place = place_record(source_, at_, source_.size(), limits_);
      if (!place) {
        if (place.error().code == ErrorCode::kIo) {
          return place.error();
        }
        found_.stopped_by = place.error().message;
        break;
      }
      if (Status status = read_content(source_, *place, content_); !status) {
        return status.error();
      }
      place_ = *place;
      take();
      crc_ = add_to_crc();
      at_ = place_.end();
    }
    finish_chunk();
    found_.whole_bytes = at_;
    Statistics& statistics = *found_.summary.statistics;
    statistics.schema_count = static_cast<std::uint16_t>(found_.summary.schemas.size());
    statistics.channel_count = static_cast<std::uint32_t>(found_.summary.channels.size());
    statistics.attachment_count = static_cast<std::uint32_t>(found_.summary.attachments.size());
    statistics.metadata_count = static_cast<std::uint32_t>(found_.summary.metadata.size());
    found_.faults = faults_.list();
    return std::move(found_);
  }

 private:
  Status begin() {
    std::array<std::byte, kMagic.size()> magic{};
    if (source_.size() < magic.size()) {
      return Error{ErrorCode::kParse, "no MCAP file: shorter than its magic bytes"};
    }
    if (Status status = source_.read(0, magic); !status) {
      return status;
    }
    if (magic != kMagic) {
      return Error{ErrorCode::kParse, "no MCAP file: it does not begin with the magic bytes"};
    }
    const auto place = place_record(source_, magic.size(), source_.size(), limits_);
    if (!place) {
      return Error{ErrorCode::kParse, "the MCAP header is cut short"};
    }
    if (Status status = read_content(source_, *place, content_); !status) {
      return status;
    }
    auto header = parse_header(content_);
    if (place->opcode != Opcode::kHeader || !header) {
      return Error{ErrorCode::kParse, "no MCAP header behind the magic bytes"};
    }
    found_.header = std::move(*header);
    found_.summary.statistics.emplace();
    crc_ = crc32(magic);
    place_ = *place;
    crc_ = add_to_crc();
    at_ = place_.end();
    return {};
  }

  [[nodiscard]] std::uint32_t add_to_crc() const {
    Bytes head;
    ByteWriter out(head);
    out.number(static_cast<std::uint8_t>(place_.opcode));
    out.number(place_.content_bytes);
    return crc32(content_, crc32(head, crc_));
  }

  void fault(const std::string& what) { faults_.add(place_.offset, what); }

  void take() {
    if (place_.opcode != Opcode::kMessageIndex) {
      finish_chunk();
    }
    switch (place_.opcode) {
      case Opcode::kSchema:
      case Opcode::kChannel:
      case Opcode::kMessage:
        take_loose();
        break;
      case Opcode::kChunk:
        take_chunk();
        break;
      case Opcode::kMessageIndex:
        take_index();
        break;
      case Opcode::kAttachment:
        take_attachment();
        break;
      case Opcode::kMetadata:
        take_metadata();
        break;
      case Opcode::kDataEnd: {
        ByteReader in(content_);
        const auto crc = in.number<std::uint32_t>();
        if (!in.ok() || (crc != 0 && crc != crc_)) {
          fault("the CRC of the data section does not fit");
        }
        found_.data_end = true;
        break;
      }
      default:  // reserved for later versions and for extensions
        break;
    }
  }

  void take_loose() {
    if (Status status = take_record(place_.opcode, content_, 0); !status) {
      fault(status.error().message);
      return;
    }
    if (place_.opcode != Opcode::kMessage) {
      return;
    }
    const Time time = parse_message(content_)->log_time;
    auto& spans = found_.spans;
    if (spans.empty() || spans.back().chunk ||
        spans.back().offset + spans.back().length != place_.offset ||
        spans.back().length > kMaxLooseBytes) {
      spans.push_back({time, time, place_.offset, 0, false});
    }
    Span& span = spans.back();
    span.start_time = std::min(span.start_time, time);
    span.end_time = std::max(span.end_time, time);
    span.length = place_.end() - span.offset;
  }

  void take_chunk() {
    if (Status status = unpack_chunk(content_, limits_, true, records_); !status) {
      fault(status.error().message);
      return;
    }
    const auto chunk = parse_chunk(content_);
    in_chunk_ = true;
    entries_.clear();
    chunk_start_ = Time();
    chunk_end_ = Time();
    chunk_messages_ = 0;
    const Status status =
        for_each_record(records_, [this](Opcode opcode, ByteView content, std::size_t offset) {
          return take_record(opcode, content, offset);
        });
    if (!status) {
      fault(status.error().message);
    }
    if (chunk_start_ != chunk->start_time || chunk_end_ != chunk->end_time) {
      fault("a chunk's times are not those of its messages");
    }
    index_ = ChunkIndex();
    index_.start_time = chunk_start_;
    index_.end_time = chunk_end_;
    index_.offset = place_.offset;
    index_.length = place_.end() - place_.offset;
    index_.compression = chunk->compression;
    index_.compressed_size = chunk->records.size();
    index_.uncompressed_size = chunk->uncompressed_size;
    found_.spans.push_back({chunk_start_, chunk_end_, index_.offset, index_.length, true});
    ++found_.summary.statistics->chunk_count;
  }

  Status take_record(Opcode opcode, ByteView content, std::size_t offset) {
    if (opcode == Opcode::kSchema) {
      const auto schema = parse_schema(content);
      if (!schema) {
        return Error{ErrorCode::kParse, "a schema is malformed"};
      }
      if (schema->id != 0) {
        const auto [at, added] = found_.summary.schemas.try_emplace(schema->id, *schema);
        if (!added && !equal(at->second, *schema)) {
          return Error{ErrorCode::kParse, "two schemas have the same id"};
        }
      }
    } else if (opcode == Opcode::kChannel) {
      const auto channel = parse_channel(content);
      if (!channel) {
        return Error{ErrorCode::kParse, "a channel is malformed"};
      }
      if (channel->schema_id != 0 && !found_.summary.schemas.contains(channel->schema_id)) {
        return Error{ErrorCode::kParse, "channel " + channel->topic + " has no schema"};
      }
      const auto [at, added] = found_.summary.channels.try_emplace(channel->id, *channel);
      if (!added && !equal(at->second, *channel)) {
        return Error{ErrorCode::kParse, "two channels have the same id"};
      }
    } else if (opcode == Opcode::kMessage) {
      return take_message(content, offset);
    }
    return {};
  }

  Status take_message(ByteView content, std::size_t offset) {
    const auto message = parse_message(content);
    if (!message) {
      return Error{ErrorCode::kParse, "a message is malformed"};
    }
    if (!found_.summary.channels.contains(message->channel_id)) {
      return Error{ErrorCode::kParse, "a message is of an unknown channel"};
    }
    Statistics& all = *found_.summary.statistics;
    const Time time = message->log_time;
    all.start_time = all.message_count == 0 ? time : std::min(all.start_time, time);
    all.end_time = all.message_count == 0 ? time : std::max(all.end_time, time);
    ++all.message_count;
    ++all.channel_message_counts[message->channel_id];
    if (in_chunk_) {
      chunk_start_ = chunk_messages_ == 0 ? time : std::min(chunk_start_, time);
      chunk_end_ = chunk_messages_ == 0 ? time : std::max(chunk_end_, time);
      ++chunk_messages_;
      entries_[message->channel_id].emplace_back(time, offset);
    }
    return {};
  }

  void take_index() {
    const auto index = parse_message_index(content_);
    if (!index) {
      fault("a message index is malformed");
      return;
    }
    if (!in_chunk_) {
      return;  // its chunk was left out, and reported
    }
    auto entries = index->entries;
    auto expected = entries_.contains(index->channel_id) ? entries_.at(index->channel_id)
                                                         : std::vector<IndexEntry>();
    std::sort(entries.begin(), entries.end());
    std::sort(expected.begin(), expected.end());
    if (entries != expected) {
      fault("a message index does not fit its chunk");
    }
    index_.message_index_offsets[index->channel_id] = place_.offset;
    index_.message_index_length += place_.end() - place_.offset;
  }

  void finish_chunk() {
    if (!in_chunk_) {
      return;
    }
    in_chunk_ = false;
    found_.summary.chunks.push_back(std::move(index_));
  }

  void take_attachment() {
    const auto attachment = parse_attachment(content_);
    if (!attachment) {
      fault("an attachment is malformed or its CRC does not fit");
      return;
    }
    found_.summary.attachments.push_back(
        {place_.offset, place_.end() - place_.offset, attachment->log_time, attachment->create_time,
         attachment->data.size(), attachment->name, attachment->media_type});
  }

  void take_metadata() {
    const auto metadata = parse_metadata(content_);
    if (!metadata) {
      fault("a metadata record is malformed");
      return;
    }
    found_.summary.metadata.push_back(
        {place_.offset, place_.end() - place_.offset, metadata->name});
  }

  const Source& source_;
  const ReaderLimits& limits_;
  DataSection found_;
  Faults faults_;
  std::uint64_t at_ = 0;
  std::uint32_t crc_ = 0;
  RecordPlace place_;
  Bytes content_;
  Bytes records_;

  // Of the chunk whose message indexes are being read.
  bool in_chunk_ = false;
  std::map<ChannelId, std::vector<IndexEntry>> entries_;
  Time chunk_start_;
  Time chunk_end_;
  std::uint64_t chunk_messages_ = 0;
  ChunkIndex index_;
};

}  // namespace

void Faults::add(std::uint64_t offset, const std::string& what) {
  if (list_.size() < kMaxFaults) {
    list_.push_back("at byte " + std::to_string(offset) + ": " + what);
  }
}

Result<DataSection> walk_data_section(const Source& source, const ReaderLimits& limits,
                                      const Summary& known) {
  return Walk(source, limits, known).run();
}

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
                                             " bytes is larger than allowed"};
  }
  return place;
}

Status read_content(const Source& source, const RecordPlace& place, Bytes& content) {
  content.resize(static_cast<std::size_t>(place.content_bytes));
  return source.read(place.offset + kRecordHeaderBytes, content);
}

Status unpack_chunk(ByteView content, const ReaderLimits& limits, bool check_crc, Bytes& records) {
  const auto chunk = parse_chunk(content);
  if (!chunk) {
    return Error{ErrorCode::kParse, "a chunk is malformed"};
  }
  const auto compression = compression_from_name(chunk->compression);
  if (!compression) {
    return Error{ErrorCode::kParse,
                 "a chunk has the unknown compression '" + chunk->compression.substr(0, 20) + "'"};
  }
  if (chunk->uncompressed_size > limits.record_bytes) {
    return Error{ErrorCode::kOutOfRange, "a chunk of " + std::to_string(chunk->uncompressed_size) +
                                             " bytes is larger than allowed"};
  }
  if (Status status = unpack(*compression, chunk->records, chunk->uncompressed_size, records);
      !status) {
    return status;
  }
  if (check_crc && chunk->uncompressed_crc != 0 && chunk->uncompressed_crc != crc32(records)) {
    return Error{ErrorCode::kParse, "the CRC of a chunk does not fit"};
  }
  return {};
}

}  // namespace furrow::mcap
