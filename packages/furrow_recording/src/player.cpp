#include "furrow_recording/player.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include "furrow_recording/mcap_reader.hpp"

namespace furrow::recording {
namespace {

constexpr std::size_t kNotPlayed = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kMaxLatched = 100;
/// Latched messages of a topic whose depth is not known.
constexpr std::size_t kUsualLatched = 10;
constexpr double kMinRate = 1e-3;
constexpr double kMaxRate = 1e3;
const Time kForever = Time::from_nanoseconds(std::numeric_limits<std::int64_t>::max());

/// One file, with its next message.
struct File {
  explicit File(mcap::Reader opened) : reader(std::move(opened)) {}
  mcap::Reader reader;
  std::map<mcap::ChannelId, std::size_t> topics;  ///< kNotPlayed where filtered out
  std::optional<mcap::MessageCursor> cursor;
  std::optional<mcap::Message> head;  ///< its data live until the cursor moves
  Payload payload;                    ///< of the head, copied before it is due
  bool ended = false;
};

std::size_t latched_depth(const TopicDescription& topic) {
  std::size_t depth = 0;
  for (const msgs::Qos& qos : topic.offered_qos) {
    depth += qos.depth > 0 ? static_cast<std::size_t>(qos.depth) : kUsualLatched;
  }
  return std::clamp<std::size_t>(depth, 1, kMaxLatched);
}

Status check_rate(double rate) {
  if (!(rate >= kMinRate && rate <= kMaxRate)) {
    return Error{ErrorCode::kInvalidArgument, "the rate must be between 0.001 and 1000"};
  }
  return {};
}

Payload copy_of(const mcap::Message& message) {
  return std::make_shared<const std::vector<std::byte>>(message.data.begin(), message.data.end());
}

PlayedMessage played(std::size_t topic, const mcap::Message& message, Payload payload) {
  return {topic, message.log_time, message.publish_time, false, std::move(payload)};
}

}  // namespace

class Player::Impl {
 public:
  static Result<std::unique_ptr<Impl>> open(std::vector<std::unique_ptr<mcap::Source>> sources,
                                            const PlayerOptions& options) {
    auto impl = std::make_unique<Impl>(options);
    for (auto& source : sources) {
      auto reader = mcap::Reader::open(std::move(source));
      if (!reader) {
        return reader.error();
      }
      impl->files_.push_back(std::make_unique<File>(std::move(*reader)));
    }
    if (Status status = impl->prepare(); !status) {
      return status.error();
    }
    return impl;
  }

  explicit Impl(const PlayerOptions& options) : options_(options), paused_(options.start_paused) {}

  [[nodiscard]] const std::vector<TopicDescription>& topics() const { return topics_; }
  [[nodiscard]] const PlayerOptions& options() const { return options_; }
  [[nodiscard]] Time begin() const { return begin_; }
  [[nodiscard]] Time end() const { return end_; }
  [[nodiscard]] bool paused() const { return paused_; }
  [[nodiscard]] std::uint64_t loops() const { return loops_; }

  Result<PlayerEvent> next(Time now) {
    if (!started_) {
      started_ = true;
      anchor_now_ = now;
      if (Status status = go_to(play_begin_); !status) {
        return status.error();
      }
    }
    for (int turns = 0; turns < 2; ++turns) {
      if (!repeats_.empty()) {
        PlayedMessage message = std::move(repeats_.front());
        repeats_.pop_front();
        return PlayerEvent(std::move(message));
      }
      const auto file = peek();
      if (!file) {
        return file.error();
      }
      if (paused_) {
        return paused_event(*file);
      }
      if (*file != nullptr) {
        return timed_event(now, **file);
      }
      if (!options_.loop || !played_any_) {
        return PlayerEvent(PlayerEnd{});
      }
      ++loops_;
      played_any_ = false;
      anchor_now_ = now;
      if (Status status = go_to(play_begin_); !status) {
        return status.error();
      }
    }
    return PlayerEvent(PlayerEnd{});
  }

  Result<std::optional<PlayedMessage>> next_message() {
    if (!started_) {
      started_ = true;
      if (Status status = go_to(play_begin_); !status) {
        return status.error();
      }
    }
    if (!repeats_.empty()) {
      PlayedMessage message = std::move(repeats_.front());
      repeats_.pop_front();
      return std::optional(std::move(message));
    }
    const auto file = peek();
    if (!file) {
      return file.error();
    }
    return *file == nullptr ? std::optional<PlayedMessage>() : std::optional(pop(**file));
  }

  void pause(Time now) {
    if (!paused_) {
      hold(now);
      paused_ = true;
    }
  }
  void resume(Time now) {
    if (paused_) {
      anchor_now_ = now;
      paused_ = false;
      steps_ = 0;
    }
  }
  void step(std::uint64_t messages) { steps_ += paused_ ? messages : 0; }

  void seek(Time now, Time to) {
    started_ = true;
    anchor_now_ = now;
    // A failure shows again at the next read.
    (void)go_to(std::clamp(to, play_begin_, play_end_));
  }

  Status set_rate(Time now, double rate) {
    if (Status status = check_rate(rate); !status) {
      return status;
    }
    if (!paused_) {
      hold(now);
    }
    options_.rate = rate;
    return {};
  }

  [[nodiscard]] Time position(Time now) const {
    if (!started_ || paused_) {
      return anchor_;
    }
    const double passed_s = (now - anchor_now_).to_seconds() * options_.rate;
    const double left_s = (end_ - anchor_).to_seconds();
    return passed_s >= left_s ? std::max(anchor_, end_) : anchor_ + Duration::seconds(passed_s);
  }

 private:
  Status prepare() {
    if (Status status = check_rate(options_.rate); !status) {
      return status;
    }
    if (!std::isfinite(options_.clock_hz) || options_.clock_hz < 0.0 || options_.clock_hz > 1e6) {
      return Error{ErrorCode::kInvalidArgument, "clock_hz must be between 0 and 1e6"};
    }
    bool any = false;
    for (const auto& file : files_) {
      add_topics(*file);
      const mcap::Statistics& statistics = *file->reader.summary().statistics;
      if (statistics.message_count == 0) {
        continue;
      }
      begin_ = any ? std::min(begin_, statistics.start_time) : statistics.start_time;
      end_ = any ? std::max(end_, statistics.end_time) : statistics.end_time;
      any = true;
    }
    const Duration length = end_ - begin_;
    if (options_.start_offset < Duration() || options_.start_offset > length) {
      return Error{ErrorCode::kInvalidArgument, "the start offset lies outside of the recording"};
    }
    if (options_.duration && *options_.duration < Duration()) {
      return Error{ErrorCode::kInvalidArgument, "the duration is negative"};
    }
    play_begin_ = begin_ + options_.start_offset;
    const bool ends_before =
        options_.duration && *options_.duration < length - options_.start_offset;
    play_end_ = ends_before ? play_begin_ + *options_.duration : end_;
    play_last_included_ = !ends_before;
    anchor_ = play_begin_;
    return {};
  }

  void add_topics(File& file) {
    const mcap::Summary& summary = file.reader.summary();
    for (const auto& [id, channel] : summary.channels) {
      const auto schema = summary.schemas.find(channel.schema_id);
      TopicDescription topic =
          describe_channel(channel, schema == summary.schemas.end() ? nullptr : &schema->second);
      const bool made_here = options_.clock_hz > 0.0 && topic.name == "clock";
      if (made_here || !options_.topics.accepts(topic.name)) {
        file.topics[id] = kNotPlayed;
        continue;
      }
      for (const auto& [from, to] : options_.remap) {
        if (topic_in_file(topic.name) == from || topic.name == from) {
          topic.name = to.starts_with('/') && !to.starts_with("//") ? to.substr(1) : to;
          break;
        }
      }
      file.topics[id] = add_topic(topic);
    }
  }

  std::size_t add_topic(const TopicDescription& topic) {
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      if (topics_[i].name == topic.name && topics_[i].type_name == topic.type_name) {
        return i;
      }
    }
    topics_.push_back(topic);
    return topics_.size() - 1;
  }

  /// From here on, with what late joiners would get before.
  Status go_to(Time time) {
    anchor_ = time;
    next_clock_ = time;
    repeats_.clear();
    for (const auto& file : files_) {
      file->ended = false;
      file->head.reset();
      mcap::ReadOptions options;
      options.begin = time;
      options.end = play_last_included_ ? kForever : play_end_;
      options.accept = [&file = *file](const mcap::Channel& channel) {
        return file.topics.at(channel.id) != kNotPlayed;
      };
      file->cursor = file->reader.messages(options);
    }
    return find_latched(time);
  }

  Status find_latched(Time before) {
    std::map<std::size_t, std::deque<PlayedMessage>> last;
    for (const auto& file : files_) {
      mcap::ReadOptions options;
      options.end = before;
      options.accept = [this, &file = *file](const mcap::Channel& channel) {
        const std::size_t topic = file.topics.at(channel.id);
        return topic != kNotPlayed && topics_[topic].latched();
      };
      mcap::MessageCursor cursor = file->reader.messages(options);
      while (true) {
        const auto next = cursor.next();
        if (!next) {
          if (next.error().code == ErrorCode::kIo) {
            return next.error();
          }
          continue;  // a damaged chunk is told when it is played
        }
        if (!*next) {
          break;
        }
        const std::size_t topic = file->topics.at((*next)->channel_id);
        auto& kept = last[topic];
        kept.push_back(played(topic, **next, copy_of(**next)));
        if (kept.size() > latched_depth(topics_[topic])) {
          kept.pop_front();
        }
      }
    }
    for (auto& [topic, messages] : last) {
      for (PlayedMessage& message : messages) {
        message.latched_again = true;
        repeats_.push_back(std::move(message));
      }
    }
    std::stable_sort(
        repeats_.begin(), repeats_.end(),
        [](const PlayedMessage& a, const PlayedMessage& b) { return a.log_time < b.log_time; });
    return {};
  }

  /// The file with the next message, or null.
  Result<File*> peek() {
    File* first = nullptr;
    for (const auto& file : files_) {
      // A file that begins later than what is at hand need not be touched yet.
      if (first != nullptr && !file->head &&
          file->reader.summary().statistics->start_time > first->head->log_time) {
        continue;
      }
      if (!file->head && !file->ended) {
        auto next = file->cursor->next();
        if (!next) {
          return next.error();
        }
        file->head = *next;
        file->ended = !file->head.has_value();
        if (file->head) {
          file->payload = copy_of(*file->head);
        }
      }
      if (file->head && (first == nullptr || file->head->log_time < first->head->log_time)) {
        first = file.get();
      }
    }
    return first;
  }

  PlayedMessage pop(File& file) {
    PlayedMessage message =
        played(file.topics.at(file.head->channel_id), *file.head, std::move(file.payload));
    file.head.reset();
    played_any_ = true;
    return message;
  }

  PlayerEvent paused_event(File* file) {
    if (steps_ == 0) {
      return PlayerWait{};
    }
    if (file == nullptr) {
      return PlayerEnd{};
    }
    const Time time = file->head->log_time;
    if (options_.clock_hz > 0.0 && anchor_ < time) {
      anchor_ = time;
      return PlayedClock{time};
    }
    --steps_;
    anchor_ = time;
    return pop(*file);
  }

  PlayerEvent timed_event(Time now, File& file) {
    const Time at = position(now);
    const Time head = file.head->log_time;
    const bool has_clock = options_.clock_hz > 0.0;
    if (has_clock && next_clock_ <= std::min(at, head)) {
      const Duration period = Duration::seconds(1.0 / options_.clock_hz);
      // Ticks that were missed are made one.
      const std::int64_t missed = (std::min(at, head) - next_clock_).count_ns() /
                                  std::max<std::int64_t>(1, period.count_ns());
      const Time time = next_clock_ + period * missed;
      next_clock_ = time + period;
      return PlayedClock{time};
    }
    if (head <= at) {
      return pop(file);
    }
    const Time due = has_clock ? std::min(head, next_clock_) : head;
    Time until = anchor_now_ + Duration::seconds((due - anchor_).to_seconds() / options_.rate);
    // Rounded, it may come a little early.
    while (position(until) < due) {
      until += Duration::nanoseconds(1);
    }
    return PlayerWait{until};
  }

  /// The recording's time stays as it is at `now`.
  void hold(Time now) {
    anchor_ = position(now);
    anchor_now_ = now;
  }

  PlayerOptions options_;
  std::vector<std::unique_ptr<File>> files_;
  std::vector<TopicDescription> topics_;
  Time begin_;
  Time end_;
  Time play_begin_;
  Time play_end_;
  bool play_last_included_ = true;

  bool started_ = false;
  bool paused_;
  std::uint64_t steps_ = 0;
  std::uint64_t loops_ = 0;
  bool played_any_ = false;
  Time anchor_now_;  ///< of the caller's clock,
  Time anchor_;      ///< and the recording's time then
  Time next_clock_;
  std::deque<PlayedMessage> repeats_;
};

Player::Player(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Player::Player(Player&&) noexcept = default;
Player& Player::operator=(Player&&) noexcept = default;
Player::~Player() = default;

Result<Player> Player::open(const std::vector<std::filesystem::path>& files,
                            const PlayerOptions& options) {
  std::vector<std::unique_ptr<mcap::Source>> sources;
  for (const auto& file : files) {
    auto source = mcap::open_file(file);
    if (!source) {
      return source.error();
    }
    sources.push_back(std::move(*source));
  }
  return open(std::move(sources), options);
}

Result<Player> Player::open(std::vector<std::unique_ptr<mcap::Source>> files,
                            const PlayerOptions& options) {
  if (files.empty()) {
    return Error{ErrorCode::kInvalidArgument, "no file to play"};
  }
  auto impl = Impl::open(std::move(files), options);
  if (!impl) {
    return impl.error();
  }
  return Player(std::move(*impl));
}

const std::vector<TopicDescription>& Player::topics() const {
  return impl_->topics();
}
const PlayerOptions& Player::options() const {
  return impl_->options();
}
Time Player::begin() const {
  return impl_->begin();
}
Time Player::end() const {
  return impl_->end();
}
Result<PlayerEvent> Player::next(Time now) {
  return impl_->next(now);
}
Result<std::optional<PlayedMessage>> Player::next_message() {
  return impl_->next_message();
}
void Player::pause(Time now) {
  impl_->pause(now);
}
void Player::resume(Time now) {
  impl_->resume(now);
}
bool Player::paused() const {
  return impl_->paused();
}
void Player::step(std::uint64_t messages) {
  impl_->step(messages);
}
void Player::seek(Time now, Time to) {
  impl_->seek(now, to);
}
Status Player::set_rate(Time now, double rate) {
  return impl_->set_rate(now, rate);
}
Time Player::position(Time now) const {
  return impl_->position(now);
}
std::uint64_t Player::loops() const {
  return impl_->loops();
}

}  // namespace furrow::recording
