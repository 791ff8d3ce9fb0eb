#include "furrow_recording/dds_recorder.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "furrow_msgs/topics.hpp"
#include "furrow_recording/recorder_thread.hpp"

namespace furrow::recording {
namespace {

constexpr std::chrono::milliseconds kLookPeriod{20};
/// Messages of one topic between the transport and the recorder's queue.
constexpr int kReaderDepth = 100;

/// The QoS that all of these writers offer.
msgs::Qos weakest(const std::vector<dds::EndpointInfo>& writers) {
  msgs::Qos qos;
  qos.reliability = msgs::Reliability::kReliable;
  qos.durability = msgs::Durability::kTransientLocal;
  qos.depth = kReaderDepth;
  for (const dds::EndpointInfo& writer : writers) {
    qos.reliability = std::min(qos.reliability, writer.qos.reliability);
    qos.durability = std::min(qos.durability, writer.qos.durability);
  }
  return qos;
}

std::vector<msgs::Qos> distinct_qos(const std::string& topic,
                                    const std::vector<dds::EndpointInfo>& writers) {
  const msgs::Topic* known = msgs::find_topic(topic);
  std::vector<msgs::Qos> profiles;
  for (const dds::EndpointInfo& writer : writers) {
    msgs::Qos qos = writer.qos;
    if (qos.depth == 0 && known != nullptr) {
      qos.depth = known->qos.depth;  // the depth is not transmitted
    }
    const bool is_known =
        std::any_of(profiles.begin(), profiles.end(), [&qos](const msgs::Qos& other) {
          return other.reliability == qos.reliability && other.durability == qos.durability &&
                 other.depth == qos.depth && other.deadline == qos.deadline &&
                 other.liveliness_lease == qos.liveliness_lease;
        });
    if (!is_known) {
      profiles.push_back(qos);
    }
  }
  return profiles;
}

/// The channels of one topic. Each publisher of a latched topic has its own: of each, the last
/// message holds. Used by the reader's callback only.
class RecordedChannels {
 public:
  RecordedChannels(RecorderThread& recorder, TopicDescription topic)
      : recorder_(recorder), topic_(std::move(topic)) {
    if (!topic_.latched()) {
      shared_ = recorder_.add_topic(topic_);
    }
  }

  std::size_t number(const dds::Guid& writer) {
    if (shared_) {
      return *shared_;
    }
    const auto known = numbers_.find(writer);
    if (known != numbers_.end()) {
      return known->second;
    }
    TopicDescription topic = topic_;
    topic.publisher = hexadecimal(writer);
    return numbers_[writer] = recorder_.add_topic(topic);
  }

 private:
  static std::string hexadecimal(const dds::Guid& guid) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (const std::uint8_t byte : guid.bytes) {
      text += {kDigits[byte >> 4U], kDigits[byte & 0xFU]};
    }
    return text;
  }

  RecorderThread& recorder_;
  TopicDescription topic_;
  std::optional<std::size_t> shared_;  ///< of all publishers
  std::map<dds::Guid, std::size_t> numbers_;
};

}  // namespace

class DdsRecorder::Impl {
 public:
  Impl(dds::DdsTransport& transport, const RecorderParameters& parameters,
       std::filesystem::path stem)
      : transport_(transport),
        style_(parameters.schema == "omgidl" ? SchemaStyle::kOmgidl : SchemaStyle::kRos2msg),
        recorder_(parameters, std::move(stem)),
        thread_([this] { run(); }) {}

  ~Impl() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    wake_.notify_one();
    thread_.join();
    readers_.clear();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  [[nodiscard]] RecorderThread& recorder() { return recorder_; }

  [[nodiscard]] std::vector<std::string> skipped() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> list;
    for (const auto& [topic, reason] : skipped_) {
      list.push_back(topic);
      list.back().append(": ").append(reason);
    }
    return list;
  }

 private:
  struct Subscription {
    std::string type_name;
    msgs::Qos qos;
    std::unique_ptr<dds::RawReader> reader;
  };

  void run() {
    std::uint64_t seen = 0;
    std::unique_lock lock(mutex_);
    while (!ending_) {
      lock.unlock();
      if (transport_.discovery_version() != seen) {
        const dds::DiscoverySnapshot snapshot = transport_.discovery();
        seen = snapshot.version;
        for (const dds::TopicInfo& topic : snapshot.topics) {
          look_at(topic);
        }
      }
      lock.lock();
      wake_.wait_for(lock, kLookPeriod, [this] { return ending_; });
    }
  }

  void look_at(const dds::TopicInfo& topic) {
    if (!recorder_.accepts(topic.name)) {
      return;
    }
    std::vector<dds::EndpointInfo> writers;
    std::string refused;
    const auto known = readers_.find(topic.name);
    std::string type_name = known == readers_.end() ? std::string() : known->second.type_name;
    for (const dds::EndpointInfo& writer : topic.writers) {
      if (writer.own) {
        continue;
      }
      if (writer.keyed) {
        refused = "it has keys";
        continue;
      }
      type_name = type_name.empty() ? writer.type_name : type_name;
      if (writer.type_name != type_name) {
        refused = "a writer has another type, " + writer.type_name;
        continue;
      }
      writers.push_back(writer);
    }
    if (!refused.empty()) {
      skip(topic.name, refused);
    }
    if (writers.empty()) {
      return;
    }
    const msgs::Qos qos = weakest(writers);
    if (known != readers_.end()) {
      // A reader that asks for more than a new writer offers would not get its messages.
      if (known->second.qos.reliability <= qos.reliability &&
          known->second.qos.durability <= qos.durability) {
        return;
      }
      readers_.erase(known);
    }
    subscribe(topic.name, type_name, qos, distinct_qos(topic.name, writers));
  }

  void subscribe(const std::string& name, const std::string& type_name, const msgs::Qos& qos,
                 const std::vector<msgs::Qos>& offered) {
    const auto topics = std::make_shared<RecordedChannels>(
        recorder_, describe_topic(name, type_name, offered, style_));
    try {
      auto reader =
          transport_.make_raw_reader(name, type_name, qos, [this, topics](dds::RawMessage message) {
            recorder_.record(
                topics->number(message.writer), message.reception_time, message.source_time,
                std::make_shared<const std::vector<std::byte>>(std::move(message.payload)));
          });
      readers_[name] = {type_name, qos, std::move(reader)};
    } catch (const ConfigError& failure) {
      skip(name, failure.what());
    }
  }

  void skip(const std::string& topic, const std::string& reason) {
    const std::lock_guard lock(mutex_);
    skipped_[topic] = reason;
  }

  dds::DdsTransport& transport_;
  SchemaStyle style_;
  RecorderThread recorder_;
  std::map<std::string, Subscription> readers_;  // of the thread
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool ending_ = false;
  std::map<std::string, std::string> skipped_;
  std::thread thread_;  // last: it uses all others
};

DdsRecorder::DdsRecorder(dds::DdsTransport& transport, const RecorderParameters& parameters,
                         std::filesystem::path stem)
    : impl_(std::make_unique<Impl>(transport, parameters, std::move(stem))) {}
DdsRecorder::~DdsRecorder() = default;

void DdsRecorder::trigger() {
  impl_->recorder().trigger();
}
void DdsRecorder::pause() {
  impl_->recorder().pause();
}
void DdsRecorder::resume() {
  impl_->recorder().resume();
}
Status DdsRecorder::stop() {
  return impl_->recorder().stop();
}
RecorderStatus DdsRecorder::status() const {
  return impl_->recorder().status();
}
std::vector<std::string> DdsRecorder::skipped() const {
  return impl_->skipped();
}

}  // namespace furrow::recording
