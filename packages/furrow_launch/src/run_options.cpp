#include "furrow_launch/run_options.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "furrow_configuration/deployment_file.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/text.hpp"
#include "furrow_launch/installation.hpp"
#include "furrow_launch/transport_options.hpp"

namespace furrow::launch {
namespace {

bool names_domain(const std::vector<GivenParameter>& parameters) {
  return std::ranges::find(parameters, "domain_id", &GivenParameter::name) != parameters.end();
}

/// The domain of the command line is a setting like the others; that of the environment counts
/// only where the deployment names none.
void apply_domain(configuration::DeploymentSpec& deployment, const RunOptions& options) {
  const bool named = names_domain(deployment.transport);
  const auto domain = options.domain_id || named ? options.domain_id : domain_from_environment();
  if (domain)
    configuration::apply_transport_settings(deployment, {"domain_id=" + std::to_string(*domain)});
}

void add_all(std::vector<std::string>& arguments, const std::string& option,
             const std::vector<std::string>& values) {
  for (const std::string& value : values) arguments.push_back(option + "=" + value);
}

void add_given(std::vector<std::string>& arguments, const std::string& option,
               const std::string& value) {
  if (!value.empty()) arguments.push_back(option + "=" + value);
}

}  // namespace

std::vector<std::string> all_settings(const RunOptions& options) {
  std::vector<std::string> settings;
  if (!options.field.empty()) {
    const auto path = std::filesystem::absolute(find_shipped(options.field, "fields"));
    settings.push_back("common.field_file=" + path.string());
  }
  if (options.length_m) settings.push_back("common.length_m=" + fixed(*options.length_m, 6));
  constexpr std::string_view kPhotos = "photos:";
  if (options.ground.starts_with(kPhotos)) {
    const auto folder = std::filesystem::absolute(options.ground.substr(kPhotos.size()));
    settings.push_back("common.photos_folder=" + folder.string());
  } else if (!options.ground.empty() && options.ground != "rendered") {
    throw ConfigError("--ground: '" + options.ground + "' is neither rendered nor photos:FOLDER");
  }
  settings.insert(settings.end(), options.settings.begin(), options.settings.end());
  return settings;
}

configuration::DeploymentSpec prepare_deployment(const RunOptions& options) {
  auto deployment = configuration::load_deployment(find_shipped(options.deploy, "deploy"));
  configuration::apply_addresses(deployment, options.addresses);
  apply_domain(deployment, options);
  configuration::apply_transport_settings(deployment, options.dds_settings);
  return deployment;
}

std::vector<std::string> run_arguments(const RunOptions& options) {
  std::vector<std::string> arguments = {"run",
                                        "--graph=" + options.graph,
                                        "--deploy=" + options.deploy,
                                        "--seed=" + std::to_string(options.seed),
                                        "--clock=" + options.clock,
                                        "--threads=" + std::to_string(options.threads),
                                        "--out=" + options.out};
  if (options.domain_id) arguments.push_back("--domain=" + std::to_string(*options.domain_id));
  if (options.length_m) arguments.push_back("--length=" + fixed(*options.length_m, 6));
  add_given(arguments, "--field", options.field);
  add_given(arguments, "--ground", options.ground);
  add_given(arguments, "--record", options.record);
  add_all(arguments, "--recording", options.recordings);
  add_all(arguments, "--log-level", options.log_levels);
  add_all(arguments, "--set", options.settings);
  add_all(arguments, "--dds", options.dds_settings);
  add_all(arguments, "--address", options.addresses);
  return arguments;
}

std::filesystem::path log_file(const std::filesystem::path& folder, const std::string& process) {
  return folder / (process.empty() ? "run.log" : "run_" + process + ".log");
}

}  // namespace furrow::launch
