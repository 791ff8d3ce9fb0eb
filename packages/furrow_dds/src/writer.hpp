#pragma once

#include <atomic>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>

#include "cdr_type.hpp"
#include "participant.hpp"
#include "send_queue.hpp"

namespace furrow::dds {

/// Writes messages of `type`; if that is null, std::vector<std::byte> in CDR form.
class Writer final : public graph::TransportWriter, public Endpoint, private MessageSink {
 public:
  Writer(Participant& participant, const std::string& topic, const std::string& type_name,
         const msgs::MessageType* type, const msgs::Qos& qos);
  ~Writer() override;

  [[nodiscard]] bool has_readers() const override {
    return readers_.load(std::memory_order_relaxed) > 0;
  }
  void write(graph::MessagePtr message) override;
  [[nodiscard]] bool write_now(const std::vector<std::byte>& payload);
  [[nodiscard]] graph::TransportCounters counters() const override { return queue_->counters(); }

  [[nodiscard]] EndpointStatus status() const override;
  [[nodiscard]] bool flush(std::chrono::steady_clock::time_point deadline) override;

 private:
  class Listener final : public eprosima::fastdds::dds::DataWriterListener {
   public:
    explicit Listener(Writer& writer) : writer_(writer) {}
    void close();
    void on_publication_matched(
        eprosima::fastdds::dds::DataWriter*,
        const eprosima::fastdds::dds::PublicationMatchedStatus& status) override;
    void on_offered_incompatible_qos(
        eprosima::fastdds::dds::DataWriter*,
        const eprosima::fastdds::dds::OfferedIncompatibleQosStatus& status) override;

   private:
    Writer& writer_;
    Mutex mutex_;
    bool closed_ FURROW_GUARDED_BY(mutex_) = false;
  };

  [[nodiscard]] std::size_t size(const graph::MessagePtr& message) override;
  [[nodiscard]] bool send(const graph::MessagePtr& message, std::size_t size) override;

  Participant& participant_;
  const std::string topic_;
  const msgs::MessageType* type_;
  const msgs::Qos qos_;
  std::atomic<int> readers_{0};
  IncompatibilityLog incompatible_;
  Participant::TopicUse topic_use_;
  Listener listener_{*this};
  eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
  std::unique_ptr<SendQueue> queue_;
};

}  // namespace furrow::dds
