#include "step.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

namespace furrow::graph {
namespace {

static_assert(std::endian::native == std::endian::little, "the CDR form is little-endian");

constexpr std::size_t kEncapsulation = 4;
constexpr std::byte kLittleEndian{1};

/// Writes XCDR1. Without a buffer it only counts the bytes.
class CdrWriter {
 public:
  CdrWriter() = default;
  explicit CdrWriter(std::span<std::byte> buffer) : buffer_(buffer) {}

  template <class T>
  void number(T value) {
    align(sizeof(T));
    raw(&value, sizeof(T));
  }
  void flag(bool value) { number<std::uint8_t>(value ? 1 : 0); }
  void text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    raw(value.c_str(), value.size() + 1);
  }
  void bytes(const std::vector<std::byte>& value) {
    number(static_cast<std::uint32_t>(value.size()));
    raw(value.data(), value.size());
  }
  [[nodiscard]] std::size_t size() const { return at_; }

 private:
  void align(std::size_t size) {
    while (at_ % size != 0) raw("", 1);
  }
  void raw(const void* data, std::size_t size) {
    if (!buffer_.empty() && size > 0) std::memcpy(buffer_.data() + at_, data, size);
    at_ += size;
  }
  std::span<std::byte> buffer_;
  std::size_t at_ = 0;
};

/// Reads XCDR1. Beyond the end it returns zeros, and ok() is false.
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::byte> buffer) : buffer_(buffer) {}

  template <class T>
  T number() {
    at_ = (at_ + sizeof(T) - 1) / sizeof(T) * sizeof(T);
    T value{};
    if (const auto from = take(sizeof(T)); !from.empty()) {
      std::memcpy(&value, from.data(), sizeof(T));
    }
    return value;
  }
  bool flag() { return number<std::uint8_t>() != 0; }
  std::string text() {
    const auto from = take(number<std::uint32_t>());
    if (from.empty()) return {};
    return {reinterpret_cast<const char*>(from.data()), from.size() - 1};
  }
  std::vector<std::byte> bytes() {
    const auto from = take(number<std::uint32_t>());
    return {from.begin(), from.end()};
  }
  /// The length of a sequence whose elements take at least `element` bytes each.
  std::size_t length(std::size_t element) {
    const std::size_t count = number<std::uint32_t>();
    if (ok_ && count > (buffer_.size() - at_) / element) ok_ = false;
    return ok_ ? count : 0;
  }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  std::span<const std::byte> take(std::size_t size) {
    if (!ok_ || at_ > buffer_.size() || size > buffer_.size() - at_) {
      ok_ = false;
      return {};
    }
    const auto part = buffer_.subspan(at_, size);
    at_ += size;
    return part;
  }
  std::span<const std::byte> buffer_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

void write(const Step& step, CdrWriter& out) {
  out.number(step.number);
  out.number(step.run);
  out.number(step.instance);
  out.number(step.next_timer_ns);
  out.text(step.process);
  out.flag(step.stop);
  out.flag(step.failed);
  out.flag(step.aborted);
  out.text(step.reason);
  out.number(static_cast<std::uint32_t>(step.topics.size()));
  for (const std::uint32_t topic : step.topics) out.number(topic);
  out.number(static_cast<std::uint32_t>(step.messages.size()));
  for (const StepMessage& message : step.messages) {
    out.number(message.topic);
    out.number(message.component);
    out.bytes(message.cdr);
  }
}

bool read(CdrReader& in, Step& step) {
  step.number = in.number<std::uint64_t>();
  step.run = in.number<std::uint64_t>();
  step.instance = in.number<std::uint64_t>();
  step.next_timer_ns = in.number<std::int64_t>();
  step.process = in.text();
  step.stop = in.flag();
  step.failed = in.flag();
  step.aborted = in.flag();
  step.reason = in.text();
  step.topics.resize(in.length(sizeof(std::uint32_t)));
  for (std::uint32_t& topic : step.topics) topic = in.number<std::uint32_t>();
  constexpr std::size_t kSmallestMessage = 3 * sizeof(std::uint32_t);
  step.messages.resize(in.length(kSmallestMessage));
  for (StepMessage& message : step.messages) {
    message.topic = in.number<std::uint32_t>();
    message.component = in.number<std::uint32_t>();
    message.cdr = in.bytes();
  }
  return in.ok();
}

constexpr std::string_view kIdl = R"(module furrow_graph { module msg {

@final struct StepMessage {
  unsigned long topic;
  unsigned long component;
  sequence<octet> cdr;
};

@final struct Step {
  unsigned long long number;
  unsigned long long run;
  unsigned long long instance;
  long long next_timer_ns;
  string process;
  boolean stop;
  boolean failed;
  boolean aborted;
  string reason;
  sequence<unsigned long> topics;
  sequence<furrow_graph::msg::StepMessage> messages;
};

}; };
)";

}  // namespace

const msgs::MessageType& step_type() {
  static const msgs::MessageType type = {
      .dds_name = "furrow_graph::msg::dds_::Step_",
      .ros_name = "furrow_graph/msg/Step",
      .idl = kIdl,
      .create = []() -> std::shared_ptr<void> { return std::make_shared<Step>(); },
      .serialized_size =
          [](const void* message) {
            CdrWriter count;
            write(*static_cast<const Step*>(message), count);
            return kEncapsulation + count.size();
          },
      .serialize = [](const void* message, std::span<std::byte> buffer) -> Result<std::size_t> {
        const Step& step = *static_cast<const Step*>(message);
        CdrWriter count;
        write(step, count);
        const std::size_t size = kEncapsulation + count.size();
        if (buffer.size() < size) {
          return Error{ErrorCode::kOutOfRange, "the buffer is smaller than the step"};
        }
        std::ranges::fill(buffer.first(kEncapsulation), std::byte{0});
        buffer[1] = kLittleEndian;
        CdrWriter out(buffer.subspan(kEncapsulation));
        write(step, out);
        return size;
      },
      .deserialize = [](std::span<const std::byte> buffer, void* message) -> Status {
        if (buffer.size() < kEncapsulation || buffer[1] != kLittleEndian) {
          return Error{ErrorCode::kParse, "malformed CDR: not little-endian"};
        }
        CdrReader in(buffer.subspan(kEncapsulation));
        if (!read(in, *static_cast<Step*>(message))) {
          return Error{ErrorCode::kParse, "malformed CDR: cut short"};
        }
        return {};
      }};
  return type;
}

}  // namespace furrow::graph
