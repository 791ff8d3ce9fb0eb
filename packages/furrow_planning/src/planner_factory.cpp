#include "divided_planner.hpp"
#include "footprint_planner.hpp"
#include "furrow_core/error.hpp"
#include "furrow_planning/kinematics.hpp"
#include "furrow_planning/route_planner.hpp"
#include "joint_planner.hpp"

namespace furrow::planning {
namespace {

/// Values out of the declared range or choices throw here, however the struct was filled.
class RangeChecker final : public ParameterVisitor {
 public:
  void visit(const ParameterInfo&, bool&) override {}
  void visit(const ParameterInfo& info, std::int64_t& value) override {
    check(info, static_cast<double>(value));
  }
  void visit(const ParameterInfo& info, double& value) override { check(info, value); }
  void visit(const ParameterInfo& info, std::string& value) override {
    for (const std::string& choice : info.choices) {
      if (choice == value) {
        return;
      }
    }
    throw ConfigError("planner parameter " + info.name + " cannot be '" + value + "'");
  }
  void visit(const ParameterInfo&, std::vector<double>&) override {}
  void visit(const ParameterInfo&, std::vector<std::string>&) override {}

 private:
  static void check(const ParameterInfo& info, double value) {
    if (!(value >= info.min && value <= info.max)) {
      throw ConfigError("planner parameter " + info.name + " is out of its range");
    }
  }
};

}  // namespace

std::unique_ptr<RoutePlanner> make_route_planner(const PlannerParameters& parameters) {
  PlannerParameters copy = parameters;
  RangeChecker checker;
  copy.visit(checker);
  if (copy.assignment != "joint") {
    if (copy.planner == "footprint") {
      throw ConfigError("the footprint planner plans all axes jointly; its assignment is joint");
    }
    return std::make_unique<DividedPlanner>(copy);
  }
  if (copy.planner == "greedy") {
    return std::make_unique<JointGreedyPlanner>(copy);
  }
  if (copy.planner == "exact") {
    return std::make_unique<JointPlanner>(copy);
  }
  if (copy.planner == "footprint") {
    return std::make_unique<FootprintPlanner>(copy);
  }
  throw ConfigError("the planner " + copy.planner + " has no joint assignment");
}

}  // namespace furrow::planning
