#include "writer.hpp"

#include <algorithm>
#include <limits>

#include "endpoint_qos.hpp"

namespace furrow::dds {

namespace fdds = eprosima::fastdds::dds;
using eprosima::fastrtps::types::ReturnCode_t;

Writer::Writer(Participant& participant, const std::string& topic, const std::string& type_name,
               const msgs::MessageType* type, const msgs::Qos& qos)
    : participant_(participant),
      topic_(topic),
      type_(type),
      qos_(qos),
      topic_use_(participant, topic, type_name) {
  const std::int64_t depth =
      std::clamp<std::int64_t>(qos.depth, 1, participant.parameters().queue_limit);
  queue_ = std::make_unique<SendQueue>(participant.sender(), static_cast<MessageSink&>(*this),
                                       static_cast<std::size_t>(depth));
  writer_ =
      participant.publisher().create_datawriter(topic_use_.get(), writer_qos(qos), &listener_);
  if (writer_ == nullptr) {
    throw ConfigError("topic " + topic + ": DDS refused a writer with this QoS");
  }
  participant_.add(this);
}

Writer::~Writer() {
  participant_.remove(this);
  participant_.linger(*this);
  queue_.reset();
  listener_.close();
  writer_->set_listener(nullptr);
  participant_.publisher().delete_datawriter(writer_);
}

void Writer::write(graph::MessagePtr message) {
  if (message == nullptr) {
    queue_->count_dropped();
  } else if (qos_.durability == msgs::Durability::kTransientLocal || has_readers()) {
    queue_->push(std::move(message));
  }
}

std::size_t Writer::size(const graph::MessagePtr& message) {
  return type_ != nullptr ? type_->serialized_size(message.get())
                          : static_cast<const std::vector<std::byte>*>(message.get())->size();
}

bool Writer::send(const graph::MessagePtr& message, std::size_t size) {
  if (size > std::numeric_limits<std::int32_t>::max()) {
    return false;
  }
  if (type_ != nullptr) {
    OutgoingMessage data(*type_, message.get(), size);
    return writer_->write(static_cast<CdrSample*>(&data));
  }
  return write_now(*static_cast<const std::vector<std::byte>*>(message.get()));
}

bool Writer::write_now(const std::vector<std::byte>& payload) {
  OutgoingBytes data(payload);
  return writer_->write(static_cast<CdrSample*>(&data));
}

EndpointStatus Writer::status() const {
  EndpointStatus status;
  status.topic = topic_;
  status.writer = true;
  status.peers = readers_;
  status.counters = counters();
  incompatible_.add_to(status);
  return status;
}

bool Writer::flush(std::chrono::steady_clock::time_point deadline) {
  if (!queue_->wait_idle(deadline)) {
    return false;
  }
  if (qos_.reliability == msgs::Reliability::kBestEffort || !has_readers()) {
    return true;
  }
  const auto left = std::max(std::chrono::nanoseconds(0),
                             std::chrono::nanoseconds(deadline - std::chrono::steady_clock::now()));
  return writer_->wait_for_acknowledgments(to_dds(Duration::nanoseconds(left.count()))) ==
         ReturnCode_t::RETCODE_OK;
}

void Writer::Listener::close() {
  const MutexLock lock(mutex_);
  closed_ = true;
}

void Writer::Listener::on_publication_matched(fdds::DataWriter*,
                                              const fdds::PublicationMatchedStatus& status) {
  const MutexLock lock(mutex_);
  if (!closed_ && !writer_.participant_.is_own(status.last_subscription_handle)) {
    writer_.readers_ += status.current_count_change;
  }
}

void Writer::Listener::on_offered_incompatible_qos(
    fdds::DataWriter*, const fdds::OfferedIncompatibleQosStatus& status) {
  const MutexLock lock(mutex_);
  if (!closed_ && status.total_count_change > 0) {
    writer_.incompatible_.add(writer_.participant_.incompatibility(
        writer_.topic_, true, writer_.qos_, status.last_policy_id));
  }
}

}  // namespace furrow::dds
