#include "wave.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

namespace furrow::graph {
namespace {

static_assert(std::endian::native == std::endian::little, "the CDR form is little-endian");

constexpr std::size_t kEncapsulation = 4;
constexpr std::byte kLittleEndian{1};

/// Writes XCDR1; without a buffer it counts.
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

/// Reads XCDR1; reading beyond the end gives zeros and fails.
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
  /// A sequence's length; its elements take at least `element` bytes each.
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

void write(const Wave& wave, CdrWriter& out) {
  out.number(wave.number);
  out.number(wave.run);
  out.number(wave.instance);
  out.number(wave.next_timer_ns);
  out.text(wave.process);
  out.flag(wave.stop);
  out.flag(wave.failed);
  out.flag(wave.aborted);
  out.text(wave.reason);
  out.number(static_cast<std::uint32_t>(wave.topics.size()));
  for (const std::uint32_t topic : wave.topics) out.number(topic);
  out.number(static_cast<std::uint32_t>(wave.messages.size()));
  for (const WaveMessage& message : wave.messages) {
    out.number(message.topic);
    out.number(message.component);
    out.bytes(message.cdr);
  }
}

bool read(CdrReader& in, Wave& wave) {
  wave.number = in.number<std::uint64_t>();
  wave.run = in.number<std::uint64_t>();
  wave.instance = in.number<std::uint64_t>();
  wave.next_timer_ns = in.number<std::int64_t>();
  wave.process = in.text();
  wave.stop = in.flag();
  wave.failed = in.flag();
  wave.aborted = in.flag();
  wave.reason = in.text();
  wave.topics.resize(in.length(sizeof(std::uint32_t)));
  for (std::uint32_t& topic : wave.topics) topic = in.number<std::uint32_t>();
  constexpr std::size_t kSmallestMessage = 3 * sizeof(std::uint32_t);
  wave.messages.resize(in.length(kSmallestMessage));
  for (WaveMessage& message : wave.messages) {
    message.topic = in.number<std::uint32_t>();
    message.component = in.number<std::uint32_t>();
    message.cdr = in.bytes();
  }
  return in.ok();
}

constexpr std::string_view kIdl = R"(module furrow_graph { module msg {

@final struct WaveMessage {
  unsigned long topic;
  unsigned long component;
  sequence<octet> cdr;
};

@final struct Wave {
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
  sequence<furrow_graph::msg::WaveMessage> messages;
};

}; };
)";

}  // namespace

const msgs::MessageType& wave_type() {
  static const msgs::MessageType type = {
      .dds_name = "furrow_graph::msg::dds_::Wave_",
      .ros_name = "furrow_graph/msg/Wave",
      .idl = kIdl,
      .create = []() -> std::shared_ptr<void> { return std::make_shared<Wave>(); },
      .serialized_size =
          [](const void* message) {
            CdrWriter count;
            write(*static_cast<const Wave*>(message), count);
            return kEncapsulation + count.size();
          },
      .serialize = [](const void* message, std::span<std::byte> buffer) -> Result<std::size_t> {
        const Wave& wave = *static_cast<const Wave*>(message);
        CdrWriter count;
        write(wave, count);
        const std::size_t size = kEncapsulation + count.size();
        if (buffer.size() < size) {
          return Error{ErrorCode::kOutOfRange, "the buffer is smaller than the wave"};
        }
        std::ranges::fill(buffer.first(kEncapsulation), std::byte{0});
        buffer[1] = kLittleEndian;
        CdrWriter out(buffer.subspan(kEncapsulation));
        write(wave, out);
        return size;
      },
      .deserialize = [](std::span<const std::byte> buffer, void* message) -> Status {
        if (buffer.size() < kEncapsulation || buffer[1] != kLittleEndian) {
          return Error{ErrorCode::kParse, "malformed CDR: not little-endian"};
        }
        CdrReader in(buffer.subspan(kEncapsulation));
        if (!read(in, *static_cast<Wave*>(message))) {
          return Error{ErrorCode::kParse, "malformed CDR: cut short"};
        }
        return {};
      }};
  return type;
}

}  // namespace furrow::graph
