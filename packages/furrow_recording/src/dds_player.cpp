#include "furrow_recording/dds_player.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "furrow_core/statistics.hpp"
#include "furrow_msgs/type_names.hpp"

namespace furrow::recording {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kLatenessSamples = 4096;
constexpr std::chrono::milliseconds kReaderPollPeriod{5};
/// Readers of one process are discovered one after another, and match a little later than their
/// writers do.
constexpr std::chrono::milliseconds kSettle{500};
/// The transport sends topics whose first message is larger, so that they delay no other topic. The
/// player's thread sends the rest: it is late rather than losing a message.
constexpr std::size_t kQueuedBytes = 64 * 1024;
constexpr int kVolatileDepth = 100;
constexpr int kStaticDepth = 100;
constexpr std::string_view kClockType = "rosgraph_msgs/msg/Clock";

Time steady_time(Clock::time_point at = Clock::now()) {
  return Time::from_nanoseconds(
      std::chrono::duration_cast<std::chrono::nanoseconds>(at.time_since_epoch()).count());
}
Clock::time_point steady_point(Time time) {
  return Clock::time_point(std::chrono::nanoseconds(time.count_ns()));
}

/// The QoS of one writer that satisfies the readers of all recorded writers.
msgs::Qos strongest(const TopicDescription& topic) {
  msgs::Qos qos;
  qos.reliability =
      topic.offered_qos.empty() ? msgs::Reliability::kReliable : msgs::Reliability::kBestEffort;
  qos.depth = 0;
  for (const msgs::Qos& offered : topic.offered_qos) {
    qos.reliability = std::max(qos.reliability, offered.reliability);
    qos.durability = std::max(qos.durability, offered.durability);
    qos.depth += std::clamp(offered.depth, 0, 1000);
    const auto shortest = [](Duration a, Duration b) {
      return a == Duration() || (b != Duration() && b < a) ? b : a;
    };
    qos.deadline = shortest(qos.deadline, offered.deadline);
    qos.liveliness_lease = shortest(qos.liveliness_lease, offered.liveliness_lease);
  }
  if (topic.latched()) {
    qos.durability = msgs::Durability::kTransientLocal;
    // Stands for all publishers of static transforms, however many there were.
    qos.depth = topic.is_static_transforms() ? std::max(qos.depth, kStaticDepth) : qos.depth;
  } else {
    qos.depth = std::max(qos.depth, kVolatileDepth);
  }
  qos.depth = std::clamp(qos.depth, 1, 1000);
  return qos;
}

/// rosgraph_msgs/msg/Clock in CDR: encapsulation (little endian), seconds, nanoseconds.
Payload clock_payload(Time time) {
  constexpr std::int64_t kNsPerS = 1'000'000'000;
  const auto sec = static_cast<std::uint32_t>(time.count_ns() / kNsPerS);
  const auto nsec = static_cast<std::uint32_t>(time.count_ns() % kNsPerS);
  std::vector<std::byte> bytes = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  for (const std::uint32_t field : {sec, nsec}) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
      bytes.push_back(static_cast<std::byte>(field >> shift));
    }
  }
  return std::make_shared<const std::vector<std::byte>>(std::move(bytes));
}

}  // namespace

class DdsPlayer::Impl {
 public:
  Impl(dds::DdsTransport& transport, Player player, const DdsPlayerOptions& options)
      : options_(options), player_(std::move(player)) {
    for (const TopicDescription& topic : player_.topics()) {
      writers_.push_back(transport.make_raw_writer(topic.name, msgs::dds_type_name(topic.type_name),
                                                   strongest(topic)));
    }
    queued_.resize(writers_.size());
    if (player_.options().clock_hz > 0.0) {
      clock_ = transport.make_raw_writer("clock", msgs::dds_type_name(kClockType),
                                         msgs::sensor_stream_qos(10));
    }
    lateness_s_.reserve(kLatenessSamples);
    thread_ = std::thread([this] { run(); });
  }

  ~Impl() { stop(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// Calls with the player's lock held, then lets the thread look again what is due.
  template <class Function>
  auto with_player(Function function) {
    const auto lock = take_turn();
    changed_ = true;
    wake_.notify_one();
    return function(player_, steady_time());
  }

  void stop() {
    ending_ = true;
    {
      const auto lock = take_turn();  // the thread waits, or tests `ending_` next
      wake_.notify_one();
    }
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  bool wait(Duration timeout) {
    auto lock = take_turn();
    return done_.wait_for(lock, std::chrono::nanoseconds(timeout.count_ns()),
                          [this] { return finished_; });
  }

  [[nodiscard]] DdsPlayerStatus status() const {
    const auto lock = take_turn();
    DdsPlayerStatus status;
    status.messages = messages_;
    status.dropped = dropped_;
    for (const auto& writer : writers_) {
      status.dropped += writer->counters().dropped;
    }
    status.faults = faults_;
    status.last_fault = last_fault_;
    status.position = player_.position(steady_time());
    status.paused = player_.paused();
    status.finished = finished_;
    if (!lateness_s_.empty()) {
      status.lateness_p99_s = quantile(lateness_s_, 0.99);
    }
    return status;
  }

 private:
  /// The lock for callers. While a caller waits for it, the thread stops between two messages: a
  /// thread that always has a message due would otherwise keep every caller out.
  [[nodiscard]] std::unique_lock<std::mutex> take_turn() const {
    ++callers_;
    std::unique_lock lock(mutex_);
    --callers_;
    free_.notify_one();
    return lock;
  }

  void wait_for_readers(std::unique_lock<std::mutex>& lock) {
    const auto deadline =
        Clock::now() + std::chrono::nanoseconds(options_.wait_for_readers.count_ns());
    const auto read = [this] {
      return std::count_if(writers_.begin(), writers_.end(),
                           [](const auto& writer) { return writer->has_readers(); });
    };
    std::ptrdiff_t last = 0;
    auto changed_at = Clock::now();
    while (!ending_ && Clock::now() < deadline) {
      if (const auto now_read = read(); now_read != last) {
        last = now_read;
        changed_at = Clock::now();
      }
      if (last > 0 && Clock::now() - changed_at >= kSettle) {
        return;
      }
      wake_.wait_for(lock, kReaderPollPeriod, [this] { return ending_.load(); });
    }
  }

  void run() {
    std::unique_lock lock(mutex_);
    wait_for_readers(lock);
    while (!ending_) {
      free_.wait(lock, [this] { return callers_ == 0; });
      changed_ = false;
      const Time now = steady_time();
      const auto event = player_.next(now);
      if (event) {
        take(*event, now, lock);
        continue;
      }
      ++faults_;
      last_fault_ = event.error().message;
      if (event.error().code == ErrorCode::kIo) {
        break;
      }
    }
    finish();
  }

  void take(const PlayerEvent& event, Time now, std::unique_lock<std::mutex>& lock) {
    const auto woken = [this] { return changed_ || ending_; };
    if (const auto* message = std::get_if<PlayedMessage>(&event)) {
      play(*message, now);
    } else if (const auto* clock = std::get_if<PlayedClock>(&event)) {
      if (clock_) {
        clock_->write(clock_payload(clock->time));
      }
    } else if (const auto* pause = std::get_if<PlayerWait>(&event)) {
      if (pause->until) {
        wake_.wait_until(lock, steady_point(*pause->until), woken);
      } else {
        wake_.wait(lock, woken);
      }
    } else {
      finish();
      wake_.wait(lock, woken);  // for a seek back
      finished_ = ending_;
    }
  }

  void play(const PlayedMessage& message, Time now) {
    dds::RawWriter& writer = *writers_[message.topic];
    if (!queued_[message.topic]) {
      queued_[message.topic] = message.payload->size() > kQueuedBytes;
    }
    if (*queued_[message.topic]) {
      writer.write(message.payload);
    } else {
      const bool wanted = player_.topics()[message.topic].latched() || writer.has_readers();
      if (wanted && !writer.write_now(*message.payload)) {
        ++dropped_;
      }
    }
    ++messages_;
    if (message.latched_again || player_.paused()) {
      return;
    }
    const double late_s =
        (player_.position(now) - message.log_time).to_seconds() / player_.options().rate;
    if (lateness_s_.size() < kLatenessSamples) {
      lateness_s_.push_back(late_s);
    } else {
      lateness_s_[messages_ % kLatenessSamples] = late_s;
    }
  }

  void finish() {
    finished_ = true;
    done_.notify_all();
  }

  DdsPlayerOptions options_;
  std::vector<std::unique_ptr<dds::RawWriter>> writers_;  // by the player's topics
  std::vector<std::optional<bool>> queued_;               // by topic, when known
  std::unique_ptr<dds::RawWriter> clock_;

  mutable std::mutex mutex_;
  mutable std::atomic<int> callers_ = 0;  ///< that wait for the lock
  mutable std::condition_variable free_;  ///< a caller has taken the lock
  std::condition_variable wake_;
  std::condition_variable done_;
  Player player_;
  bool changed_ = false;
  std::atomic<bool> ending_ = false;
  bool finished_ = false;
  std::uint64_t messages_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t faults_ = 0;
  std::string last_fault_;
  std::vector<double> lateness_s_;
  std::thread thread_;  ///< last, because it uses all other members
};

DdsPlayer::DdsPlayer(dds::DdsTransport& transport, Player player, const DdsPlayerOptions& options)
    : impl_(std::make_unique<Impl>(transport, std::move(player), options)) {}
DdsPlayer::~DdsPlayer() = default;

void DdsPlayer::pause() {
  impl_->with_player([](Player& player, Time now) { player.pause(now); });
}
void DdsPlayer::resume() {
  impl_->with_player([](Player& player, Time now) { player.resume(now); });
}
void DdsPlayer::step(std::uint64_t messages) {
  impl_->with_player([messages](Player& player, Time) { player.step(messages); });
}
void DdsPlayer::seek(Time to) {
  impl_->with_player([to](Player& player, Time now) { player.seek(now, to); });
}
Status DdsPlayer::set_rate(double rate) {
  return impl_->with_player(
      [rate](Player& player, Time now) { return player.set_rate(now, rate); });
}
void DdsPlayer::stop() {
  impl_->stop();
}
bool DdsPlayer::wait(Duration timeout) {
  return impl_->wait(timeout);
}
DdsPlayerStatus DdsPlayer::status() const {
  return impl_->status();
}

}  // namespace furrow::recording
