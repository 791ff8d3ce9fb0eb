#pragma once

#include <atomic>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <functional>
#include <map>
#include <set>
#include <thread>

#include "cdr_type.hpp"
#include "participant.hpp"

namespace furrow::dds {

/// Deserializes the samples of one reader and passes them on.
class SampleHandler {
 public:
  virtual ~SampleHandler() = default;
  /// Where the next sample is deserialized into.
  [[nodiscard]] virtual CdrSample& data() = 0;
  /// Passes the sample on. Returns its bytes, or 0 if it was malformed.
  [[nodiscard]] virtual std::size_t deliver(const eprosima::fastdds::dds::SampleInfo& info) = 0;
};

/// Reads one topic. With Qos::accept_best_effort it is one reliable DDS reader, joined by a best
/// effort one when a writer that offers best effort is discovered. Each writer is read by one of
/// the two, so that reliable writers stay reliable.
class Reader final : public graph::TransportReader, public Endpoint {
 public:
  Reader(Participant& participant, const std::string& topic, const std::string& type_name,
         const msgs::Qos& qos, std::unique_ptr<SampleHandler> handler);
  ~Reader() override;

  [[nodiscard]] int writers() const override { return writers_.load(std::memory_order_relaxed); }
  [[nodiscard]] graph::TransportCounters counters() const override;
  [[nodiscard]] EndpointStatus status() const override;
  [[nodiscard]] bool flush(std::chrono::steady_clock::time_point) override { return true; }

 private:
  /// Called by the receive threads of Fast DDS.
  class Listener final : public eprosima::fastdds::dds::DataReaderListener {
   public:
    Listener(Reader& reader, bool best_effort_only)
        : reader_(reader), best_effort_only_(best_effort_only) {}
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
    const bool best_effort_only_;  ///< of the second DDS reader: ignores reliable writers
  };

  [[nodiscard]] eprosima::fastdds::dds::DataReader* create(const msgs::Qos& qos,
                                                           Listener& listener);
  void take(eprosima::fastdds::dds::DataReader& reader, bool best_effort_only)
      FURROW_REQUIRES(mutex_);
  void count_gap(const eprosima::fastdds::dds::SampleInfo& info) FURROW_REQUIRES(mutex_);
  void update_matched(const Guid& writer, bool matched, bool best_effort_only)
      FURROW_REQUIRES(mutex_);
  /// In another thread, because a listener must not create endpoints.
  void add_best_effort_reader() FURROW_REQUIRES(mutex_);

  Participant& participant_;
  const std::string topic_;
  const std::string type_name_;
  const msgs::Qos qos_;
  std::unique_ptr<SampleHandler> handler_;
  std::atomic<int> writers_{0};
  std::atomic<std::uint64_t> messages_{0};
  std::atomic<std::uint64_t> bytes_{0};
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::uint64_t> deadlines_missed_{0};
  std::atomic<std::uint64_t> liveliness_losses_{0};
  std::atomic<int> best_effort_count_{0};
  IncompatibilityLog incompatible_;

  Mutex mutex_;  // held in the listeners' calls
  bool closed_ FURROW_GUARDED_BY(mutex_) = false;
  std::map<Guid, std::uint64_t> last_sequence_ FURROW_GUARDED_BY(mutex_);  // per matched writer
  std::set<Guid> silent_ FURROW_GUARDED_BY(mutex_);
  std::set<Guid> best_effort_writers_ FURROW_GUARDED_BY(mutex_);
  std::thread adding_ FURROW_GUARDED_BY(mutex_);

  Participant::TopicUse topic_use_;
  Listener listener_{*this, false};
  Listener best_effort_listener_{*this, true};
  eprosima::fastdds::dds::DataReader* best_effort_reader_ = nullptr;  // written by adding_
  eprosima::fastdds::dds::DataReader* data_reader_ = nullptr;  // last: its listener uses the above
};

}  // namespace furrow::dds
