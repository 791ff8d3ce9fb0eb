#include "reader.hpp"

#include "endpoint_qos.hpp"
#include "participant_qos.hpp"

namespace furrow::dds {

namespace fdds = eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::iHandle2GUID;
using eprosima::fastrtps::types::ReturnCode_t;

Reader::Reader(Participant& participant, const std::string& topic, const std::string& type_name,
               const msgs::Qos& qos, std::unique_ptr<SampleHandler> handler)
    : participant_(participant),
      topic_(topic),
      handler_(std::move(handler)),
      topic_use_(participant, topic, type_name) {
  fdds::DataReaderQos own = reader_qos(qos);
  own.endpoint().unicast_locator_list = reader_locators(participant.parameters(), type_name);
  data_reader_ = participant.subscriber().create_datareader(topic_use_.get(), own, &listener_);
  if (data_reader_ == nullptr) {
    throw ConfigError("topic " + topic + ": DDS refused a reader with this QoS");
  }
  participant_.add(this);
}

Reader::~Reader() {
  participant_.remove(this);
  listener_.close();
  data_reader_->set_listener(nullptr);
  participant_.subscriber().delete_datareader(data_reader_);
}

graph::TransportCounters Reader::counters() const {
  return {.messages = messages_, .bytes = bytes_, .dropped = dropped_};
}

EndpointStatus Reader::status() const {
  EndpointStatus status;
  status.topic = topic_;
  status.peers = writers_;
  status.counters = counters();
  status.deadlines_missed = deadlines_missed_;
  status.liveliness_losses = liveliness_losses_;
  status.incompatible = incompatible_;
  return status;
}

void Reader::take(fdds::DataReader& reader) {
  NoData nothing;
  fdds::SampleInfo info;
  // Who wrote it is looked at first: what this process wrote itself is not worth deserializing.
  while (reader.get_first_untaken_info(&info) == ReturnCode_t::RETCODE_OK) {
    const bool own = participant_.is_own(info.publication_handle);
    CdrSample& data = own ? nothing : handler_->data();
    if (reader.take_next_sample(&data, &info) != ReturnCode_t::RETCODE_OK) {
      return;
    }
    if (own || !info.valid_data) {
      continue;
    }
    count_gap(info);
    if (const std::size_t size = handler_->deliver(info); size > 0) {
      ++messages_;
      bytes_ += size;
    } else {
      ++dropped_;
    }
  }
}

void Reader::count_gap(const fdds::SampleInfo& info) {
  const std::uint64_t sequence = info.sample_identity.sequence_number().to64long();
  const auto [entry, first] =
      last_sequence_.try_emplace(to_guid(iHandle2GUID(info.publication_handle)), sequence);
  if (!first) {
    if (sequence > entry->second + 1) {
      dropped_ += sequence - entry->second - 1;
    }
    entry->second = sequence;
  }
}

void Reader::Listener::close() {
  const MutexLock lock(mutex_);
  closed_ = true;
}

void Reader::Listener::on_data_available(fdds::DataReader* reader) {
  const MutexLock lock(mutex_);
  if (!closed_) {
    reader_.take(*reader);
  }
}

void Reader::Listener::on_subscription_matched(fdds::DataReader*,
                                               const fdds::SubscriptionMatchedStatus& status) {
  const MutexLock lock(mutex_);
  if (closed_ || reader_.participant_.is_own(status.last_publication_handle)) {
    return;
  }
  reader_.writers_ += status.current_count_change;
  if (status.current_count_change < 0) {
    const Guid writer = to_guid(iHandle2GUID(status.last_publication_handle));
    reader_.last_sequence_.erase(writer);
    reader_.silent_.erase(writer);
  }
}

void Reader::Listener::on_requested_deadline_missed(
    fdds::DataReader*, const eprosima::fastrtps::RequestedDeadlineMissedStatus& status) {
  const MutexLock lock(mutex_);
  // Without a writer outside, messages come inside the process, where DDS does not see them.
  if (!closed_ && status.total_count_change > 0 && reader_.writers_ > 0) {
    reader_.deadlines_missed_ += static_cast<std::uint64_t>(status.total_count_change);
    reader_.participant_.report(TransportFaultKind::kDeadlineMissed, reader_.topic_);
  }
}

void Reader::Listener::on_liveliness_changed(
    fdds::DataReader*, const eprosima::fastrtps::LivelinessChangedStatus& status) {
  const MutexLock lock(mutex_);
  if (closed_ || reader_.participant_.is_own(status.last_publication_handle)) {
    return;
  }
  const Guid writer = to_guid(iHandle2GUID(status.last_publication_handle));
  if (status.not_alive_count_change > 0 && reader_.silent_.insert(writer).second) {
    ++reader_.liveliness_losses_;
    reader_.participant_.report(TransportFaultKind::kLivelinessLost, reader_.topic_);
  } else if (status.alive_count_change > 0 && reader_.silent_.erase(writer) > 0) {
    reader_.participant_.report(TransportFaultKind::kLivelinessRegained, reader_.topic_);
  }
}

void Reader::Listener::on_requested_incompatible_qos(
    fdds::DataReader*, const fdds::RequestedIncompatibleQosStatus& status) {
  const MutexLock lock(mutex_);
  if (!closed_ && status.total_count_change > 0) {
    reader_.incompatible_ += static_cast<std::uint64_t>(status.total_count_change);
    reader_.participant_.report(TransportFaultKind::kIncompatible, reader_.topic_);
  }
}

}  // namespace furrow::dds
