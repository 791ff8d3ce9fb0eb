#include "furrow_dds/dds_transport.hpp"

#include <utility>

#include "reader.hpp"
#include "writer.hpp"

namespace furrow::dds {

namespace {

using SampleInfo = eprosima::fastdds::dds::SampleInfo;

class TypedHandler final : public SampleHandler {
 public:
  TypedHandler(const msgs::MessageType& type, std::function<void(graph::MessagePtr)> on_message)
      : message_(type), on_message_(std::move(on_message)) {}
  [[nodiscard]] CdrSample& data() override { return message_; }
  [[nodiscard]] std::size_t deliver(const SampleInfo&) override {
    graph::MessagePtr message = message_.take();
    if (message == nullptr) {
      return 0;
    }
    on_message_(std::move(message));
    return message_.size();
  }

 private:
  IncomingMessage message_;
  std::function<void(graph::MessagePtr)> on_message_;
};

class RawHandler final : public SampleHandler {
 public:
  explicit RawHandler(std::function<void(RawMessage)> on_message)
      : on_message_(std::move(on_message)) {}
  [[nodiscard]] CdrSample& data() override { return bytes_; }
  [[nodiscard]] std::size_t deliver(const SampleInfo& info) override {
    RawMessage message;
    const std::size_t size = bytes_.size();
    message.payload = bytes_.take();
    message.source_time = Time::from_nanoseconds(info.source_timestamp.to_ns());
    message.reception_time = Time::from_nanoseconds(info.reception_timestamp.to_ns());
    message.writer = to_guid(eprosima::fastrtps::rtps::iHandle2GUID(info.publication_handle));
    on_message_(std::move(message));
    return size;
  }

 private:
  IncomingBytes bytes_;
  std::function<void(RawMessage)> on_message_;
};

class BytesWriter final : public RawWriter {
 public:
  BytesWriter(Participant& participant, const std::string& topic, const std::string& type_name,
              const msgs::Qos& qos)
      : writer_(participant, topic, type_name, nullptr, qos) {}
  [[nodiscard]] bool has_readers() const override { return writer_.has_readers(); }
  void write(RawPayload payload) override { writer_.write(std::move(payload)); }
  [[nodiscard]] bool write_now(const std::vector<std::byte>& payload) override {
    return writer_.write_now(payload);
  }
  [[nodiscard]] graph::TransportCounters counters() const override { return writer_.counters(); }

 private:
  Writer writer_;
};

}  // namespace

DdsTransport::DdsTransport(const DdsParameters& parameters)
    : participant_(std::make_unique<Participant>(parameters)) {}

DdsTransport::~DdsTransport() = default;

std::unique_ptr<graph::TransportWriter> DdsTransport::make_writer(const std::string& topic,
                                                                  const msgs::MessageType& type,
                                                                  const msgs::Qos& qos) {
  return std::make_unique<Writer>(*participant_, topic, std::string(type.dds_name), &type, qos);
}

std::unique_ptr<graph::TransportReader> DdsTransport::make_reader(
    const std::string& topic, const msgs::MessageType& type, const msgs::Qos& qos,
    std::function<void(graph::MessagePtr)> on_message) {
  return std::make_unique<Reader>(*participant_, topic, std::string(type.dds_name), qos,
                                  std::make_unique<TypedHandler>(type, std::move(on_message)));
}

std::unique_ptr<RawWriter> DdsTransport::make_raw_writer(const std::string& topic,
                                                         const std::string& type_name,
                                                         const msgs::Qos& qos) {
  return std::make_unique<BytesWriter>(*participant_, topic, type_name, qos);
}

std::unique_ptr<RawReader> DdsTransport::make_raw_reader(
    const std::string& topic, const std::string& type_name, const msgs::Qos& qos,
    std::function<void(RawMessage)> on_message) {
  return std::make_unique<Reader>(*participant_, topic, type_name, qos,
                                  std::make_unique<RawHandler>(std::move(on_message)));
}

DiscoverySnapshot DdsTransport::discovery() const {
  return participant_->discovery().snapshot();
}

std::uint64_t DdsTransport::discovery_version() const {
  return participant_->discovery().version();
}

std::vector<EndpointStatus> DdsTransport::status() const {
  return participant_->status();
}

bool DdsTransport::flush(Duration timeout) {
  return participant_->flush(std::chrono::steady_clock::now() +
                             std::chrono::nanoseconds(timeout.count_ns()));
}

}  // namespace furrow::dds
