#include "furrow_core/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "furrow_core/text.hpp"

namespace furrow {
namespace {

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

std::string number(double value) {
  std::ostringstream stream;
  stream.precision(12);
  stream << value;
  return stream.str();
}

template <class T>
std::string list(const std::vector<T>& values) {
  std::string text = "[";
  for (const T& value : values) {
    if (text.size() > 1) text += ", ";
    if constexpr (std::is_same_v<T, double>) {
      text += number(value);
    } else {
      text += value;
    }
  }
  return text + "]";
}

bool assignable(const ParameterValue& declared, const ParameterValue& given) {
  if (declared.index() == given.index()) return true;
  if (std::holds_alternative<double>(declared)) return std::holds_alternative<std::int64_t>(given);
  // An empty list has no element to determine its type.
  const auto* no_numbers = std::get_if<std::vector<double>>(&given);
  return std::holds_alternative<std::vector<std::string>>(declared) && no_numbers != nullptr &&
         no_numbers->empty();
}

void check_number(const ParameterInfo& info, double value, const SourceLocation& where) {
  if (std::isnan(value)) throw ConfigError(where, info.name, "is not a number");
  if (value < info.min || value > info.max) {
    throw ConfigError(where, info.name,
                      number(value) + " is out of range [" + number(info.min) + ", " +
                          number(info.max) + "]" + (info.unit.empty() ? "" : " " + info.unit));
  }
}

void check_choice(const ParameterInfo& info, const std::string& value,
                  const SourceLocation& where) {
  if (info.choices.empty()) return;
  if (std::find(info.choices.begin(), info.choices.end(), value) == info.choices.end()) {
    throw ConfigError(where, info.name, "'" + value + "' is not one of " + list(info.choices));
  }
}

void check_value(const ParameterInfo& info, const GivenParameter& given) {
  std::visit(Overloaded{
                 [](bool) {},
                 [&](std::int64_t v) { check_number(info, static_cast<double>(v), given.where); },
                 [&](double v) { check_number(info, v, given.where); },
                 [&](const std::string& v) { check_choice(info, v, given.where); },
                 [&](const std::vector<double>& values) {
                   for (const double v : values) check_number(info, v, given.where);
                 },
                 [&](const std::vector<std::string>& values) {
                   for (const auto& v : values) check_choice(info, v, given.where);
                 },
             },
             given.value);
}

std::string nearest_name(const std::vector<DeclaredParameter>& declared, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& candidate : declared) names.push_back(candidate.info.name);
  return did_you_mean(name, names);
}

const GivenParameter* find(const std::vector<GivenParameter>& given, const std::string& name) {
  const auto it = std::find_if(given.begin(), given.end(),
                               [&](const GivenParameter& g) { return g.name == name; });
  return it == given.end() ? nullptr : &*it;
}

template <class T>
void assign(const std::vector<GivenParameter>& given, const ParameterInfo& info, T& value) {
  if (const GivenParameter* found = find(given, info.name)) value = std::get<T>(found->value);
}

}  // namespace

std::string type_name(const ParameterValue& value) {
  static const char* const names[] = {"bool",   "integer",         "number",
                                      "string", "list of numbers", "list of strings"};
  return names[value.index()];
}

std::string to_text(const ParameterValue& value) {
  return std::visit(Overloaded{
                        [](bool v) -> std::string { return v ? "true" : "false"; },
                        [](std::int64_t v) { return std::to_string(v); },
                        [](double v) { return number(v); },
                        [](const std::string& v) { return v; },
                        [](const auto& v) { return list(v); },
                    },
                    value);
}

void ParameterLister::visit(const ParameterInfo& info, bool& value) {
  declared_.push_back({info, value});
}
void ParameterLister::visit(const ParameterInfo& info, std::int64_t& value) {
  declared_.push_back({info, value});
}
void ParameterLister::visit(const ParameterInfo& info, double& value) {
  declared_.push_back({info, value});
}
void ParameterLister::visit(const ParameterInfo& info, std::string& value) {
  declared_.push_back({info, value});
}
void ParameterLister::visit(const ParameterInfo& info, std::vector<double>& value) {
  declared_.push_back({info, value});
}
void ParameterLister::visit(const ParameterInfo& info, std::vector<std::string>& value) {
  declared_.push_back({info, value});
}

void check_parameters(const std::vector<DeclaredParameter>& declared,
                      const std::vector<GivenParameter>& given) {
  for (const GivenParameter& parameter : given) {
    const auto it = std::find_if(declared.begin(), declared.end(), [&](const auto& candidate) {
      return candidate.info.name == parameter.name;
    });
    if (it == declared.end()) {
      throw ConfigError(parameter.where, parameter.name,
                        "unknown parameter" + nearest_name(declared, parameter.name));
    }
    if (find(given, parameter.name) != &parameter) {
      throw ConfigError(parameter.where, parameter.name, "given twice");
    }
    if (!assignable(it->default_value, parameter.value)) {
      throw ConfigError(parameter.where, parameter.name,
                        "is of type " + type_name(parameter.value) + "; type " +
                            type_name(it->default_value) + " is needed");
    }
    check_value(it->info, parameter);
  }
}

void ParameterLoader::Assigner::visit(const ParameterInfo& info, bool& value) {
  assign(given_, info, value);
}
void ParameterLoader::Assigner::visit(const ParameterInfo& info, std::int64_t& value) {
  assign(given_, info, value);
}
void ParameterLoader::Assigner::visit(const ParameterInfo& info, double& value) {
  const GivenParameter* found = find(given_, info.name);
  if (found == nullptr) return;
  const auto* integer = std::get_if<std::int64_t>(&found->value);
  value = integer != nullptr ? static_cast<double>(*integer) : std::get<double>(found->value);
}
void ParameterLoader::Assigner::visit(const ParameterInfo& info, std::string& value) {
  assign(given_, info, value);
}
void ParameterLoader::Assigner::visit(const ParameterInfo& info, std::vector<double>& value) {
  assign(given_, info, value);
}
void ParameterLoader::Assigner::visit(const ParameterInfo& info, std::vector<std::string>& value) {
  const GivenParameter* found = find(given_, info.name);
  if (found == nullptr) return;
  const auto* strings = std::get_if<std::vector<std::string>>(&found->value);
  value = strings != nullptr ? *strings : std::vector<std::string>{};
}

ParameterInfo PrefixedVisitor::prefixed(ParameterInfo info) const {
  info.name = prefix_ + info.name;
  return info;
}

void PrefixedVisitor::visit(const ParameterInfo& info, bool& value) {
  inner_.visit(prefixed(info), value);
}
void PrefixedVisitor::visit(const ParameterInfo& info, std::int64_t& value) {
  inner_.visit(prefixed(info), value);
}
void PrefixedVisitor::visit(const ParameterInfo& info, double& value) {
  inner_.visit(prefixed(info), value);
}
void PrefixedVisitor::visit(const ParameterInfo& info, std::string& value) {
  inner_.visit(prefixed(info), value);
}
void PrefixedVisitor::visit(const ParameterInfo& info, std::vector<double>& value) {
  inner_.visit(prefixed(info), value);
}
void PrefixedVisitor::visit(const ParameterInfo& info, std::vector<std::string>& value) {
  inner_.visit(prefixed(info), value);
}

}  // namespace furrow
