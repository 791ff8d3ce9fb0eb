#include "furrow_recording/recorder_thread.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace furrow::recording {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kTickPeriod{200};

struct QueuedMessage {
  std::size_t topic = 0;
  Time log_time;
  Time publish_time;
  Payload payload;  ///< null: serialize `message`
  std::shared_ptr<const void> message;
  const msgs::MessageType* type = nullptr;
  std::size_t bytes = 0;
};
/// A call of the recorder, in the order of the callers.
using Command = std::function<void(Recorder&)>;
using Item = std::variant<QueuedMessage, Command>;
/// Of a topic: name, type and publisher.
using Name = std::tuple<std::string, std::string, std::string>;

Payload serialize(const QueuedMessage& queued) {
  auto bytes = std::make_shared<std::vector<std::byte>>(queued.bytes);
  const auto size = queued.type->serialize(queued.message.get(), *bytes);
  if (!size) {
    return nullptr;
  }
  bytes->resize(*size);
  return bytes;
}

}  // namespace

class RecorderThread::Impl {
 public:
  Impl(const RecorderParameters& parameters, std::filesystem::path stem, RecorderClock clock,
       RecorderEnvironment environment)
      : clock_(clock),
        max_bytes_(static_cast<std::uint64_t>(parameters.queue_mb * 1e6)),
        max_messages_(static_cast<std::size_t>(parameters.queue_messages)),
        recorder_(parameters, std::move(stem), std::move(environment)),
        status_(recorder_.status()),
        thread_([this] { run(); }) {}

  ~Impl() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  [[nodiscard]] bool accepts(const std::string& topic) const { return recorder_.accepts(topic); }

  std::size_t add_topic(const TopicDescription& topic) {
    const std::lock_guard lock(mutex_);
    const Name name(topic.name, topic.type_name, topic.publisher);
    if (const auto known = std::ranges::find(names_, name); known != names_.end()) {
      return static_cast<std::size_t>(known - names_.begin());
    }
    // The recorder numbers in the same order.
    names_.push_back(name);
    dropped_.push_back(0);
    queue_.emplace_back(Command([topic](Recorder& recorder) { (void)recorder.add_topic(topic); }));
    ++commands_;
    return names_.size() - 1;
  }

  bool record(QueuedMessage message) {
    {
      std::unique_lock lock(mutex_);
      if (clock_ == RecorderClock::kSimulated) {
        // A message larger than the whole queue enters when the queue is empty.
        room_.wait(lock, [&] { return queued_messages_ == 0 || has_room(message); });
      } else if (!has_room(message)) {
        ++dropped_.at(message.topic);
        return false;
      }
      ++queued_messages_;
      queued_bytes_ += message.bytes;
      queue_.emplace_back(std::move(message));
    }
    wake_.notify_one();
    return true;
  }

  /// Returns when the recorder's thread has done it.
  void command(const Command& what) {
    std::unique_lock lock(mutex_);
    queue_.emplace_back(what);
    const std::uint64_t number = ++commands_;
    wake_.notify_one();
    done_.wait(lock, [this, number] { return commands_done_ >= number; });
  }

  [[nodiscard]] RecorderStatus status() const {
    const std::lock_guard lock(mutex_);
    RecorderStatus status = status_;
    // The recorder does not know of these yet.
    for (std::size_t i = 0; i < dropped_.size() && i < status.topics.size(); ++i) {
      status.topics[i].dropped += dropped_[i];
      status.dropped += dropped_[i];
    }
    return status;
  }

 private:
  [[nodiscard]] bool has_room(const QueuedMessage& message) const {
    return queued_messages_ < max_messages_ && queued_bytes_ + message.bytes <= max_bytes_;
  }

  void run() {
    Time newest;
    Clock::time_point newest_at = Clock::now();
    std::unique_lock lock(mutex_);
    while (true) {
      wake_.wait_for(lock, kTickPeriod, [this] { return !queue_.empty() || ending_; });
      const bool idle = queue_.empty();
      if (idle && ending_) {
        break;
      }
      std::deque<Item> items = std::exchange(queue_, {});
      lock.unlock();
      for (Item& item : items) {
        if (auto* queued = std::get_if<QueuedMessage>(&item)) {
          newest = std::max(newest, queued->log_time);
          newest_at = Clock::now();
          write(*queued);
        } else {
          std::get<Command>(item)(recorder_);
        }
      }
      if (idle && clock_ == RecorderClock::kReal) {
        // On the messages' clock, which advances while no message arrives.
        const auto since = std::chrono::nanoseconds(Clock::now() - newest_at);
        (void)recorder_.tick(newest + Duration::nanoseconds(since.count()));
      }
      lock.lock();
      std::uint64_t commands = commands_;
      for (const Item& item : queue_) {
        // Commands that arrived meanwhile are still waiting.
        commands -= std::holds_alternative<Command>(item) ? 1 : 0;
      }
      report_dropped();
      status_ = recorder_.status();
      commands_done_ = commands;
      done_.notify_all();
    }
    lock.unlock();
    (void)recorder_.stop();
  }

  void write(QueuedMessage& queued) {
    Payload payload = queued.payload ? std::move(queued.payload) : serialize(queued);
    (void)recorder_.write(queued.topic, queued.log_time, queued.publish_time, std::move(payload));
    queued.message.reset();
    const std::lock_guard lock(mutex_);
    --queued_messages_;
    queued_bytes_ -= queued.bytes;
    room_.notify_one();
  }

  void report_dropped() {
    const std::size_t known = recorder_.status().topics.size();
    for (std::size_t i = 0; i < dropped_.size() && i < known; ++i) {
      if (dropped_[i] > 0) {
        recorder_.count_dropped(i, std::exchange(dropped_[i], 0));
      }
    }
  }

  const RecorderClock clock_;
  const std::uint64_t max_bytes_;
  const std::size_t max_messages_;
  Recorder recorder_;  ///< used by the thread only

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  std::condition_variable room_;
  std::deque<Item> queue_;
  std::size_t queued_messages_ = 0;
  std::uint64_t queued_bytes_ = 0;
  std::vector<Name> names_;
  std::vector<std::uint64_t> dropped_;
  std::uint64_t commands_ = 0;
  std::uint64_t commands_done_ = 0;
  RecorderStatus status_;
  bool ending_ = false;
  std::thread thread_;  ///< last, because it uses all other members
};

RecorderThread::RecorderThread(const RecorderParameters& parameters, std::filesystem::path stem,
                               RecorderClock clock, RecorderEnvironment environment)
    : impl_(std::make_unique<Impl>(parameters, std::move(stem), clock, std::move(environment))) {}
RecorderThread::~RecorderThread() = default;

bool RecorderThread::accepts(const std::string& topic) const {
  return impl_->accepts(topic);
}
std::size_t RecorderThread::add_topic(const TopicDescription& topic) {
  return impl_->add_topic(topic);
}

bool RecorderThread::record(std::size_t topic, Time log_time, Time publish_time, Payload payload) {
  const std::size_t bytes = payload ? payload->size() : 0;
  return impl_->record(
      {topic, log_time, publish_time, std::move(payload), nullptr, nullptr, bytes});
}

bool RecorderThread::record(std::size_t topic, Time log_time, Time publish_time,
                            std::shared_ptr<const void> message, const msgs::MessageType& type) {
  const std::size_t bytes = type.serialized_size(message.get());
  return impl_->record({topic, log_time, publish_time, nullptr, std::move(message), &type, bytes});
}

void RecorderThread::trigger() {
  impl_->command([](Recorder& recorder) { (void)recorder.trigger(); });
}
void RecorderThread::pause() {
  impl_->command([](Recorder& recorder) { recorder.pause(); });
}
void RecorderThread::resume() {
  impl_->command([](Recorder& recorder) { recorder.resume(); });
}
Status RecorderThread::stop() {
  Status status;
  impl_->command([&status](Recorder& recorder) { status = recorder.stop(); });
  return status;
}
void RecorderThread::drain() {
  impl_->command([](Recorder&) {});
}
RecorderStatus RecorderThread::status() const {
  return impl_->status();
}

}  // namespace furrow::recording
