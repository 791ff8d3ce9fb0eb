#include "reader.hpp"

#include <system_error>
#include <utility>

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
      type_name_(type_name),
      qos_(qos),
      handler_(std::move(handler)),
      topic_use_(participant, topic, type_name),
      data_reader_(create(qos, listener_)) {
  if (data_reader_ == nullptr) {
    throw ConfigError("topic " + topic + ": DDS refused a reader with this QoS");
  }
  participant_.add(this);
}

Reader::~Reader() {
  participant_.remove(this);
  std::thread adding;
  {
    const MutexLock lock(mutex_);
    closed_ = true;
    adding = std::move(adding_);
  }
  if (adding.joinable()) adding.join();
  for (fdds::DataReader* reader : {data_reader_, best_effort_reader_}) {
    if (reader == nullptr) continue;
    reader->set_listener(nullptr);
    participant_.subscriber().delete_datareader(reader);
  }
}

fdds::DataReader* Reader::create(const msgs::Qos& qos, Listener& listener) {
  fdds::DataReaderQos own = reader_qos(qos);
  own.endpoint().unicast_locator_list = reader_locators(participant_.parameters(), type_name_);
  return participant_.subscriber().create_datareader(topic_use_.get(), own, &listener);
}

void Reader::add_best_effort_reader() {
  if (adding_.joinable()) return;  // there is one, or it is being created
  try {
    adding_ = std::thread([this] {
      best_effort_reader_ =
          create({.reliability = msgs::Reliability::kBestEffort, .depth = qos_.depth},
                 best_effort_listener_);
      if (best_effort_reader_ == nullptr) incompatible_.add("DDS refused a best effort reader");
    });
  } catch (const std::system_error& error) {
    incompatible_.add(std::string("no thread to create a best effort reader: ") + error.what());
  }
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
  status.best_effort_writers = best_effort_count_;
  incompatible_.add_to(status);
  return status;
}

void Reader::take(fdds::DataReader& reader, bool best_effort_only) {
  CdrSample nothing;
  fdds::SampleInfo info;
  // The writer is known before the sample is deserialized, which an ignored sample never is.
  while (reader.get_first_untaken_info(&info) == ReturnCode_t::RETCODE_OK) {
    const bool ignored = participant_.is_own(info.publication_handle) ||
                         (best_effort_only && !best_effort_writers_.contains(
                                                  to_guid(iHandle2GUID(info.publication_handle))));
    CdrSample& data = ignored ? nothing : handler_->data();
    if (reader.take_next_sample(&data, &info) != ReturnCode_t::RETCODE_OK) {
      return;
    }
    if (ignored || !info.valid_data) {
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

void Reader::update_matched(const Guid& writer, bool matched, bool best_effort_only) {
  if (matched) {
    // Discovery precedes the match.
    const bool best_effort =
        participant_.discovery().reliability_of(writer) == msgs::Reliability::kBestEffort;
    if (best_effort) best_effort_writers_.insert(writer);
    if (best_effort || !best_effort_only) ++writers_;
  } else if (best_effort_writers_.erase(writer) > 0 || !best_effort_only) {
    --writers_;
    last_sequence_.erase(writer);
    silent_.erase(writer);
  }
  best_effort_count_ = static_cast<int>(best_effort_writers_.size());
}

void Reader::Listener::on_data_available(fdds::DataReader* reader) {
  const MutexLock lock(reader_.mutex_);
  if (!reader_.closed_) {
    reader_.take(*reader, best_effort_only_);
  }
}

void Reader::Listener::on_subscription_matched(fdds::DataReader*,
                                               const fdds::SubscriptionMatchedStatus& status) {
  const MutexLock lock(reader_.mutex_);
  if (reader_.closed_ || reader_.participant_.is_own(status.last_publication_handle)) {
    return;
  }
  reader_.update_matched(to_guid(iHandle2GUID(status.last_publication_handle)),
                         status.current_count_change > 0, best_effort_only_);
}

void Reader::Listener::on_requested_deadline_missed(
    fdds::DataReader*, const eprosima::fastrtps::RequestedDeadlineMissedStatus& status) {
  const MutexLock lock(reader_.mutex_);
  // Without an external writer, messages come from the own process, which DDS does not see.
  if (!reader_.closed_ && status.total_count_change > 0 && reader_.writers_ > 0) {
    reader_.deadlines_missed_ += static_cast<std::uint64_t>(status.total_count_change);
  }
}

void Reader::Listener::on_liveliness_changed(
    fdds::DataReader*, const eprosima::fastrtps::LivelinessChangedStatus& status) {
  const MutexLock lock(reader_.mutex_);
  if (reader_.closed_ || best_effort_only_ ||
      reader_.participant_.is_own(status.last_publication_handle)) {
    return;
  }
  const Guid writer = to_guid(iHandle2GUID(status.last_publication_handle));
  if (status.not_alive_count_change > 0 && reader_.silent_.insert(writer).second) {
    ++reader_.liveliness_losses_;
  } else if (status.alive_count_change > 0) {
    reader_.silent_.erase(writer);
  }
}

void Reader::Listener::on_requested_incompatible_qos(
    fdds::DataReader*, const fdds::RequestedIncompatibleQosStatus& status) {
  const MutexLock lock(reader_.mutex_);
  if (reader_.closed_ || status.total_count_change <= 0) {
    return;
  }
  if (reader_.qos_.accept_best_effort && status.last_policy_id == fdds::RELIABILITY_QOS_POLICY_ID) {
    reader_.add_best_effort_reader();
  } else {
    reader_.incompatible_.add(reader_.participant_.incompatibility(
        reader_.topic_, false, reader_.qos_, status.last_policy_id));
  }
}

}  // namespace furrow::dds
