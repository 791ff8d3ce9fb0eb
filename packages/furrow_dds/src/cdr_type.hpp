#pragma once

#include <array>
#include <cstddef>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "furrow_dds/raw.hpp"
#include "furrow_msgs/message_type.hpp"

namespace furrow::dds {

/// The object behind the void pointers that Fast DDS passes to a CdrType. The base class is a
/// sample that is ignored.
class CdrSample {
 public:
  virtual ~CdrSample() = default;
  [[nodiscard]] virtual std::size_t size() const { return 0; }
  /// Bytes written; 0 if it failed.
  [[nodiscard]] virtual std::size_t serialize(std::span<std::byte>) const { return 0; }
  virtual void deserialize(std::span<const std::byte>) {}
};

class OutgoingMessage final : public CdrSample {
 public:
  OutgoingMessage(const msgs::MessageType& type, const void* message, std::size_t size)
      : type_(type), message_(message), size_(size) {}
  [[nodiscard]] std::size_t size() const override { return size_; }
  [[nodiscard]] std::size_t serialize(std::span<std::byte> out) const override;

 private:
  const msgs::MessageType& type_;
  const void* message_;
  std::size_t size_;
};

/// Deserializes into a new message. A large one reuses an earlier message without other holders,
/// preferably of the same size: allocating and clearing an image costs as much as copying it.
class IncomingMessage final : public CdrSample {
 public:
  explicit IncomingMessage(const msgs::MessageType& type) : type_(type) {}
  /// Null if there is no message, or it was malformed.
  [[nodiscard]] graph::MessagePtr take() { return std::exchange(message_, nullptr); }
  [[nodiscard]] std::size_t size() const override { return size_; }
  void deserialize(std::span<const std::byte> in) override;

 private:
  static constexpr std::size_t kKept = 4;

  struct Kept {
    std::shared_ptr<void> message;
    std::size_t size = 0;  ///< serialized
  };

  [[nodiscard]] std::shared_ptr<void> make_message();

  const msgs::MessageType& type_;
  graph::MessagePtr message_;
  std::size_t size_ = 0;
  std::array<Kept, kKept> kept_;
};

class OutgoingBytes final : public CdrSample {
 public:
  explicit OutgoingBytes(std::span<const std::byte> bytes) : bytes_(bytes) {}
  [[nodiscard]] std::size_t size() const override { return bytes_.size(); }
  [[nodiscard]] std::size_t serialize(std::span<std::byte> out) const override;

 private:
  std::span<const std::byte> bytes_;
};

class IncomingBytes final : public CdrSample {
 public:
  [[nodiscard]] std::vector<std::byte> take() { return std::exchange(bytes_, {}); }
  [[nodiscard]] std::size_t size() const override { return bytes_.size(); }
  void deserialize(std::span<const std::byte> in) override { bytes_.assign(in.begin(), in.end()); }

 private:
  std::vector<std::byte> bytes_;
};

/// A type that Fast DDS knows by its name only; samples are CdrSample. Typed and raw endpoints of a
/// topic share it, because a participant accepts one implementation for a name.
class CdrType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit CdrType(const std::string& type_name);

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override;
  std::function<uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override { return new CdrSample; }
  void deleteData(void* data) override { delete static_cast<CdrSample*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
  bool is_bounded() const override { return false; }
  bool is_plain() const override { return false; }
};

}  // namespace furrow::dds
