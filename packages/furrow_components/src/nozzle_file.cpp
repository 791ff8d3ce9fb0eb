#include "furrow_components/nozzle_file.hpp"

#include <algorithm>
#include <set>

#include "furrow_configuration/parameter_file.hpp"

namespace furrow::components {

void CalibratedNozzle::visit(ParameterVisitor& v) {
  v.visit({.name = "axis", .description = "joint of the nozzle in the URDF"}, axis);
  calibration.visit(v);
}

std::vector<CalibratedNozzle> load_nozzle_file(const std::filesystem::path& path) {
  auto nozzles = configuration::load_parameter_list<CalibratedNozzle>(path, "nozzles");
  std::set<std::string> seen;
  for (const CalibratedNozzle& nozzle : nozzles) {
    if (nozzle.axis.empty()) {
      throw ConfigError({path.string(), 0}, "nozzles", "an entry has no axis");
    }
    if (!seen.insert(nozzle.axis).second) {
      throw ConfigError({path.string(), 0}, "nozzles",
                        "axis '" + nozzle.axis + "' has two entries");
    }
  }
  return nozzles;
}

actuation::NozzleCalibration load_nozzle(const std::filesystem::path& path,
                                         const std::string& axis) {
  const auto nozzles = load_nozzle_file(path);
  const auto it = std::ranges::find(nozzles, axis, &CalibratedNozzle::axis);
  if (it == nozzles.end()) {
    throw ConfigError({path.string(), 0}, "nozzles", "axis '" + axis + "' has no entry");
  }
  return it->calibration;
}

std::string nozzle_file_text(const std::vector<CalibratedNozzle>& nozzles,
                             const std::string& comment) {
  std::string text = "# " + comment + "\nnozzles:\n";
  for (CalibratedNozzle nozzle : nozzles) {
    ParameterLister lister;
    nozzle.visit(lister);
    const char* start = "  - ";
    for (const DeclaredParameter& entry : lister.declared()) {
      text += start + entry.info.name + ": " + to_text(entry.default_value) + "\n";
      start = "    ";
    }
  }
  return text;
}

}  // namespace furrow::components
