#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::field {

/// One "key: value" line as a parameter of the type that is declared under this name.
inline GivenParameter given_from_line(const std::string& line,
                                      const std::vector<DeclaredParameter>& declared) {
  const std::size_t colon = line.find(": ");
  GivenParameter given{line.substr(0, colon), line.substr(colon + 2), {}};
  const std::string text = std::get<std::string>(given.value);
  for (const DeclaredParameter& d : declared) {
    if (d.info.name != given.name) continue;
    if (std::holds_alternative<bool>(d.default_value)) given.value = text == "true";
    if (std::holds_alternative<double>(d.default_value)) given.value = std::stod(text);
    if (std::holds_alternative<std::int64_t>(d.default_value)) {
      given.value = static_cast<std::int64_t>(std::stoll(text));
    }
  }
  return given;
}

/// The lines of a file that are neither empty nor comments.
inline std::vector<std::string> content_lines(const std::string& path) {
  std::ifstream stream(path);
  EXPECT_TRUE(stream.good()) << path;
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.front() != '#') lines.push_back(line);
  }
  return lines;
}

}  // namespace furrow::field
