#include "parameter_options.hpp"

#include <algorithm>

namespace furrow::cli {
namespace {

std::string option_name(const ParameterInfo& info) {
  std::string name = "--" + info.name;
  std::ranges::replace(name, '_', '-');
  return name;
}

std::string description(const ParameterInfo& info) {
  return info.unit.empty() ? info.description : info.description + " [" + info.unit + "]";
}

CLI::Validator range(const ParameterInfo& info) {
  return CLI::Range(info.min, info.max);
}

}  // namespace

bool ParameterOptions::wanted(const ParameterInfo& info) const {
  return std::ranges::find(leave_out_, info.name) == leave_out_.end();
}

void ParameterOptions::visit(const ParameterInfo& info, bool& value) {
  if (wanted(info)) command_.add_flag(option_name(info), value, description(info));
}

void ParameterOptions::visit(const ParameterInfo& info, std::int64_t& value) {
  if (!wanted(info)) return;
  command_.add_option(option_name(info), value, description(info))
      ->check(range(info))
      ->capture_default_str();
}

void ParameterOptions::visit(const ParameterInfo& info, double& value) {
  if (!wanted(info)) return;
  command_.add_option(option_name(info), value, description(info))
      ->check(range(info))
      ->capture_default_str();
}

void ParameterOptions::visit(const ParameterInfo& info, std::string& value) {
  if (!wanted(info)) return;
  CLI::Option* option =
      command_.add_option(option_name(info), value, description(info))->capture_default_str();
  if (!info.choices.empty()) option->check(CLI::IsMember(info.choices));
}

void ParameterOptions::visit(const ParameterInfo& info, std::vector<double>& value) {
  if (wanted(info)) {
    command_.add_option(option_name(info), value, description(info))->check(range(info));
  }
}

void ParameterOptions::visit(const ParameterInfo& info, std::vector<std::string>& value) {
  if (wanted(info)) command_.add_option(option_name(info), value, description(info))->take_all();
}

}  // namespace furrow::cli
