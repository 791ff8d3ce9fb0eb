#include <algorithm>
#include <set>
#include <utility>

#include "chunk_merger.hpp"
#include "reader_impl.hpp"
#include "record_source.hpp"

namespace furrow::mcap {

class MessageCursor::Impl {
 public:
  Impl(const Reader::Impl& reader, ReadOptions options)
      : reader_(reader),
        options_(std::move(options)),
        accepted_(accepted_channels()),
        merger_(
            wanted_spans(),
            [this](std::size_t span, Bytes& records, std::vector<ChunkEntry>* entries) {
              return load(reader_.spans[span], records, entries);
            },
            reader.limits.open_bytes) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Result<std::optional<Message>> next() {
    const auto item = merger_.next();
    if (!item) {
      return item.error();
    }
    return *item ? parse_message((*item)->record) : std::nullopt;
  }

 private:
  [[nodiscard]] std::set<ChannelId> accepted_channels() const {
    std::set<ChannelId> accepted;
    for (const auto& [id, channel] : reader_.summary.channels) {
      if (!options_.accept || options_.accept(channel)) {
        accepted.insert(id);
      }
    }
    return accepted;
  }

  [[nodiscard]] std::vector<ChunkMerger::Chunk> wanted_spans() const {
    std::vector<ChunkMerger::Chunk> wanted;
    for (std::size_t i = 0; i < reader_.spans.size(); ++i) {
      const Span& span = reader_.spans[i];
      if (span.start_time < options_.end && span.end_time >= options_.begin &&
          std::ranges::any_of(span.channels,
                              [this](ChannelId id) { return accepted_.contains(id); })) {
        wanted.push_back({span.start_time, i});
      }
    }
    return wanted;
  }

  Status load(const Span& span, Bytes& records, std::vector<ChunkEntry>* entries) {
    if (Status status = read_records(span, records); !status) {
      return status;
    }
    if (entries == nullptr) {
      return {};
    }
    std::string damage;
    Status whole = for_each_record(
        records, [&](Opcode opcode, ByteView content, std::size_t offset) -> Status {
          if (opcode != Opcode::kMessage) {
            return {};
          }
          const auto message = parse_message(content);
          if (!message) {
            damage = "a message is malformed";
          } else if (!reader_.summary.channels.contains(message->channel_id)) {
            damage = "a message has an unknown channel";
          } else if (accepted_.contains(message->channel_id) &&
                     message->log_time >= options_.begin && message->log_time < options_.end) {
            entries->push_back({message->log_time,
                                static_cast<std::uint32_t>(offset + kRecordHeaderBytes),
                                static_cast<std::uint32_t>(content.size())});
          }
          return {};
        });
    return damage.empty() ? whole : Error{ErrorCode::kParse, damage};
  }

  Status read_records(const Span& span, Bytes& records) {
    const Source& source = *reader_.source;
    if (!span.chunk) {
      records.resize(static_cast<std::size_t>(span.length));
      return source.read(span.offset, records);
    }
    const auto place = place_record(source, span.offset, source.size(), reader_.limits);
    if (!place) {
      return place.error();
    }
    if (Status status = read_content(source, *place, content_); !status) {
      return status;
    }
    return unpack_chunk(content_, reader_.limits, options_.check_crcs, records);
  }

  const Reader::Impl& reader_;
  ReadOptions options_;
  std::set<ChannelId> accepted_;
  ChunkMerger merger_;
  Bytes content_;  ///< of the chunk that is unpacked
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
