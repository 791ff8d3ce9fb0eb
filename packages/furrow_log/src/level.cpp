#include "furrow_log/level.hpp"

#include <array>

#include "furrow_core/error.hpp"

namespace furrow::log {
namespace {

constexpr std::array kLevels = {Level::kDebug, Level::kInfo, Level::kWarn, Level::kError,
                                Level::kFatal};

}  // namespace

std::string_view to_string(Level level) {
  switch (level) {
    case Level::kDebug:
      return "debug";
    case Level::kInfo:
      return "info";
    case Level::kWarn:
      return "warn";
    case Level::kError:
      return "error";
    case Level::kFatal:
      return "fatal";
  }
  return "unknown";
}

std::optional<Level> level_from_string(std::string_view name) {
  for (const Level level : kLevels) {
    if (to_string(level) == name) return level;
  }
  return std::nullopt;
}

void Levels::set(std::string_view setting) {
  const std::size_t equals = setting.rfind('=');
  const bool of_one = equals != std::string_view::npos;
  const auto level = level_from_string(of_one ? setting.substr(equals + 1) : setting);
  if (!level || equals == 0) {
    throw ConfigError("--log-level '" + std::string(setting) +
                      "': use LEVEL or COMPONENT=LEVEL, with LEVEL one of debug, info, warn, "
                      "error, fatal");
  }
  if (of_one) {
    of_[std::string(setting.substr(0, equals))] = *level;
  } else {
    all_ = *level;
  }
}

Level Levels::of(std::string_view component) const {
  const auto it = of_.find(component);
  return it == of_.end() ? all_ : it->second;
}

std::vector<std::string> Levels::components() const {
  std::vector<std::string> names;
  for (const auto& [name, level] : of_) names.push_back(name);
  return names;
}

}  // namespace furrow::log
