#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>

#include "furrow_msgs/cdr.hpp"
#include "furrow_msgs/idl_schema.hpp"

namespace furrow::msgs {
namespace {

/// Reads a CDR form along its schema; stops at the first fault.
class Printer {
 public:
  Printer(const IdlSchema& schema, std::span<const std::byte> body, bool little_endian,
          const PrintLimits& limits)
      : schema_(schema),
        body_(body),
        swap_(little_endian != (std::endian::native == std::endian::little)),
        limits_(limits) {}

  Result<std::string> print(const std::string& struct_name) {
    members(*schema_.find(struct_name), 0);
    if (cut_short_) return Error{ErrorCode::kParse, "the message is truncated or of another type"};
    return text_;
  }

 private:
  void members(const std::vector<IdlMember>& list, int depth) {
    for (const IdlMember& member : list) {
      if (cut_short_) return;
      indent(depth);
      text_ += member.name + ":";
      if (member.sequence || member.array_size > 0) {
        const std::size_t count = member.sequence ? number<std::uint32_t>() : member.array_size;
        elements(member.type, count, depth);
      } else {
        value(member.type, depth, " ");
      }
    }
  }

  void elements(const std::string& type, std::size_t count, int depth) {
    const auto* nested = struct_of(type);
    const std::size_t shown = std::min(count, limits_.max_elements);
    if (nested == nullptr) text_ += " [";
    if (nested != nullptr) text_ += count == 0 ? " []\n" : "\n";
    for (std::size_t i = 0; i < count && !cut_short_; ++i) {
      if (i >= shown) {
        skip(type);
      } else if (nested != nullptr) {
        indent(depth);
        text_ += "-\n";
        members(*nested, depth + 1);
      } else {
        if (i > 0) text_ += ", ";
        scalar(type);
      }
    }
    const std::string rest = count > shown ? "... " + std::to_string(count) + " in all" : "";
    if (nested == nullptr) {
      text_ += (rest.empty() || shown == 0 ? rest : ", " + rest) + "]\n";
    } else if (!rest.empty()) {
      indent(depth);
      text_ += rest + "\n";
    }
  }

  void value(const std::string& type, int depth, const char* space) {
    if (const auto* nested = struct_of(type)) {
      text_ += "\n";
      members(*nested, depth + 1);
    } else {
      text_ += space;
      scalar(type);
      text_ += "\n";
    }
  }

  /// The members of a type that is printed as a block; null for scalars and enumerations.
  [[nodiscard]] const std::vector<IdlMember>* struct_of(const std::string& type) const {
    return schema_.is_enumeration(type) ? nullptr : schema_.find(type);
  }

  void enumeration(const std::string& type) {
    const std::size_t start = text_.size();
    scalar(schema_.find(type)->front().type);
    const auto constants = schema_.constants_of(type);
    const auto it = std::ranges::find(constants, text_.substr(start), &IdlConstant::value);
    text_ += " (" + (it == constants.end() ? std::string("unknown") : it->name) + ")";
  }

  void scalar(const std::string& type) {
    if (type == "boolean") {
      text_ += number<std::uint8_t>() != 0 ? "true" : "false";
    } else if (type == "octet" || type == "char" || type == "uint8") {
      text_ += std::to_string(number<std::uint8_t>());
    } else if (type == "int8") {
      text_ += std::to_string(number<std::int8_t>());
    } else if (type == "short" || type == "int16") {
      text_ += std::to_string(number<std::int16_t>());
    } else if (type == "unsigned short" || type == "uint16") {
      text_ += std::to_string(number<std::uint16_t>());
    } else if (type == "long" || type == "int32") {
      text_ += std::to_string(number<std::int32_t>());
    } else if (type == "unsigned long" || type == "uint32") {
      text_ += std::to_string(number<std::uint32_t>());
    } else if (type == "long long" || type == "int64") {
      text_ += std::to_string(number<std::int64_t>());
    } else if (type == "unsigned long long" || type == "uint64") {
      text_ += std::to_string(number<std::uint64_t>());
    } else if (schema_.is_enumeration(type)) {
      enumeration(type);
    } else if (type == "float") {
      floating(number<float>());
    } else if (type == "double") {
      floating(number<double>());
    } else {
      string();
    }
  }

  void floating(double value) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.9g", value);
    text_ += buffer;
  }

  void string() {
    const std::string_view content = raw_string();
    text_ += '"';
    text_ += content.substr(0, limits_.max_text);
    text_ += content.size() > limits_.max_text ? "...\"" : "\"";
  }

  std::string_view raw_string() {
    const std::size_t length = number<std::uint32_t>();
    if (length == 0 || length > body_.size() - at_) {
      cut_short_ = true;
      return {};
    }
    const auto* begin = reinterpret_cast<const char*>(body_.data() + at_);
    at_ += length;
    return {begin, length - 1};
  }

  void skip(const std::string& type) {
    if (const auto* nested = struct_of(type)) {
      const std::size_t before = text_.size();
      members(*nested, 0);
      text_.resize(before);
    } else if (type == "string") {
      (void)raw_string();
    } else {
      const std::size_t before = text_.size();
      scalar(type);
      text_.resize(before);
    }
  }

  template <class T>
  T number() {
    at_ = (at_ + sizeof(T) - 1) / sizeof(T) * sizeof(T);
    if (cut_short_ || at_ > body_.size() || sizeof(T) > body_.size() - at_) {
      cut_short_ = true;
      return T{};
    }
    std::array<std::byte, sizeof(T)> bytes;
    std::copy_n(body_.begin() + static_cast<std::ptrdiff_t>(at_), sizeof(T), bytes.begin());
    if (swap_) std::ranges::reverse(bytes);
    at_ += sizeof(T);
    return std::bit_cast<T>(bytes);
  }

  void indent(int depth) { text_.append(static_cast<std::size_t>(2 * depth), ' '); }

  const IdlSchema& schema_;
  std::span<const std::byte> body_;
  bool swap_;
  PrintLimits limits_;
  std::size_t at_ = 0;
  bool cut_short_ = false;
  std::string text_;
};

}  // namespace

Result<std::string> print_cdr(const IdlSchema& schema, const std::string& struct_name,
                              std::span<const std::byte> cdr, const PrintLimits& limits) {
  if (schema.find(struct_name) == nullptr) {
    return Error{ErrorCode::kNotFound, "the schema has no struct '" + struct_name + "'"};
  }
  if (cdr.size() < kEncapsulationBytes) return Error{ErrorCode::kParse, "no encapsulation header"};
  const bool little_endian = (std::to_integer<int>(cdr[1]) & 1) != 0;
  return Printer(schema, cdr.subspan(kEncapsulationBytes), little_endian, limits)
      .print(struct_name);
}

}  // namespace furrow::msgs
