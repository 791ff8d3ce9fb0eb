#include <algorithm>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include "reader_impl.hpp"

namespace furrow::mcap {
namespace {

/// One message of an unpacked span.
struct Entry {
  Time time;
  std::size_t offset = 0;  ///< of its content
  std::size_t bytes = 0;
};

/// An unpacked span whose messages are being handed out.
struct OpenSpan {
  Bytes records;
  std::vector<Entry> entries;  ///< by time, then as in the file
  std::size_t next = 0;
};

}  // namespace

class MessageCursor::Impl {
 public:
  Impl(const Reader::Impl& reader, ReadOptions options)
      : reader_(reader), options_(std::move(options)) {
    for (const auto& [id, channel] : reader.summary.channels) {
      if (!options_.accept || options_.accept(channel)) {
        accepted_.insert(id);
      }
    }
    for (std::size_t i = 0; i < reader.spans.size(); ++i) {
      const Span& span = reader.spans[i];
      if (span.start_time < options_.end && span.end_time >= options_.begin && is_wanted(i)) {
        waiting_.push_back(i);
      }
    }
    // Taken from the back.
    std::sort(waiting_.begin(), waiting_.end(), [&reader](std::size_t a, std::size_t b) {
      return std::tuple(reader.spans[a].start_time, a) > std::tuple(reader.spans[b].start_time, b);
    });
  }

  Result<std::optional<Message>> next() {
    release_last();
    while (!waiting_.empty() &&
           (heads_.empty() || reader_.spans[waiting_.back()].start_time <= heads_.top().time)) {
      const std::size_t span = waiting_.back();
      waiting_.pop_back();
      if (Status status = open(span); !status) {
        return status.error();
      }
    }
    if (heads_.empty()) {
      return std::optional<Message>();
    }
    last_ = heads_.top().span;
    heads_.pop();
    const OpenSpan& span = open_.at(*last_);
    const Entry& entry = span.entries[span.next];
    return parse_message(ByteView(span.records).subspan(entry.offset, entry.bytes));
  }

 private:
  struct Head {
    Time time;
    std::size_t span = 0;
    bool operator>(const Head& other) const {
      return std::tuple(time, span) > std::tuple(other.time, other.span);
    }
  };

  /// False when the index says that no accepted channel is in it.
  [[nodiscard]] bool is_wanted(std::size_t span) const {
    const auto& chunks = reader_.summary.chunks;
    if (!reader_.spans[span].chunk || span >= chunks.size() ||
        chunks[span].offset != reader_.spans[span].offset ||
        chunks[span].message_index_offsets.empty()) {
      return true;
    }
    const auto& channels = chunks[span].message_index_offsets;
    return std::any_of(channels.begin(), channels.end(),
                       [this](const auto& entry) { return accepted_.contains(entry.first); });
  }

  Status open(std::size_t index) {
    OpenSpan span;
    if (Status status = load(reader_.spans[index], span.records); !status) {
      return status;
    }
    if (open_bytes_ + span.records.size() > reader_.limits.open_bytes) {
      return Error{ErrorCode::kOutOfRange, "more chunks overlap in time than fit into memory"};
    }
    Status status = for_each_record(
        span.records, [this, &span](Opcode opcode, ByteView content, std::size_t offset) -> Status {
          if (opcode != Opcode::kMessage) {
            return {};
          }
          const auto message = parse_message(content);
          if (!message) {
            return Error{ErrorCode::kParse, "a message is malformed"};
          }
          if (!reader_.summary.channels.contains(message->channel_id)) {
            return Error{ErrorCode::kParse, "a message is of an unknown channel"};
          }
          if (accepted_.contains(message->channel_id) && message->log_time >= options_.begin &&
              message->log_time < options_.end) {
            span.entries.push_back(
                {message->log_time, offset + kRecordHeaderBytes, content.size()});
          }
          return {};
        });
    if (!status) {
      return status;
    }
    if (span.entries.empty()) {
      return {};
    }
    std::stable_sort(span.entries.begin(), span.entries.end(),
                     [](const Entry& a, const Entry& b) { return a.time < b.time; });
    open_bytes_ += span.records.size();
    heads_.push({span.entries.front().time, index});
    open_.emplace(index, std::move(span));
    return {};
  }

  Status load(const Span& span, Bytes& records) const {
    const Source& source = *reader_.source;
    if (!span.chunk) {
      records.resize(static_cast<std::size_t>(span.length));
      return source.read(span.offset, records);
    }
    const auto place = place_record(source, span.offset, source.size(), reader_.limits);
    if (!place) {
      return place.error();
    }
    if (place->opcode != Opcode::kChunk || place->end() - place->offset != span.length) {
      return Error{ErrorCode::kParse, "the index names a place where no chunk is"};
    }
    Bytes content;
    if (Status status = read_content(source, *place, content); !status) {
      return status;
    }
    return unpack_chunk(content, reader_.limits, options_.check_crcs, records);
  }

  void release_last() {
    if (!last_) {
      return;
    }
    const auto at = open_.find(*last_);
    OpenSpan& span = at->second;
    if (++span.next < span.entries.size()) {
      heads_.push({span.entries[span.next].time, *last_});
    } else {
      open_bytes_ -= span.records.size();
      open_.erase(at);
    }
    last_.reset();
  }

  const Reader::Impl& reader_;
  ReadOptions options_;
  std::set<ChannelId> accepted_;
  std::vector<std::size_t> waiting_;
  std::map<std::size_t, OpenSpan> open_;
  std::priority_queue<Head, std::vector<Head>, std::greater<>> heads_;
  std::optional<std::size_t> last_;
  std::uint64_t open_bytes_ = 0;
};

MessageCursor::MessageCursor(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MessageCursor::MessageCursor(MessageCursor&&) noexcept = default;
MessageCursor& MessageCursor::operator=(MessageCursor&&) noexcept = default;
MessageCursor::~MessageCursor() = default;

Result<std::optional<Message>> MessageCursor::next() {
  return impl_->next();
}

MessageCursor Reader::messages(ReadOptions options) const {
  return MessageCursor(std::make_unique<MessageCursor::Impl>(*impl_, std::move(options)));
}

}  // namespace furrow::mcap
