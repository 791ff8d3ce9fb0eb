#include <algorithm>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "furrow_recording/recording_reader.hpp"
#include "message_tally.hpp"

namespace furrow::recording {
namespace {

/// Of one recording: its channels' numbers in the merged one.
using ChannelMap = std::map<mcap::ChannelId, mcap::ChannelId>;

/// Reads several streams by time. A recording is opened when its first message may be due.
class MergedStream final : public MessageStream {
 public:
  struct Input {
    const RecordingReader* reader = nullptr;
    const ChannelMap* channels = nullptr;
    mcap::ReadOptions options;
    std::unique_ptr<MessageStream> stream = nullptr;
    std::optional<mcap::Message> head = std::nullopt;
    bool ended = false;

    [[nodiscard]] Time first() const { return reader->info().statistics().start_time; }
  };

  explicit MergedStream(std::vector<Input> inputs) : inputs_(std::move(inputs)) {}

  Result<std::optional<mcap::Message>> next() override {
    if (last_ != nullptr) {
      last_->head.reset();
      last_ = nullptr;
    }
    Input* first = nullptr;
    for (Input& input : inputs_) {
      const bool later = first != nullptr && !input.head && input.stream == nullptr &&
                         input.first() > first->head->log_time;
      if (later || input.ended) {
        continue;
      }
      if (Status status = fill(input); !status) {
        return status.error();
      }
      if (input.head && (first == nullptr || input.head->log_time < first->head->log_time)) {
        first = &input;
      }
    }
    if (first == nullptr) {
      return std::optional<mcap::Message>();
    }
    last_ = first;
    mcap::Message message = *first->head;
    message.channel_id = first->channels->at(message.channel_id);
    return std::optional(message);
  }

 private:
  static Status fill(Input& input) {
    if (input.head) {
      return {};
    }
    if (!input.stream) {
      input.stream = input.reader->messages(input.options);
    }
    auto next = input.stream->next();
    if (!next) {
      return next.error();
    }
    input.head = *next;
    input.ended = !input.head.has_value();
    return {};
  }

  std::vector<Input> inputs_;
  Input* last_ = nullptr;  ///< whose message was handed out
};

class MergedRecording final : public RecordingReader {
 public:
  explicit MergedRecording(std::vector<std::unique_ptr<RecordingReader>> readers)
      : readers_(std::move(readers)) {
    info_.format = readers_.front()->info().format;
    info_.profile = readers_.front()->info().profile;
    info_.library = readers_.front()->info().library;
    info_.summary.statistics.emplace();
    for (const auto& reader : readers_) {
      add(*reader);
    }
    mcap::Statistics& all = *info_.summary.statistics;
    all.schema_count = static_cast<std::uint16_t>(info_.summary.schemas.size());
    all.channel_count = static_cast<std::uint32_t>(info_.summary.channels.size());
    all.attachment_count = static_cast<std::uint32_t>(info_.summary.attachments.size());
    all.metadata_count = static_cast<std::uint32_t>(info_.summary.metadata.size());
  }

  const RecordingInfo& info() const override { return info_; }

  std::unique_ptr<MessageStream> messages(const mcap::ReadOptions& options) const override {
    std::vector<MergedStream::Input> inputs;
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      MergedStream::Input input;
      input.reader = readers_[i].get();
      input.channels = &channels_[i];
      input.options = options;
      if (options.accept) {
        // Asked with the channel's merged number.
        input.options.accept = [this, i, accept = options.accept](const mcap::Channel& channel) {
          return accept(info_.summary.channels.at(channels_[i].at(channel.id)));
        };
      }
      inputs.push_back(std::move(input));
    }
    return std::make_unique<MergedStream>(std::move(inputs));
  }

  Result<mcap::Attachment> attachment(std::size_t number) const override {
    const auto& [reader, own] = attachments_.at(number);
    return reader->attachment(own);
  }
  Result<mcap::Metadata> metadata(std::size_t number) const override {
    const auto& [reader, own] = metadata_.at(number);
    return reader->metadata(own);
  }

 private:
  using Item = std::pair<const RecordingReader*, std::size_t>;

  void add(const RecordingReader& reader) {
    const RecordingInfo& info = reader.info();
    const bool first = channels_.empty();
    channels_.push_back(add_channels(info.summary));
    info_.profile = first || info.profile == info_.profile ? info_.profile : "";
    info_.library = first || info.library == info_.library ? info_.library : "";
    info_.format = first || info.format == info_.format ? info_.format : "several";
    info_.bytes += info.bytes;
    info_.bytes_ignored += info.bytes_ignored;
    info_.compressions.insert(info.compressions.begin(), info.compressions.end());
    info_.damage = info_.damage.empty() ? info.damage : info_.damage;
    info_.faults.insert(info_.faults.end(), info.faults.begin(), info.faults.end());
    info_.notes.insert(info_.notes.end(), info.notes.begin(), info.notes.end());
    add_statistics(info.statistics(), channels_.back());
    for (std::size_t i = 0; i < info.summary.attachments.size(); ++i) {
      info_.summary.attachments.push_back(info.summary.attachments[i]);
      attachments_.emplace_back(&reader, i);
    }
    for (std::size_t i = 0; i < info.summary.metadata.size(); ++i) {
      info_.summary.metadata.push_back(info.summary.metadata[i]);
      metadata_.emplace_back(&reader, i);
    }
  }

  ChannelMap add_channels(const mcap::Summary& summary) {
    ChannelMap map;
    for (const auto& [id, channel] : summary.channels) {
      mcap::Channel merged = channel;
      const auto schema = summary.schemas.find(channel.schema_id);
      merged.schema_id =
          schema == summary.schemas.end() ? mcap::SchemaId{0} : add_schema(schema->second);
      const auto key =
          std::tuple(merged.topic, merged.schema_id, merged.message_encoding, merged.metadata);
      const auto next = static_cast<mcap::ChannelId>(info_.summary.channels.size());
      const auto [at, added] = known_channels_.try_emplace(key, next);
      if (added) {
        merged.id = next;
        info_.summary.channels[next] = std::move(merged);
      }
      map[id] = at->second;
    }
    return map;
  }

  mcap::SchemaId add_schema(mcap::Schema schema) {
    const auto key = std::tuple(schema.name, schema.encoding, schema.data);
    const auto next = static_cast<mcap::SchemaId>(known_schemas_.size() + 1);
    const auto [at, added] = known_schemas_.try_emplace(key, next);
    if (added) {
      schema.id = next;
      info_.summary.schemas[next] = std::move(schema);
    }
    return at->second;
  }

  void add_statistics(const mcap::Statistics& one, const ChannelMap& channels) {
    mcap::Statistics& all = *info_.summary.statistics;
    all.chunk_count += one.chunk_count;
    mcap::MessageTally tally{
        .start = one.start_time, .end = one.end_time, .messages = one.message_count};
    for (const auto& [id, count] : one.channel_message_counts) {
      tally.by_channel[channels.at(id)] += count;
    }
    mcap::add_to(all, tally);
  }

  std::vector<std::unique_ptr<RecordingReader>> readers_;
  std::vector<ChannelMap> channels_;  ///< by reader
  std::vector<Item> attachments_;
  std::vector<Item> metadata_;
  RecordingInfo info_;
  std::map<std::tuple<std::string, mcap::SchemaId, std::string, mcap::StringMap>, mcap::ChannelId>
      known_channels_;
  std::map<std::tuple<std::string, std::string, std::string>, mcap::SchemaId> known_schemas_;
};

}  // namespace

Result<std::unique_ptr<RecordingReader>> merge_readers(
    std::vector<std::unique_ptr<RecordingReader>> readers) {
  if (readers.empty()) {
    return Error{ErrorCode::kInvalidArgument, "no recording is given"};
  }
  if (readers.size() == 1) {
    return std::move(readers.front());
  }
  constexpr std::size_t kMaxIds = std::numeric_limits<mcap::ChannelId>::max();
  std::size_t channels = 0;
  std::size_t schemas = 0;
  for (const auto& reader : readers) {
    channels += reader->info().summary.channels.size();
    schemas += reader->info().summary.schemas.size();
  }
  // An upper bound: equal ones become one.
  if (channels > kMaxIds || schemas > kMaxIds) {
    return Error{ErrorCode::kOutOfRange, "the recordings have more than 65535 channels or schemas"};
  }
  return std::unique_ptr<RecordingReader>(std::make_unique<MergedRecording>(std::move(readers)));
}

}  // namespace furrow::recording
