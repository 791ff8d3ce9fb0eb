#include "furrow_recording/recorder.hpp"

#include <system_error>
#include <utility>

#include "furrow_recording/topic_filter.hpp"
#include "pre_trigger_window.hpp"
#include "recording_file.hpp"
#include "units.hpp"

namespace furrow::recording {
namespace {

/// The free space of the disk is checked after so many bytes.
constexpr std::uint64_t kSpaceCheckBytes = 1'000'000;

struct TopicState {
  TopicDescription description;
  std::uint32_t sequence = 0;
  std::uint64_t in_file = 0;  ///< accepted by the open file
  std::uint64_t written = 0;  ///< to the files before
  std::uint64_t bytes = 0;
  std::uint64_t dropped = 0;
};

}  // namespace

class Recorder::Impl {
 public:
  Impl(const RecorderParameters& parameters, std::filesystem::path stem,
       RecorderEnvironment environment)
      : parameters_(parameters),
        filter_{parameters.include, parameters.exclude},
        stem_(std::move(stem)),
        environment_(std::move(environment)),
        window_(Duration::seconds(parameters.pre_trigger_s),
                static_cast<std::uint64_t>(parameters.pre_trigger_mb * kBytesPerMb)),
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
    Status status = check_space();
    if (status && state_ == RecorderState::kRecording) {
      status = open_file();
    }
    if (!status) {
      throw ConfigError(status.error().message);
    }
  }

  ~Impl() { (void)stop(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  [[nodiscard]] bool accepts(const std::string& topic) const { return filter_.accepts(topic); }

  std::size_t add_topic(const TopicDescription& description) {
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      const TopicDescription& known = topics_[i].description;
      if (known.name == description.name && known.type_name == description.type_name &&
          known.publisher == description.publisher) {
        return i;
      }
    }
    topics_.push_back({description});
    latched_.add_channel(topics_.size() - 1, description);
    return topics_.size() - 1;
  }

  Status write(std::size_t topic, Time log_time, Time publish_time, Payload payload) {
    if (!payload) {
      ++topics_.at(topic).dropped;
      return Error{ErrorCode::kInvalidArgument, "a message without content"};
    }
    KeptMessage message{topic, 0, log_time, publish_time, std::move(payload)};
    switch (state_) {
      case RecorderState::kArmed:
        window_.add(std::move(message), [this](KeptMessage expired) {
          ++expired_;
          keep(std::move(expired));
        });
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
    return put(std::move(message));
  }

  void count_dropped(std::size_t topic, std::uint64_t messages) {
    topics_.at(topic).dropped += messages;
  }

  Status tick(Time now) {
    if (state_ != RecorderState::kRecording) {
      return {};
    }
    Status status = check_space();
    if (status) {
      status = file_->flush_if_due(now);
    }
    return status ? status : fail(status.error());
  }

  Status trigger() {
    if (state_ != RecorderState::kArmed) {
      return {};
    }
    state_ = RecorderState::kRecording;
    if (Status status = open_file(); !status) {
      return fail(status.error());
    }
    kept_waits_ = true;
    if (!window_.empty()) {
      if (Status status = put_kept(window_.begin()); !status) {
        return status;
      }
    }
    Status first;
    while (!window_.empty() && state_ == RecorderState::kRecording) {
      if (Status status = put(window_.take_oldest()); !status && first) {
        first = status;
      }
    }
    drop_window();
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
    drop_window();
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
    status.bytes = closed_bytes_ + (file_ ? file_->bytes() : 0);
    for (const TopicState& topic : topics_) {
      const std::uint64_t messages = topic.written + topic.in_file;
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
    space_checked_at_ = file_ ? file_->bytes_written() : 0;
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
    auto file = RecordingFile::open(std::move(*sink), parameters_);
    if (!file) {
      return file.error();
    }
    file_ = std::move(*file);
    files_.push_back(path);
    space_checked_at_ = 0;
    return {};
  }

  Status close_file() {
    if (!file_) {
      return {};
    }
    Status status = file_->close();
    closed_bytes_ += file_->bytes_written();
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      TopicState& topic = topics_[i];
      const std::uint64_t written = file_->messages(i);
      topic.written += written;
      topic.dropped += topic.in_file - written;
      topic.in_file = 0;
    }
    file_.reset();
    return status;
  }

  Status fail(const Error& error) {
    state_ = RecorderState::kStopped;
    (void)close_file();
    fault_ = error.message;
    return error;
  }

  /// Splits and checks the disk before a message is written.
  Status prepare(Time log_time) {
    if (file_->is_full(log_time)) {
      Status status = close_file();
      if (status) {
        status = open_file();
      }
      if (!status) {
        return status;
      }
    }
    return file_->bytes_written() - space_checked_at_ >= kSpaceCheckBytes ? check_space()
                                                                          : Status();
  }

  Status put(KeptMessage message) {
    TopicState& topic = topics_.at(message.channel);
    if (Status status = prepare(message.log_time); !status) {
      ++topic.dropped;
      return fail(status.error());
    }
    message.sequence = topic.sequence;
    if (Status status = file_->write(topic.description, message); !status) {
      ++topic.dropped;
      if (status.error().code == ErrorCode::kIo) {
        return fail(status.error());
      }
      fault_ = status.error().message;
      return status;
    }
    ++topic.sequence;
    ++topic.in_file;
    topic.bytes += message.payload->size();
    if (Status status = file_->flush_if_due(message.log_time); !status) {
      return fail(status.error());
    }
    return {};
  }

  void drop_window() {
    expired_ += window_.size();
    window_.clear();
  }

  void keep(KeptMessage message) {
    kept_waits_ = kept_waits_ || state_ == RecorderState::kArmed;
    latched_.add(std::move(message));
  }

  /// Writes the latched messages that hold when recording begins or resumes, with that time as
  /// their log time.
  Status put_kept(Time log_time) {
    if (!kept_waits_) {
      return {};
    }
    kept_waits_ = false;
    for (KeptMessage& message : latched_.take()) {
      message.log_time = log_time;
      if (Status status = put(std::move(message)); !status && state_ == RecorderState::kStopped) {
        return status;
      }
    }
    return {};
  }

  const RecorderParameters parameters_;
  TopicFilter filter_;
  std::filesystem::path stem_;
  RecorderEnvironment environment_;
  PreTriggerWindow window_;
  RecorderState state_;
  std::string fault_;
  std::vector<TopicState> topics_;
  std::vector<std::filesystem::path> files_;
  std::uint64_t closed_bytes_ = 0;
  std::uint64_t paused_ = 0;
  std::uint64_t expired_ = 0;
  std::unique_ptr<RecordingFile> file_;
  std::uint64_t space_checked_at_ = 0;
  LatchedMessages latched_;  ///< while nothing is written
  bool kept_waits_ = false;  ///< the next message is preceded by latched ones
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
