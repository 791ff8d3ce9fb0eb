#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_core/time.hpp"
#include "furrow_simulation/spray.hpp"

namespace furrow::simulation {

/// Faults of simulated valves over time: the lists belong together entry by entry.
struct ValveFaultParameters {
  std::vector<std::string> axis;
  std::vector<std::string> kind;
  std::vector<double> from_s;
  std::vector<double> until_s;
  void visit(ParameterVisitor& v);
};

/// Which fault which valve has when.
class ValveFaultSchedule {
 public:
  /// Throws ConfigError for lists of different lengths, a kind that is unknown, or an end before
  /// its beginning.
  explicit ValveFaultSchedule(const ValveFaultParameters& parameters);

  /// The fault of an axis' valve, `since_start` after the start of the run; of several the first.
  [[nodiscard]] ValveFault at(std::string_view axis, Duration since_start) const;
  [[nodiscard]] bool empty() const { return entries_.empty(); }

 private:
  struct Entry {
    std::string axis;
    ValveFault fault = ValveFault::kNone;
    Duration from;
    Duration until;
  };
  std::vector<Entry> entries_;
};

}  // namespace furrow::simulation
