#include "furrow_components/landing_offsets.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "furrow_core/error.hpp"
#include "furrow_core/file.hpp"

namespace furrow::components {
namespace {

constexpr std::string_view kHeader = "axis,speed_mps,along_mm,across_mm";
constexpr std::array<std::string_view, 4> kColumns = {"axis", "speed_mps", "along_mm", "across_mm"};

std::string_view take_until(std::string_view& text, char end) {
  const std::size_t length = std::min(text.find(end), text.size());
  const std::string_view part = text.substr(0, length);
  text.remove_prefix(std::min(length + 1, text.size()));
  return part;
}

std::string_view take_line(std::string_view& text) {
  std::string_view line = take_until(text, '\n');
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

double number(std::string_view text, const SourceLocation& where, std::string_view column) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw ConfigError(where, column, "'" + std::string(text) + "' is not a finite number");
  }
  return value;
}

}  // namespace

LandingOffsets load_landing_offsets(const std::filesystem::path& path) {
  const auto content = read_file(path);
  if (!content.ok()) throw ConfigError({path.string(), 0}, "measured", content.error().message);
  std::string_view rest = *content;
  SourceLocation where{path.string(), 1};
  if (take_line(rest) != kHeader) {
    throw ConfigError(where, "header", "must be " + std::string(kHeader));
  }
  LandingOffsets offsets;
  while (!rest.empty()) {
    ++where.line;
    std::string_view line = take_line(rest);
    if (line.empty()) continue;
    std::array<std::string_view, kColumns.size()> fields;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (line.empty()) throw ConfigError(where, kColumns[i], "is missing");
      fields[i] = take_until(line, ',');
    }
    if (!line.empty()) throw ConfigError(where, "line", "has more than four columns");
    if (fields[0].empty()) throw ConfigError(where, kColumns[0], "is missing");
    constexpr double kMetersPerMm = 1e-3;
    offsets[std::string(fields[0])].push_back(
        {number(fields[1], where, kColumns[1]),
         kMetersPerMm * Eigen::Vector2d(number(fields[2], where, kColumns[2]),
                                        number(fields[3], where, kColumns[3]))});
  }
  return offsets;
}

}  // namespace furrow::components
