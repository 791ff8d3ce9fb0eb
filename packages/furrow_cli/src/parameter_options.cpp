#include "parameter_options.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::cli {
namespace {

std::string option_name(const ParameterInfo& info) {
  std::string name = "--" + info.name;
  std::ranges::replace(name, '_', '-');
  return name;
}

std::string description_of(const ParameterInfo& info) {
  return info.unit.empty() ? info.description : info.description + " [" + info.unit + "]";
}

template <class Value>
void add_number(Command command, const ParameterInfo& info, Value& value) {
  Option option = command.option(option_name(info), value, description_of(info));
  if (std::isfinite(info.min) || std::isfinite(info.max)) option.range(info.min, info.max);
}

}  // namespace

bool ParameterOptions::wanted(const ParameterInfo& info) const {
  return std::ranges::find(leave_out_, info.name) == leave_out_.end();
}

void ParameterOptions::visit(const ParameterInfo& info, bool& value) {
  if (wanted(info)) command_.flag(option_name(info), value, description_of(info));
}

void ParameterOptions::visit(const ParameterInfo& info, std::int64_t& value) {
  if (wanted(info)) add_number(command_, info, value);
}

void ParameterOptions::visit(const ParameterInfo& info, double& value) {
  if (wanted(info)) add_number(command_, info, value);
}

void ParameterOptions::visit(const ParameterInfo& info, std::string& value) {
  if (!wanted(info)) return;
  Option option = command_.option(option_name(info), value, description_of(info));
  if (!info.choices.empty()) option.choices(info.choices);
}

void ParameterOptions::visit(const ParameterInfo& info, std::vector<double>& value) {
  if (wanted(info)) add_number(command_, info, value);
}

void ParameterOptions::visit(const ParameterInfo& info, std::vector<std::string>& value) {
  if (wanted(info)) command_.option(option_name(info), value, description_of(info));
}

}  // namespace furrow::cli
