#include "ros1_translation.hpp"

#include <array>
#include <bit>
#include <cstring>

#include "units.hpp"

namespace furrow::recording {
namespace {

using Step = Ros1Translator::Step;
using Action = Step::Action;

static_assert(std::endian::native == std::endian::little,
              "ROS 1 and the CDR written here are little endian, and values are copied");

constexpr std::size_t kEncapsulationBytes = 4;

/// Runs the steps over one message. After the first fault nothing more is read or written.
class Translation {
 public:
  Translation(std::span<const std::byte> message, std::size_t max_bytes,
              std::vector<std::byte>& cdr)
      : in_(message), cdr_(cdr), max_bytes_(max_bytes), budget_(1'000'000 + 8 * message.size()) {
    cdr_.assign({std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}});
  }

  Status run(const std::vector<Step>& steps) {
    take_struct(steps, Action::kTranslate);
    if (ok_ && !in_.empty()) {
      fail(ErrorCode::kParse, "it is longer than its type");
    }
    return ok_ ? Status() : Status(error_);
  }

 private:
  void fail(ErrorCode code, const char* what) {
    if (ok_) {
      ok_ = false;
      error_ = {code, what};
    }
  }

  /// `outer` is done to all fields of the struct, unless it is translated.
  void take_struct(const std::vector<Step>& steps, Action outer) {
    for (const Step& step : steps) {
      if (!ok_) {
        return;
      }
      const bool not_in_ros1 = step.action == Action::kFill;
      if (outer != Action::kDrop || !not_in_ros1) {
        take(step, outer == Action::kTranslate ? step.action : outer);
      }
    }
    if (steps.empty() && outer != Action::kDrop) {
      put_zeros(1, 1);  // rosidl gives a struct without fields one byte
    }
  }

  void take(const Step& step, Action action) {
    // A definition may nest empty structs without an end, which takes no bytes but time.
    if (budget_-- == 0) {
      fail(ErrorCode::kOutOfRange, "it has too many fields");
      return;
    }
    std::size_t count = step.array_size > 0 ? step.array_size : 1;
    if (step.sequence) {
      count = action == Action::kFill ? 0 : take_number<std::uint32_t>();
      if (action != Action::kDrop) {
        put_number(static_cast<std::uint32_t>(count));
      }
    }
    if (count > 0 && ok_) {
      take_values(step, action, count);
    }
  }

  void take_values(const Step& step, Action action, std::size_t count) {
    switch (step.kind) {
      case FieldKind::kBool:
      case FieldKind::kTime:
      case FieldKind::kDuration:
      case FieldKind::kString:
      case FieldKind::kWstring:
      case FieldKind::kStruct:
        for (std::size_t i = 0; i < count && ok_; ++i) {
          take_value(step, action);
        }
        break;
      default:
        take_numbers(step, action, count);
    }
  }

  void take_value(const Step& step, Action action) {
    switch (step.kind) {
      case FieldKind::kBool:
        take_bool(action);
        break;
      case FieldKind::kTime:
      case FieldKind::kDuration:
        take_time(step.kind, action);
        break;
      case FieldKind::kStruct:
        if (step.steps) {
          if (budget_-- == 0) {
            fail(ErrorCode::kOutOfRange, "it has too many fields");
            return;
          }
          take_struct(*step.steps, action);
        }
        break;
      default:
        take_string(action);
    }
  }

  void take_bool(Action action) {
    const bool value = action != Action::kFill && take_number<std::uint8_t>() != 0;
    if (action != Action::kDrop) {
      put_number(static_cast<std::uint8_t>(value ? 1 : 0));
    }
  }

  void take_time(FieldKind kind, Action action) {
    std::uint32_t sec = action == Action::kFill ? 0 : take_number<std::uint32_t>();
    std::uint32_t nsec = action == Action::kFill ? 0 : take_number<std::uint32_t>();
    if (kind == FieldKind::kDuration) {
      // ROS 2 counts nanoseconds upwards only: -0.5 s is -1 s and 500000000 ns.
      const std::int64_t ns =
          static_cast<std::int32_t>(sec) * kNsPerS + static_cast<std::int32_t>(nsec);
      const std::int64_t rest = ((ns % kNsPerS) + kNsPerS) % kNsPerS;
      sec = static_cast<std::uint32_t>((ns - rest) / kNsPerS);
      nsec = static_cast<std::uint32_t>(rest);
    }
    if (action != Action::kDrop) {
      put_number(sec);
      put_number(nsec);
    }
  }

  void take_string(Action action) {
    const std::size_t length = action == Action::kFill ? 0 : take_number<std::uint32_t>();
    const auto text = take_bytes(length);
    if (action != Action::kDrop && ok_) {
      put_number(static_cast<std::uint32_t>(text.size() + 1));
      put(text);
      put_zeros(1, 1);
    }
  }

  void take_numbers(const Step& step, Action action, std::size_t count) {
    const std::size_t size = size_of(step.kind);
    if (action == Action::kFill) {
      put_zeros(count, size);
      return;
    }
    if (count > in_.size() / size) {
      fail(ErrorCode::kParse, "it is cut short");
      return;
    }
    const auto values = take_bytes(count * size);
    if (action == Action::kDrop) {
      return;
    }
    if (step.log_level) {
      put_number(log_level(std::to_integer<std::uint8_t>(values[0])));
      return;
    }
    align(size);
    put(values);
  }

  /// DEBUG 1, INFO 2, WARN 4, ERROR 8, FATAL 16 are 10, 20, 30, 40, 50 in ROS 2.
  static std::uint8_t log_level(std::uint8_t ros1) {
    const bool known = std::has_single_bit(ros1) && ros1 <= 16;
    return known ? static_cast<std::uint8_t>(10 * std::bit_width(ros1)) : ros1;
  }

  std::span<const std::byte> take_bytes(std::size_t size) {
    if (!ok_ || size > in_.size()) {
      fail(ErrorCode::kParse, "it is cut short");
      return {};
    }
    const auto bytes = in_.first(size);
    in_ = in_.subspan(size);
    return bytes;
  }

  template <class T>
  T take_number() {
    const auto bytes = take_bytes(sizeof(T));
    T value{};
    if (ok_) {
      std::memcpy(&value, bytes.data(), sizeof(T));
    }
    return value;
  }

  bool has_room(std::size_t bytes) {
    if (bytes > max_bytes_ || cdr_.size() > max_bytes_ - bytes) {
      fail(ErrorCode::kOutOfRange, "its ROS 2 form is larger than the limit");
    }
    return ok_;
  }

  void align(std::size_t size) {
    const std::size_t at = cdr_.size() - kEncapsulationBytes;
    cdr_.resize(cdr_.size() + (size - at % size) % size);
  }

  void put(std::span<const std::byte> bytes) {
    if (has_room(bytes.size())) {
      cdr_.insert(cdr_.end(), bytes.begin(), bytes.end());
    }
  }

  template <class T>
  void put_number(T value) {
    align(sizeof(T));
    put(std::as_bytes(std::span(&value, 1)));
  }

  void put_zeros(std::size_t count, std::size_t size) {
    align(size);
    if (count > max_bytes_ / size) {
      fail(ErrorCode::kOutOfRange, "its ROS 2 form is larger than the limit");
    } else if (has_room(count * size)) {
      cdr_.resize(cdr_.size() + count * size);
    }
  }

  std::span<const std::byte> in_;
  std::vector<std::byte>& cdr_;
  std::size_t max_bytes_;
  std::size_t budget_;  ///< steps that may still be taken
  bool ok_ = true;
  Error error_;
};

}  // namespace

Status Ros1Translator::translate(std::span<const std::byte> message, std::size_t max_bytes,
                                 std::vector<std::byte>& cdr) const {
  return Translation(message, max_bytes, cdr).run(*steps_);
}

}  // namespace furrow::recording
