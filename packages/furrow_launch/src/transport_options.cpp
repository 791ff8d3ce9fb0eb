#include "furrow_launch/transport_options.hpp"

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "furrow_configuration/deployment_file.hpp"
#include "furrow_core/error.hpp"

namespace furrow::launch {

std::optional<std::int64_t> domain_from_environment() {
  constexpr std::int64_t kLargestDomain = 232;
  const char* variable = std::getenv("ROS_DOMAIN_ID");
  const std::string_view text = variable == nullptr ? "" : variable;
  if (text.empty()) return std::nullopt;
  std::int64_t domain = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), domain);
  if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size() || domain < 0 ||
      domain > kLargestDomain) {
    throw ConfigError("ROS_DOMAIN_ID: '" + std::string(text) +
                      "' is not a whole number from 0 to 232; correct or unset it");
  }
  return domain;
}

dds::DdsParameters transport_parameters(const TransportOptions& options,
                                        const std::string& process_name) {
  configuration::DeploymentSpec deployment;
  configuration::apply_transport_settings(deployment, options.settings);
  dds::DdsParameters parameters;
  parameters.domain_id =
      options.domain_id ? *options.domain_id : domain_from_environment().value_or(0);
  parameters.process_name = process_name;
  ParameterLoader::load(deployment.transport, parameters);
  return parameters;
}

}  // namespace furrow::launch
