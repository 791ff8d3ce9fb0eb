#include "report_parts.hpp"

#include <algorithm>

#include "furrow_ledger/markup.hpp"
#include "furrow_ledger/palette.hpp"

namespace furrow::experiments {
namespace {

using ledger::fixed;
using ledger::number;

void add_unique(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

template <class Parameters>
void add_facts(std::vector<std::pair<std::string, std::string>>& facts, Parameters parameters) {
  ParameterLister lister;
  parameters.visit(lister);
  for (const DeclaredParameter& declared : lister.declared()) {
    const std::string unit = declared.info.unit.empty() ? "" : " " + declared.info.unit;
    facts.emplace_back(declared.info.name, furrow::to_text(declared.default_value) + unit);
  }
}

}  // namespace

std::string planner_name(const EvaluationRow& row) {
  return to_string(PlannerChoice{row.planner, row.assignment});
}

std::string planner_color(std::string_view planner) {
  const auto main = main_planner_choices();
  for (std::size_t i = 0; i < main.size(); ++i) {
    if (to_string(main[i]) == planner) return std::string(ledger::series_color(i));
  }
  return "";
}

std::string conditions(const planning::PlannerParameters& planner, const SetupParameters& setup,
                       const SamplingParameters& sampling, const std::vector<FieldCase>& fields) {
  const bool imported = std::any_of(fields.begin(), fields.end(),
                                    [](const FieldCase& field) { return field.imported; });
  const RowParameters& row = sampling.row;
  std::string text = imported ? "Imported field"
                              : number(static_cast<double>(sampling.seeds)) +
                                    " generated fields of " + number(row.length_m) +
                                    " m \xC3\x97 " + number(row.width_m) + " m for each density, " +
                                    (row.crop ? "with crop" : "weeds only") + ", " + row.pattern;
  text += "; robot at " + number(planner.speed_mps) + " m/s, " +
          number(static_cast<double>(setup.axes)) + " axes at " + number(setup.axis_velocity_mps) +
          " m/s, " + planner.kinematics + " kinematics";
  return text;
}

std::vector<std::pair<std::string, std::string>> provenance_facts(
    const planning::PlannerParameters& planner, const SetupParameters& setup,
    const SamplingParameters& sampling, std::string_view version) {
  std::vector<std::pair<std::string, std::string>> facts;
  add_facts(facts, planner);
  std::erase_if(facts, [](const auto& fact) {
    return fact.first == "planner" || fact.first == "assignment" || fact.first == "view";
  });
  add_facts(facts, setup);
  add_facts(facts, sampling);
  facts.emplace_back("version", std::string(version));
  return facts;
}

std::string cell(const std::optional<double>& value, int decimals) {
  return value ? fixed(*value, decimals) : "-";
}

std::string field_title(const EvaluationRow& row) {
  return row.field + ", " + number(row.weeds_per_m2, 1) + " weeds/m\xC2\xB2";
}

std::vector<std::string> field_names(const std::vector<EvaluationRow>& rows) {
  std::vector<std::string> names;
  for (const EvaluationRow& row : rows) add_unique(names, row.field);
  return names;
}

std::vector<std::string> main_planners(const std::vector<EvaluationRow>& rows) {
  std::vector<std::string> names;
  for (const EvaluationRow& row : rows) {
    if (!planner_color(planner_name(row)).empty()) add_unique(names, planner_name(row));
  }
  return names;
}

}  // namespace furrow::experiments
