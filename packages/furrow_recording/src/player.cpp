#include "furrow_recording/player.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "playback_source.hpp"

namespace furrow::recording {
namespace {

constexpr double kMinRate = 1e-3;
constexpr double kMaxRate = 1e3;
/// What is shorter is looped with kLoopPeriod: without a pause it would fill the CPU.
constexpr Duration kShortestLoop = Duration::milliseconds(10);
constexpr Duration kLoopPeriod = Duration::milliseconds(1000);

Status check_rate(double rate) {
  if (!(rate >= kMinRate && rate <= kMaxRate)) {
    return Error{ErrorCode::kInvalidArgument, "the rate must be between 0.001 and 1000"};
  }
  return {};
}

Status check_options(const PlayerOptions& options) {
  if (!std::isfinite(options.clock_hz) || options.clock_hz < 0.0 || options.clock_hz > 1e6) {
    return Error{ErrorCode::kInvalidArgument, "clock_hz must be between 0 and 1e6"};
  }
  return check_rate(options.rate);
}

}  // namespace

class Player::Impl {
 public:
  Impl(std::unique_ptr<PlaybackSource> source, const PlayerOptions& options)
      : source_(std::move(source)),
        options_(options),
        paused_(options.start_paused),
        anchor_(source_->begin()) {}

  [[nodiscard]] const PlaybackSource& source() const { return *source_; }
  [[nodiscard]] const PlayerOptions& options() const { return options_; }
  [[nodiscard]] bool paused() const { return paused_; }
  [[nodiscard]] std::uint64_t loops() const { return loops_; }

  Result<PlayerEvent> next(Time now) {
    if (!started_) {
      if (Status status = start(now, source_->begin()); !status) {
        return status.error();
      }
    }
    const auto head = source_->peek();
    if (!head) {
      return head.error();
    }
    if (*head != nullptr) {
      if ((*head)->latched_again) {
        return PlayerEvent(source_->pop());
      }
      return paused_ ? paused_event(**head) : timed_event(now, (*head)->log_time);
    }
    if (paused_) {
      return steps_ > 0 ? PlayerEvent(PlayerEnd{}) : PlayerEvent(PlayerWait{});
    }
    if (!options_.loop || !played_any_) {
      return PlayerEvent(PlayerEnd{});
    }
    return loop_event(now);
  }

  Result<std::optional<PlayedMessage>> next_message() {
    if (!started_) {
      if (Status status = start(Time(), source_->begin()); !status) {
        return status.error();
      }
    }
    const auto head = source_->peek();
    if (!head) {
      return head.error();
    }
    return *head == nullptr ? std::optional<PlayedMessage>() : std::optional(source_->pop());
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
    // A failure shows again at the next read.
    (void)start(now, std::clamp(to, source_->begin(), source_->end()));
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
    const Time end = source_->recording().statistics().end_time;
    const double passed_s = (now - anchor_now_).to_seconds() * options_.rate;
    const double left_s = (end - anchor_).to_seconds();
    return passed_s >= left_s ? std::max(anchor_, end) : anchor_ + Duration::seconds(passed_s);
  }

 private:
  /// Sets the recording's time to `time` at `now`.
  Status start(Time now, Time time) {
    started_ = true;
    ended_at_.reset();
    anchor_now_ = now;
    anchor_ = time;
    next_clock_ = time;
    return source_->go_to(time);
  }

  PlayedMessage pop() {
    played_any_ = true;
    return source_->pop();
  }

  PlayerEvent paused_event(const PlayedMessage& head) {
    if (steps_ == 0) {
      return PlayerWait{};
    }
    const bool clock_first = options_.clock_hz > 0.0 && anchor_ < head.log_time;
    anchor_ = head.log_time;
    if (clock_first) {
      return PlayedClock{anchor_};
    }
    --steps_;
    return pop();
  }

  PlayerEvent timed_event(Time now, Time head) {
    const Time at = position(now);
    const bool has_clock = options_.clock_hz > 0.0;
    if (has_clock && next_clock_ <= std::min(at, head)) {
      const Duration period = Duration::seconds(1.0 / options_.clock_hz);
      // Missed ticks become one.
      const std::int64_t missed = (std::min(at, head) - next_clock_).count_ns() /
                                  std::max<std::int64_t>(1, period.count_ns());
      const Time time = next_clock_ + period * missed;
      next_clock_ = time + period;
      return PlayedClock{time};
    }
    if (head <= at) {
      return pop();
    }
    const Time due = has_clock ? std::min(head, next_clock_) : head;
    Time until = anchor_now_ + Duration::seconds((due - anchor_).to_seconds() / options_.rate);
    // Rounding may make it a little early.
    while (position(until) < due) {
      until += Duration::nanoseconds(1);
    }
    return PlayerWait{until};
  }

  Result<PlayerEvent> loop_event(Time now) {
    if (!ended_at_) {
      ended_at_ = now;
    }
    const Duration length = source_->end() - source_->begin();
    if (length < kShortestLoop) {
      const Time again =
          *ended_at_ + Duration::seconds((kLoopPeriod - length).to_seconds() / options_.rate);
      if (now < again) {
        return PlayerEvent(PlayerWait{again});
      }
    }
    ++loops_;
    played_any_ = false;
    if (Status status = start(now, source_->begin()); !status) {
      return status.error();
    }
    return next(now);
  }

  /// Keeps the recording's time at what it is at `now`.
  void hold(Time now) {
    anchor_ = position(now);
    anchor_now_ = now;
  }

  std::unique_ptr<PlaybackSource> source_;
  PlayerOptions options_;
  bool started_ = false;
  bool paused_;
  std::uint64_t steps_ = 0;
  std::uint64_t loops_ = 0;
  bool played_any_ = false;
  std::optional<Time> ended_at_;  ///< when the end was reached, of the caller's clock
  Time anchor_now_;               ///< a time of the caller's clock,
  Time anchor_;                   ///< and the recording's time then
  Time next_clock_;
};

Player::Player(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Player::Player(Player&&) noexcept = default;
Player& Player::operator=(Player&&) noexcept = default;
Player::~Player() = default;

Result<Player> Player::open(const std::vector<std::filesystem::path>& files,
                            const PlayerOptions& options) {
  auto recording = open_recordings(files);
  if (!recording) {
    return recording.error();
  }
  return open(std::move(*recording), options);
}

Result<Player> Player::open(std::unique_ptr<RecordingReader> recording,
                            const PlayerOptions& options) {
  if (Status status = check_options(options); !status) {
    return status.error();
  }
  auto source = PlaybackSource::open(std::move(recording), options);
  if (!source) {
    return source.error();
  }
  return Player(std::make_unique<Impl>(std::move(*source), options));
}

const std::vector<TopicDescription>& Player::topics() const {
  return impl_->source().topics();
}
const std::vector<UnplayableTopic>& Player::unplayable() const {
  return impl_->source().unplayable();
}
const std::vector<std::string>& Player::unmatched_patterns() const {
  return impl_->source().unmatched();
}
const RecordingInfo& Player::recording() const {
  return impl_->source().recording();
}
const PlayerOptions& Player::options() const {
  return impl_->options();
}
Time Player::begin() const {
  return impl_->source().recording().statistics().start_time;
}
Time Player::end() const {
  return impl_->source().recording().statistics().end_time;
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
