#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace furrow::log {

/// How severe a line is. The values are those of rcl_interfaces/msg/Log.
enum class Level : std::uint8_t {
  kDebug = 10,
  kInfo = 20,
  kWarn = 30,   ///< something was refused, dropped or degraded; the system goes on
  kError = 40,  ///< a function is lost
  kFatal = 50,  ///< the process ends
};
[[nodiscard]] std::string_view to_string(Level level);  ///< "debug", "info", "warn", ...
[[nodiscard]] std::optional<Level> level_from_string(std::string_view name);

/// The least level that is written, for all components and for single ones.
class Levels {
 public:
  /// Applies "LEVEL" or "COMPONENT=LEVEL". Throws ConfigError.
  void set(std::string_view setting);
  [[nodiscard]] Level of(std::string_view component) const;
  /// The components that have a level of their own, sorted.
  [[nodiscard]] std::vector<std::string> components() const;

 private:
  Level all_ = Level::kInfo;
  std::map<std::string, Level, std::less<>> of_;
};

}  // namespace furrow::log
