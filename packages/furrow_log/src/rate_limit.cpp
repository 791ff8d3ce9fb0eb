#include "rate_limit.hpp"

#include <algorithm>
#include <utility>

namespace furrow::log {
namespace {

constexpr Duration kSecond = Duration::milliseconds(1000);

bool is_digit(char c) {
  return '0' <= c && c <= '9';
}

/// Texts that differ in numbers only are the same: "in 31 images" and "in 32 images".
std::string without_digits(std::string_view text) {
  std::string key;
  key.reserve(text.size());
  for (const char c : text) {
    if (!is_digit(c)) {
      key += c;
    } else if (key.empty() || key.back() != '#') {
      key += '#';
    }
  }
  return key;
}

}  // namespace

std::optional<std::uint64_t> RateLimit::admit(Time now, Level level, std::string_view message) {
  auto [it, first] = texts_.try_emplace({level, without_digits(message)});
  Text& text = it->second;
  // A clock that was set back does not silence a text.
  const bool recent = !first && text.written <= now && now - text.written < repeat_period_;
  if (!recent && (now < second_ || now - second_ >= kSecond)) {
    second_ = now;
    lines_ = 0;
  }
  if (recent || lines_ >= max_lines_per_s_) {
    if (first) {
      // It is not remembered: there may be any number of such texts.
      texts_.erase(it);
      ++excess_;
    } else {
      ++text.suppressed;
      text.newest = message;
    }
    return std::nullopt;
  }
  ++lines_;
  text.written = now;
  const std::uint64_t repeated = std::exchange(text.suppressed, 0);
  if (texts_.size() > kMaxTexts) make_room();
  return repeated;
}

void RateLimit::make_room() {
  const auto oldest =
      std::ranges::min_element(texts_, {}, [](const auto& entry) { return entry.second.written; });
  excess_ += oldest->second.suppressed;
  texts_.erase(oldest);
}

std::uint64_t RateLimit::take_excess(Time now) {
  if (now >= second_ && now - second_ < kSecond) return 0;
  return std::exchange(excess_, 0);
}

std::vector<RateLimit::Suppressed> RateLimit::take_suppressed() {
  std::vector<Suppressed> list;
  for (auto& [key, text] : texts_) {
    if (text.suppressed == 0) continue;
    list.push_back({key.first, std::exchange(text.newest, {}), std::exchange(text.suppressed, 0)});
  }
  if (excess_ > 0) list.push_back({Level::kWarn, "", std::exchange(excess_, 0)});
  return list;
}

}  // namespace furrow::log
