#include "bag_scan.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "compression.hpp"
#include "record_source.hpp"

namespace furrow::recording {
namespace {

constexpr std::uint64_t kMaxLooseSpanBytes = 4u << 20;
constexpr std::uint32_t kIndexVersion = 1;

/// Counts and times of the messages of a chunk.
void add_message(BagSpan& span, std::uint32_t connection, Time time) {
  const bool first = span.messages.empty();
  span.start = first ? time : std::min(span.start, time);
  span.end = first ? time : std::max(span.end, time);
  ++span.messages[connection];
}

class BagScanner {
 public:
  BagScanner(const mcap::Source& source, const OpenOptions& options)
      : source_(source), buffered_(source), options_(options) {}

  Result<BagContent> run() {
    if (Status status = check_magic(); !status) {
      return status.error();
    }
    std::uint64_t at = kBagMagic.size();
    while (at < source_.size()) {
      auto place = place_bag_record(buffered_, at, options_.limits.record_bytes);
      if (!place) {
        if (place.error().code == ErrorCode::kIo) {
          return place.error();
        }
        found_.damage = "the end is missing: " + place.error().message;
        found_.bytes_ignored = source_.size() - at;
        break;
      }
      at = place->end();
      if (Status status = take(*place); !status) {
        return status.error();
      }
    }
    for (Chunk& chunk : chunks_) {
      if (Status status = finish(chunk); !status) {
        return status.error();
      }
    }
    check_end();
    return finish();
  }

 private:
  struct Chunk {
    BagPlace place;
    BagSpan span;
    bool indexed = false;
  };
  struct ChunkInfo {
    Time start;
    Time end;
    std::map<std::uint32_t, std::uint64_t> messages;
  };

  Status check_magic() {
    Bytes magic(kBagMagic.size());
    if (source_.size() < magic.size()) {
      return Error{ErrorCode::kParse, "not a ROS 1 bag: shorter than its first line"};
    }
    if (Status status = source_.read(0, magic); !status) {
      return status;
    }
    const std::string_view text(reinterpret_cast<const char*>(magic.data()), magic.size());
    if (text == kBagMagic) {
      return {};
    }
    if (text.starts_with(kAnyBagMagic)) {
      return Error{ErrorCode::kParse,
                   "a ROS 1 bag of another version than 2.0; convert it with "
                   "'rosbag fix' of ROS 1"};
    }
    return Error{ErrorCode::kParse, "not a ROS 1 bag"};
  }

  void fault(std::uint64_t offset, const std::string& what) { faults_.add(offset, what); }

  Status take(BagPlace& place) {
    switch (place.op) {
      case BagOp::kBagHeader:
        return take_bag_header(place);
      case BagOp::kConnection:
        return with_data(place, [this, &place](ByteView data) {
          add_connection(place.fields, data, place.offset);
          if (index_ && place.offset >= *index_) {
            indexed_connections_.insert(place.fields.number("conn").value_or(0));
          }
        });
      case BagOp::kChunk:
        begin_chunk(place);
        return {};
      case BagOp::kIndex:
        return with_data(place, [this, &place](ByteView data) { add_index(place, data); });
      case BagOp::kChunkInfo:
        return with_data(place, [this, &place](ByteView data) { add_chunk_info(place, data); });
      case BagOp::kMessage:
        add_loose_message(place);
        return {};
    }
    return {};  // of a later version
  }

  template <class Use>
  Status with_data(const BagPlace& place, Use use) {
    data_.resize(static_cast<std::size_t>(place.data_bytes));
    if (Status status = buffered_.read(place.data_offset, data_); !status) {
      return status;
    }
    use(data_);
    return {};
  }

  Status take_bag_header(const BagPlace& place) {
    const auto encryptor = place.fields.text("encryptor");
    if (encryptor && !encryptor->empty()) {
      return Error{ErrorCode::kParse, "the bag is encrypted by '" + encryptor->substr(0, 60) + "'"};
    }
    const auto index = place.fields.number64("index_pos").value_or(0);
    if (index == 0) {
      found_.damage = "the bag was not closed: it has no index";
    } else if (index > source_.size()) {
      found_.damage = "the end is missing: the index would be behind it";
    }
    index_ = index;
    announced_connections_ = place.fields.number("conn_count").value_or(0);
    announced_chunks_ = place.fields.number("chunk_count").value_or(0);
    return {};
  }

  /// A bag that was cut between two records ends with a whole record.
  void check_end() {
    if (!found_.damage.empty()) {
      return;
    }
    if (!index_) {
      found_.damage = "the bag has no bag header";
    } else if (infos_.size() < announced_chunks_ ||
               indexed_connections_.size() < announced_connections_) {
      found_.damage = "the end is missing: the index is shorter than the bag header says";
    }
  }

  void add_connection(const BagFields& fields, ByteView data, std::uint64_t offset) {
    const auto number = fields.number("conn");
    const auto topic = fields.text("topic");
    const auto header = BagFields::parse(data);
    const auto type = header ? header->text("type") : std::nullopt;
    if (!number || !topic || !type) {
      fault(offset, "a connection is malformed");
      return;
    }
    BagConnection connection;
    connection.topic = *topic;
    connection.type = *type;
    connection.definition = header->text("message_definition").value_or("");
    connection.publisher = header->text("callerid").value_or("");
    connection.latching = header->text("latching").value_or("0") == "1";
    found_.connections.try_emplace(*number, std::move(connection));
  }

  void begin_chunk(const BagPlace& place) {
    Chunk chunk;
    chunk.place = place;
    chunk.span.offset = place.offset;
    chunk.span.length = place.end() - place.offset;
    found_.compressions.insert(place.fields.text("compression").value_or("none"));
    chunks_.push_back(std::move(chunk));
  }

  void add_index(const BagPlace& place, ByteView data) {
    const auto connection = place.fields.number("conn");
    const auto count = place.fields.number("count");
    constexpr std::size_t kEntryBytes = 12;
    if (place.fields.number("ver") != kIndexVersion || !connection || !count ||
        data.size() != std::size_t{*count} * kEntryBytes || chunks_.empty()) {
      fault(place.offset, "an index is malformed");
      return;
    }
    Chunk& chunk = chunks_.back();
    chunk.indexed = true;
    mcap::ByteReader in(data);
    for (std::uint32_t i = 0; i < *count; ++i) {
      const auto sec = in.number<std::uint32_t>();
      const Time time = bag_time(sec, in.number<std::uint32_t>());
      (void)in.number<std::uint32_t>();  // offset in the chunk
      add_message(chunk.span, *connection, time);
    }
  }

  void add_chunk_info(const BagPlace& place, ByteView data) {
    const auto position = place.fields.number64("chunk_pos");
    const auto start = place.fields.time("start_time");
    const auto end = place.fields.time("end_time");
    if (!position || !start || !end) {
      fault(place.offset, "a chunk info is malformed");
      return;
    }
    ChunkInfo info{*start, *end, {}};
    mcap::ByteReader in(data);
    while (in.ok() && in.left() > 0) {
      const auto connection = in.number<std::uint32_t>();
      info.messages[connection] = in.number<std::uint32_t>();
    }
    infos_[*position] = std::move(info);
  }

  void add_loose_message(const BagPlace& place) {
    const auto connection = place.fields.number("conn");
    const auto time = place.fields.time("time");
    if (!connection || !time) {
      fault(place.offset, "a message is malformed");
      return;
    }
    auto& spans = loose_;
    if (spans.empty() || spans.back().offset + spans.back().length != place.offset ||
        spans.back().length > kMaxLooseSpanBytes) {
      spans.push_back({{}, {}, place.offset, 0, false, {}});
    }
    spans.back().length = place.end() - spans.back().offset;
    add_message(spans.back(), *connection, *time);
  }

  /// The index of the chunk is there, and agrees with its chunk info.
  [[nodiscard]] bool is_indexed(const Chunk& chunk) const {
    const auto info = infos_.find(chunk.place.offset);
    const bool agree = info == infos_.end() || (info->second.start == chunk.span.start &&
                                                info->second.end == chunk.span.end &&
                                                info->second.messages == chunk.span.messages);
    return chunk.indexed && agree && knows_all(chunk.span);
  }

  [[nodiscard]] bool knows_all(const BagSpan& span) const {
    return std::ranges::all_of(span.messages, [this](const auto& entry) {
      return found_.connections.contains(entry.first);
    });
  }

  Status finish(Chunk& chunk) {
    ++found_.chunks;
    const bool good_index = is_indexed(chunk);
    if (!good_index || options_.scan) {
      const BagSpan indexed = chunk.span;
      Status status = unpack_bag_chunk(source_, chunk.place, options_.limits, records_);
      if (!status && status.error().code == ErrorCode::kIo) {
        return status;
      }
      if (!status) {
        fault(chunk.place.offset, status.error().message);
        return {};
      }
      tally(chunk);
      const bool same = indexed.messages == chunk.span.messages &&
                        indexed.start == chunk.span.start && indexed.end == chunk.span.end;
      if (chunk.indexed && !(same && good_index)) {
        fault(chunk.place.offset, "the index of a chunk does not match the chunk");
      }
    }
    if (!chunk.span.messages.empty()) {
      found_.spans.push_back(std::move(chunk.span));
    }
    return {};
  }

  /// Counts the messages of the chunk in `records_`.
  void tally(Chunk& chunk) {
    chunk.span.messages.clear();
    ByteView rest = records_;
    while (!rest.empty()) {
      const auto record = take_bag_record(rest);
      if (!record) {
        fault(chunk.place.offset, record.error().message);
        return;
      }
      const auto connection = record->fields.number("conn");
      const auto time = record->fields.time("time");
      if (record->op == BagOp::kConnection) {
        add_connection(record->fields, record->data, chunk.place.offset);
      } else if (record->op == BagOp::kMessage && connection && time) {
        add_message(chunk.span, *connection, *time);
      } else {
        fault(chunk.place.offset, "a message is malformed");
      }
    }
  }

  BagContent finish() {
    for (BagSpan& span : loose_) {
      found_.spans.push_back(std::move(span));
    }
    std::ranges::sort(found_.spans, {}, &BagSpan::offset);
    // Messages without a connection cannot be read.
    for (BagSpan& span : found_.spans) {
      const auto unknown = std::erase_if(span.messages, [this](const auto& entry) {
        return !found_.connections.contains(entry.first);
      });
      if (unknown > 0) {
        fault(span.offset, "messages have an unknown connection");
      }
    }
    std::erase_if(found_.spans, [](const BagSpan& span) { return span.messages.empty(); });
    found_.faults = faults_.list();
    return std::move(found_);
  }

  const mcap::Source& source_;
  const mcap::BufferedSource buffered_;
  const OpenOptions& options_;
  BagContent found_;
  mcap::Faults faults_;
  std::vector<Chunk> chunks_;
  std::vector<BagSpan> loose_;
  std::map<std::uint64_t, ChunkInfo> infos_;  ///< by the chunk's offset
  std::optional<std::uint64_t> index_;        ///< where the bag header says that the index is
  std::uint32_t announced_connections_ = 0;
  std::uint32_t announced_chunks_ = 0;
  std::set<std::uint32_t> indexed_connections_;  ///< connections of the index
  Bytes data_;
  Bytes records_;
};

}  // namespace

Result<BagContent> scan_bag(const mcap::Source& source, const OpenOptions& options) {
  return BagScanner(source, options).run();
}

Status unpack_bag_chunk(const mcap::Source& source, const BagPlace& place,
                        const mcap::ReaderLimits& limits, Bytes& records) {
  const auto size = place.fields.number("size");
  const std::string compression = place.fields.text("compression").value_or("");
  if (!size || *size > limits.record_bytes) {
    return Error{ErrorCode::kParse, "a chunk has no size, or one above the limit"};
  }
  if (place.data_bytes > limits.record_bytes) {
    return Error{ErrorCode::kOutOfRange, "a chunk is larger than the limit"};
  }
  Bytes packed(static_cast<std::size_t>(place.data_bytes));
  if (Status status = source.read(place.data_offset, packed); !status) {
    return status;
  }
  if (compression == "bz2") {
    return mcap::unpack_bzip2(packed, *size, records);
  }
  if (compression == "lz4") {
    return mcap::unpack(mcap::Compression::kLz4, packed, *size, records);
  }
  if (compression == "none") {
    records = std::move(packed);
    return records.size() == *size
               ? Status()
               : Status(Error{ErrorCode::kParse, "a chunk has another size than it announces"});
  }
  return Error{ErrorCode::kParse,
               "a chunk has the unknown compression '" + compression.substr(0, 20) + "'"};
}

}  // namespace furrow::recording
