#include "furrow_recording/recorder.hpp"

#include <algorithm>
#include <deque>
#include <limits>
#include <system_error>
#include <utility>

#include "furrow_recording/mcap_writer.hpp"
#include "furrow_recording/topic_filter.hpp"

namespace furrow::recording {
namespace {

constexpr double kBytesPerMb = 1e6;
/// The disk's space is asked for after so many bytes.
constexpr std::uint64_t kSpaceCheckBytes = 1'000'000;
/// Latched messages of one topic that are kept for a late beginning.
constexpr std::size_t kMaxLatched = 100;

struct Waiting {
  std::size_t topic = 0;
  Time log_time;
  Time publish_time;
  Payload payload;
};

struct TopicState {
  TopicDescription description;
  bool latched = false;
  std::size_t depth = 1;
  std::optional<mcap::ChannelId> channel;  ///< in the open file
  std::uint32_t sequence = 0;
  std::uint64_t handed_over = 0;  ///< to the open file
  std::uint64_t written = 0;      ///< to the files before
  std::uint64_t bytes = 0;
  std::uint64_t dropped = 0;
  std::deque<Waiting> kept;  ///< latched, while nothing is written
};

mcap::Compression compression_of(const std::string& name) {
  if (name == "none") {
    return mcap::Compression::kNone;
  }
  return name == "lz4" ? mcap::Compression::kLz4 : mcap::Compression::kZstd;
}

}  // namespace

class Recorder::Impl {
 public:
  Impl(const RecorderParameters& parameters, std::filesystem::path stem,
       RecorderEnvironment environment)
      : parameters_(parameters),
        filter_{parameters.include, parameters.exclude},
        stem_(std::move(stem)),
        environment_(std::move(environment)),
        state_(parameters.pre_trigger_s > 0.0 ? RecorderState::kArmed : RecorderState::kRecording) {
    std::error_code failure;
    if (stem_.has_parent_path()) {
      std::filesystem::create_directories(stem_.parent_path(), failure);
    }
    if (failure) {
      throw ConfigError("cannot make the folder " + stem_.parent_path().string() + ": " +
                        failure.message());
    }
    if (std::filesystem::exists(file_path(0), failure)) {
      throw ConfigError(file_path(0).string() + " exists; recordings are not overwritten");
    }
    if (Status status = check_space(); !status) {
      throw ConfigError(status.error().message);
    }
    if (state_ == RecorderState::kRecording) {
      if (Status status = open_file(); !status) {
        throw ConfigError(status.error().message);
      }
    }
  }

  ~Impl() { (void)stop(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  [[nodiscard]] bool accepts(const std::string& topic) const { return filter_.accepts(topic); }

  std::size_t add_topic(const TopicDescription& description) {
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      const TopicDescription& known = topics_[i].description;
      if (known.name == description.name && known.type_name == description.type_name) {
        return i;
      }
    }
    TopicState topic;
    topic.description = description;
    topic.latched = description.latched();
    for (const msgs::Qos& qos : description.offered_qos) {
      topic.depth = std::max(topic.depth, static_cast<std::size_t>(std::max(qos.depth, 1)));
    }
    topic.depth = std::min(topic.depth, kMaxLatched);
    topics_.push_back(std::move(topic));
    return topics_.size() - 1;
  }

  Status write(std::size_t topic, Time log_time, Time publish_time, Payload payload) {
    if (!payload) {
      ++topics_.at(topic).dropped;
      return Error{ErrorCode::kInvalidArgument, "a message without content"};
    }
    Waiting message{topic, log_time, publish_time, std::move(payload)};
    switch (state_) {
      case RecorderState::kArmed:
        arm(std::move(message));
        return {};
      case RecorderState::kPaused:
        ++paused_;
        keep(std::move(message));
        return {};
      case RecorderState::kStopped:
        ++topics_.at(topic).dropped;
        return Error{ErrorCode::kUnavailable, "the recorder is stopped"};
      case RecorderState::kRecording:
        break;
    }
    if (Status status = put_kept(log_time); !status) {
      ++topics_.at(topic).dropped;
      return status;
    }
    return put(message);
  }

  void count_dropped(std::size_t topic, std::uint64_t messages) {
    topics_.at(topic).dropped += messages;
  }

  Status tick(Time now) {
    if (state_ != RecorderState::kRecording) {
      return {};
    }
    if (Status status = check_space(); !status) {
      return fail(status.error());
    }
    return flush_if_due(now);
  }

  Status trigger() {
    if (state_ != RecorderState::kArmed) {
      return {};
    }
    state_ = RecorderState::kRecording;
    if (Status status = open_file(); !status) {
      return fail(status.error());
    }
    if (!ring_.empty()) {
      if (Status status = put_kept(ring_.front().log_time); !status) {
        return status;
      }
    } else {
      kept_waits_ = true;
    }
    Status first;
    while (!ring_.empty() && state_ == RecorderState::kRecording) {
      const Waiting message = take_from_ring();
      if (Status status = put(message); !status && first) {
        first = status;
      }
    }
    drop_ring();
    return first;
  }

  void pause() {
    if (state_ == RecorderState::kRecording) {
      state_ = RecorderState::kPaused;
    }
  }
  void resume() {
    if (state_ == RecorderState::kPaused) {
      state_ = RecorderState::kRecording;
      kept_waits_ = true;
    }
  }

  Status stop() {
    if (state_ == RecorderState::kStopped) {
      return {};
    }
    drop_ring();
    state_ = RecorderState::kStopped;
    Status status = close_file();
    if (!status) {
      fault_ = status.error().message;
    }
    return status;
  }

  [[nodiscard]] RecorderStatus status() const {
    RecorderStatus status;
    status.state = state_;
    status.fault = fault_;
    status.files = files_;
    status.paused = paused_;
    status.expired = expired_;
    status.bytes =
        closed_bytes_ + (writer_ ? writer_->bytes_written() + writer_->bytes_pending() : 0);
    for (const TopicState& topic : topics_) {
      const std::uint64_t messages = topic.written + topic.handed_over;
      status.topics.push_back({topic.description.name, messages, topic.bytes, topic.dropped});
      status.messages += messages;
      status.dropped += topic.dropped;
    }
    return status;
  }

 private:
  [[nodiscard]] std::filesystem::path file_path(std::size_t number) const {
    auto path = stem_;
    path += "_" + std::to_string(number) + ".mcap";
    return path;
  }

  Status check_space() {
    space_checked_at_ = writer_ ? writer_->bytes_written() : 0;
    const auto free = environment_.free_bytes(stem_);
    if (!free) {
      return free.error();
    }
    if (static_cast<double>(*free) < parameters_.min_free_mb * kBytesPerMb) {
      return Error{ErrorCode::kIo, "only " + std::to_string(*free / 1'000'000) + " MB left for " +
                                       stem_.string() + ", less than min_free_mb"};
    }
    return {};
  }

  Status open_file() {
    const auto path = file_path(files_.size());
    auto sink = environment_.create_file(path);
    if (!sink) {
      return sink.error();
    }
    mcap::WriterOptions options;
    options.compression = compression_of(parameters_.compression);
    options.chunk_bytes = static_cast<std::size_t>(parameters_.chunk_kb) * 1000;
    auto writer = mcap::Writer::open(std::move(*sink), options);
    if (!writer) {
      return writer.error();
    }
    writer_ = std::move(*writer);
    files_.push_back(path);
    file_start_.reset();
    pending_since_.reset();
    space_checked_at_ = 0;
    for (TopicState& topic : topics_) {
      topic.channel.reset();
    }
    return {};
  }

  Status close_file() {
    if (!writer_) {
      return {};
    }
    Status status = writer_->close();
    closed_bytes_ += writer_->bytes_written();
    // A chunk that could not be written takes messages with it.
    const mcap::Statistics statistics = writer_->statistics();
    for (TopicState& topic : topics_) {
      std::uint64_t written = 0;
      if (topic.channel) {
        const auto at = statistics.channel_message_counts.find(*topic.channel);
        written = at == statistics.channel_message_counts.end() ? 0 : at->second;
      }
      topic.written += written;
      topic.dropped += topic.handed_over - written;
      topic.handed_over = 0;
      topic.channel.reset();
    }
    writer_.reset();
    return status;
  }

  Status fail(const Error& error) {
    state_ = RecorderState::kStopped;
    (void)close_file();
    fault_ = error.message;
    return error;
  }

  Status flush_if_due(Time now) {
    if (!pending_since_ || now - *pending_since_ < Duration::seconds(parameters_.flush_s)) {
      return {};
    }
    pending_since_.reset();
    if (Status status = writer_->flush(); !status) {
      return fail(status.error());
    }
    return {};
  }

  Status split_if_due(Time log_time) {
    const std::uint64_t bytes = writer_->bytes_written() + writer_->bytes_pending();
    const bool by_size = parameters_.split_mb > 0.0 &&
                         static_cast<double>(bytes) >= parameters_.split_mb * kBytesPerMb;
    const bool by_time = parameters_.split_s > 0.0 && file_start_ &&
                         log_time - *file_start_ >= Duration::seconds(parameters_.split_s);
    if (!file_start_ || (!by_size && !by_time)) {
      return {};
    }
    if (Status status = close_file(); !status) {
      return status;
    }
    return open_file();
  }

  Status prepare(TopicState& topic, Time log_time) {
    if (Status status = split_if_due(log_time); !status) {
      return status;
    }
    if (writer_->bytes_written() - space_checked_at_ >= kSpaceCheckBytes) {
      if (Status status = check_space(); !status) {
        return status;
      }
    }
    if (topic.channel) {
      return {};
    }
    const TopicDescription& description = topic.description;
    mcap::SchemaId schema = 0;
    if (!description.type_name.empty()) {
      const auto added = writer_->add_schema(schema_name(description), description.schema_encoding,
                                             description.schema_text);
      if (!added) {
        return added.error();
      }
      schema = *added;
    }
    const auto channel =
        writer_->add_channel({0, schema, topic_in_file(description.name),
                              description.message_encoding, channel_metadata(description)});
    if (!channel) {
      return channel.error();
    }
    topic.channel = *channel;
    return {};
  }

  /// Into the open file.
  Status put(const Waiting& message) {
    TopicState& topic = topics_.at(message.topic);
    if (Status status = prepare(topic, message.log_time); !status) {
      ++topic.dropped;
      return fail(status.error());
    }
    Status status = writer_->write(
        {*topic.channel, topic.sequence, message.log_time, message.publish_time, *message.payload});
    if (!status) {
      ++topic.dropped;
      if (status.error().code == ErrorCode::kIo) {
        return fail(status.error());
      }
      fault_ = status.error().message;
      return status;
    }
    ++topic.sequence;
    ++topic.handed_over;
    topic.bytes += message.payload->size();
    if (!file_start_) {
      file_start_ = message.log_time;
    }
    if (writer_->bytes_pending() == 0) {
      pending_since_.reset();
    } else if (!pending_since_) {
      pending_since_ = message.log_time;
    }
    return flush_if_due(message.log_time);
  }

  void arm(Waiting message) {
    const Time oldest = message.log_time - Duration::seconds(parameters_.pre_trigger_s);
    ring_bytes_ += message.payload->size();
    ring_.push_back(std::move(message));
    while (!ring_.empty() &&
           (ring_.front().log_time < oldest ||
            static_cast<double>(ring_bytes_) > parameters_.pre_trigger_mb * kBytesPerMb)) {
      Waiting expired = take_from_ring();
      ++expired_;
      keep(std::move(expired));
    }
  }

  Waiting take_from_ring() {
    Waiting message = std::move(ring_.front());
    ring_.pop_front();
    ring_bytes_ -= message.payload->size();
    return message;
  }

  void drop_ring() {
    expired_ += ring_.size();
    ring_.clear();
    ring_bytes_ = 0;
  }

  void keep(Waiting message) {
    TopicState& topic = topics_.at(message.topic);
    if (!topic.latched) {
      return;
    }
    topic.kept.push_back(std::move(message));
    if (topic.kept.size() > topic.depth) {
      topic.kept.pop_front();
    }
    kept_waits_ = kept_waits_ || state_ == RecorderState::kArmed;
  }

  /// What still held when recording began or went on; with that time as log time.
  Status put_kept(Time log_time) {
    if (!kept_waits_) {
      return {};
    }
    kept_waits_ = false;
    for (TopicState& topic : topics_) {
      std::deque<Waiting> kept = std::exchange(topic.kept, {});
      for (Waiting& message : kept) {
        message.log_time = log_time;
        if (Status status = put(message); !status && state_ == RecorderState::kStopped) {
          return status;
        }
      }
    }
    return {};
  }

  RecorderParameters parameters_;
  TopicFilter filter_;
  std::filesystem::path stem_;
  RecorderEnvironment environment_;
  RecorderState state_;
  std::string fault_;
  std::vector<TopicState> topics_;
  std::vector<std::filesystem::path> files_;
  std::uint64_t closed_bytes_ = 0;
  std::uint64_t paused_ = 0;
  std::uint64_t expired_ = 0;

  std::unique_ptr<mcap::Writer> writer_;
  std::optional<Time> file_start_;
  std::optional<Time> pending_since_;
  std::uint64_t space_checked_at_ = 0;

  std::deque<Waiting> ring_;
  std::uint64_t ring_bytes_ = 0;
  bool kept_waits_ = false;
};

Recorder::Recorder(const RecorderParameters& parameters, std::filesystem::path stem,
                   RecorderEnvironment environment)
    : impl_(std::make_unique<Impl>(parameters, std::move(stem), std::move(environment))) {}
Recorder::~Recorder() = default;

bool Recorder::accepts(const std::string& topic) const {
  return impl_->accepts(topic);
}
std::size_t Recorder::add_topic(const TopicDescription& topic) {
  return impl_->add_topic(topic);
}
Status Recorder::write(std::size_t topic, Time log_time, Time publish_time, Payload payload) {
  return impl_->write(topic, log_time, publish_time, std::move(payload));
}
void Recorder::count_dropped(std::size_t topic, std::uint64_t messages) {
  impl_->count_dropped(topic, messages);
}
Status Recorder::tick(Time now) {
  return impl_->tick(now);
}
Status Recorder::trigger() {
  return impl_->trigger();
}
void Recorder::pause() {
  impl_->pause();
}
void Recorder::resume() {
  impl_->resume();
}
Status Recorder::stop() {
  return impl_->stop();
}
RecorderStatus Recorder::status() const {
  return impl_->status();
}

}  // namespace furrow::recording
