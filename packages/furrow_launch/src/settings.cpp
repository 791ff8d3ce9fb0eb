#include "furrow_launch/settings.hpp"

#include "furrow_configuration/parameter_file.hpp"

namespace furrow::launch {

std::vector<GivenParameter> given_parameters(const std::vector<std::string>& settings,
                                             const std::string& option) {
  std::vector<GivenParameter> given;
  for (const std::string& setting : settings) {
    const auto equals = setting.find('=');
    const SourceLocation where{option + " " + setting, 0};
    if (equals == std::string::npos) throw ConfigError(where, "", "is not KEY=VALUE");
    given.push_back({setting.substr(0, equals),
                     configuration::parse_parameter_value(setting.substr(equals + 1)), where});
  }
  return given;
}

}  // namespace furrow::launch
