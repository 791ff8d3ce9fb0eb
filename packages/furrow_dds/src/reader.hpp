#pragma once

#include <atomic>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <functional>
#include <map>
#include <set>

#include "cdr_type.hpp"
#include "participant.hpp"

namespace furrow::dds {

/// How samples of one reader are read and handed on.
class SampleHandler {
 public:
  virtual ~SampleHandler() = default;
  /// Where the next sample is read into.
  [[nodiscard]] virtual CdrSample& data() = 0;
  /// Hands on what was read; its bytes, or 0 when it was malformed.
  [[nodiscard]] virtual std::size_t deliver(const eprosima::fastdds::dds::SampleInfo& info) = 0;
};

class Reader final : public Endpoint {
 public:
  Reader(Participant& participant, const std::string& topic, const std::string& type_name,
         const msgs::Qos& qos, std::unique_ptr<SampleHandler> handler);
  ~Reader() override;

  [[nodiscard]] int writers() const { return writers_.load(std::memory_order_relaxed); }
  [[nodiscard]] graph::TransportCounters counters() const;
  [[nodiscard]] EndpointStatus status() const override;
  [[nodiscard]] bool flush(std::chrono::steady_clock::time_point) override { return true; }

 private:
  /// Its calls may come from several threads; none acts after close().
  class Listener final : public eprosima::fastdds::dds::DataReaderListener {
   public:
    explicit Listener(Reader& reader) : reader_(reader) {}
    void close();
    void on_data_available(eprosima::fastdds::dds::DataReader* reader) override;
    void on_subscription_matched(
        eprosima::fastdds::dds::DataReader*,
        const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override;
    void on_requested_deadline_missed(
        eprosima::fastdds::dds::DataReader*,
        const eprosima::fastrtps::RequestedDeadlineMissedStatus& status) override;
    void on_liveliness_changed(eprosima::fastdds::dds::DataReader*,
                               const eprosima::fastrtps::LivelinessChangedStatus& status) override;
    void on_requested_incompatible_qos(
        eprosima::fastdds::dds::DataReader*,
        const eprosima::fastdds::dds::RequestedIncompatibleQosStatus& status) override;

   private:
    Reader& reader_;
    Mutex mutex_;
    bool closed_ FURROW_GUARDED_BY(mutex_) = false;
  };

  void take(eprosima::fastdds::dds::DataReader& reader);
  void count_gap(const eprosima::fastdds::dds::SampleInfo& info);

  Participant& participant_;
  const std::string topic_;
  std::unique_ptr<SampleHandler> handler_;
  std::atomic<int> writers_{0};
  std::atomic<std::uint64_t> messages_{0};
  std::atomic<std::uint64_t> bytes_{0};
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::uint64_t> deadlines_missed_{0};
  std::atomic<std::uint64_t> liveliness_losses_{0};
  std::atomic<std::uint64_t> incompatible_{0};
  // Used by the listener under its mutex; an entry per matched writer.
  std::map<Guid, std::uint64_t> last_sequence_;
  std::set<Guid> silent_;
  Participant::TopicUse topic_use_;
  Listener listener_{*this};
  eprosima::fastdds::dds::DataReader* data_reader_ = nullptr;
};

}  // namespace furrow::dds
