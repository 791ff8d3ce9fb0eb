#include "cdr_type.hpp"

#include <algorithm>
#include <atomic>

namespace furrow::dds {

using eprosima::fastrtps::rtps::SerializedPayload_t;

namespace {
// Size of the first payloads of a pool. Each grows to the size of its message.
constexpr std::uint32_t kInitialPayloadBytes = 256;
constexpr std::size_t kEncapsulationBytes = 4;
// Messages below this size are not kept for reuse.
constexpr std::size_t kReuseBytes = 65536;
}  // namespace

std::size_t OutgoingMessage::serialize(std::span<std::byte> out) const {
  const Result<std::size_t> written = type_.serialize(message_, out);
  return written ? *written : 0;
}

void IncomingMessage::deserialize(std::span<const std::byte> in) {
  size_ = in.size();
  std::shared_ptr<void> message = make_message();
  message_ = type_.deserialize(in, message.get()) ? std::move(message) : nullptr;
}

std::shared_ptr<void> IncomingMessage::make_message() {
  if (size_ < kReuseBytes) {
    return type_.create();
  }
  Kept* best = nullptr;
  for (Kept& kept : kept_) {
    if (kept.message.use_count() > 1) {
      continue;
    }
    // A message that has to grow would first clear its memory.
    if (kept.size == size_) {
      best = &kept;
      break;
    }
    if (best == nullptr || kept.size == 0) {
      best = &kept;
    }
  }
  if (best == nullptr) {
    return type_.create();
  }
  if (best->message == nullptr) {
    best->message = type_.create();
  }
  // The last holder has read before we write.
  std::atomic_thread_fence(std::memory_order_acquire);
  best->size = size_;
  return best->message;
}

std::size_t OutgoingBytes::serialize(std::span<std::byte> out) const {
  if (out.size() < bytes_.size()) {
    return 0;
  }
  std::copy(bytes_.begin(), bytes_.end(), out.begin());
  return bytes_.size();
}

CdrType::CdrType(const std::string& type_name) {
  setName(type_name.c_str());
  m_typeSize = kInitialPayloadBytes;
  m_isGetKeyDefined = false;
  auto_fill_type_object(false);
  auto_fill_type_information(false);
}

bool CdrType::serialize(void* data, SerializedPayload_t* payload) {
  const auto& message = *static_cast<const CdrSample*>(data);
  auto* out = reinterpret_cast<std::byte*>(payload->data);
  const std::size_t written = message.serialize({out, payload->max_size});
  if (written < kEncapsulationBytes) {
    return false;
  }
  payload->length = static_cast<std::uint32_t>(written);
  payload->encapsulation = (payload->data[1] & 1U) != 0 ? CDR_LE : CDR_BE;
  return true;
}

bool CdrType::deserialize(SerializedPayload_t* payload, void* data) {
  const auto* in = reinterpret_cast<const std::byte*>(payload->data);
  static_cast<CdrSample*>(data)->deserialize({in, payload->length});
  return true;  // the reader counts malformed samples; false would keep them in the history
}

std::function<uint32_t()> CdrType::getSerializedSizeProvider(void* data) {
  return [data] { return static_cast<std::uint32_t>(static_cast<CdrSample*>(data)->size()); };
}

}  // namespace furrow::dds
