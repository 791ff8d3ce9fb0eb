#include "furrow_simulation/valve_faults.hpp"

#include <array>
#include <optional>
#include <utility>

#include "furrow_core/error.hpp"

namespace furrow::simulation {
namespace {

constexpr std::array<std::pair<std::string_view, ValveFault>, 5> kFaultNames = {
    {{"stuck_shut", ValveFault::kStuckShut},
     {"stuck_open", ValveFault::kStuckOpen},
     {"blocked", ValveFault::kBlocked},
     {"slow", ValveFault::kSlow},
     {"leaking", ValveFault::kLeaking}}};

std::optional<ValveFault> fault_named(std::string_view name) {
  for (const auto& [known, fault] : kFaultNames) {
    if (known == name) return fault;
  }
  return std::nullopt;
}

}  // namespace

void ValveFaultParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "axis",
           .description = "Axes whose valves have a fault; the lists below have an entry for each"},
          axis);
  v.visit({.name = "kind",
           .description = "Kind of each fault: stuck_shut, stuck_open (once opened, it does not "
                          "shut), blocked, slow, leaking"},
          kind);
  v.visit({.name = "from_s",
           .unit = "s",
           .description = "Beginning of each fault since the start of the run",
           .min = 0.0,
           .max = 1e6},
          from_s);
  v.visit({.name = "until_s",
           .unit = "s",
           .description = "End of each fault since the start of the run",
           .min = 0.0,
           .max = 1e6},
          until_s);
}

ValveFaultSchedule::ValveFaultSchedule(const ValveFaultParameters& parameters) {
  const std::size_t count = parameters.axis.size();
  if (parameters.kind.size() != count || parameters.from_s.size() != count ||
      parameters.until_s.size() != count) {
    throw ConfigError(
        "valve faults: axis, kind, from_s and until_s must have the same number of entries");
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto fault = fault_named(parameters.kind[i]);
    if (!fault) {
      throw ConfigError("valve faults: unknown kind '" + parameters.kind[i] +
                        "'; there are stuck_shut, stuck_open, blocked, slow, leaking");
    }
    if (parameters.until_s[i] < parameters.from_s[i]) {
      throw ConfigError("valve faults: until_s must not be before from_s");
    }
    entries_.push_back({parameters.axis[i], *fault, Duration::seconds(parameters.from_s[i]),
                        Duration::seconds(parameters.until_s[i])});
  }
}

ValveFault ValveFaultSchedule::at(std::string_view axis, Duration since_start) const {
  for (const Entry& entry : entries_) {
    if (entry.axis == axis && entry.from <= since_start && since_start < entry.until) {
      return entry.fault;
    }
  }
  return ValveFault::kNone;
}

}  // namespace furrow::simulation
