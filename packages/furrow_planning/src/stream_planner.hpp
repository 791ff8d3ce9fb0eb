#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "furrow_planning/observation_view.hpp"
#include "furrow_planning/plan_checker.hpp"
#include "furrow_planning/route_planner.hpp"

namespace furrow::planning {

/// Both observation models. The rolling view plans all uncommitted targets whenever something has
/// changed. The segment view plans, once, the targets of the segments that have been seen
/// completely since the last plan.
class StreamPlanner final : public ObservationView {
 public:
  StreamPlanner(const PlannerParameters& parameters, std::vector<AxisSpec> axes);

  Status update(const Target& target) override;
  bool remove(TargetId id) override;
  Status update_protected(const ProtectedPlant& plant) override;
  bool remove_protected(TargetId id) override;
  Status set_in_service(std::size_t axis, bool in_service) override;
  Status set_axis_position(std::size_t axis, double position_m) override;
  Status advance(const RobotState& robot, double seen_until_x_m) override;
  [[nodiscard]] Result<bool> replan() override;
  [[nodiscard]] const Plan& plan() const override { return plan_; }
  Status set_speeds(const SpeedProfile& speeds) override;
  [[nodiscard]] Result<std::span<const LeftTarget>> left_at(const SpeedProfile& speeds) override;
  [[nodiscard]] double committed_until_x_m() const override;
  void take_outcomes(std::vector<TargetOutcome>& outcomes) override;
  [[nodiscard]] const std::vector<double>& travel_m() const override { return travel_m_; }

 private:
  enum class Phase : std::uint8_t { kWaiting, kCommitted, kFinished };
  struct Record {
    Target target;
    Phase phase = Phase::kWaiting;
    bool segment_planned = false;  ///< segment view: its stretch had its plan
    Decision decision = Decision::kUnreachable;
    std::int32_t axis = -1;
    Eigen::Vector2d aim_F = Eigen::Vector2d::Zero();
  };
  struct Committed {  ///< a stop, with the ids that it treats in committed_ids_
    Stop stop;
    std::vector<TargetId> ids;
  };
  struct AxisRecord {
    AxisSpec spec;
    bool in_service = true;
    AxisState rest;                    ///< after the last stop that was passed
    std::vector<Committed> committed;  ///< by robot x
    std::size_t committed_count = 0;   ///< the first of `committed` that count; the rest is memory
  };

  [[nodiscard]] Record* find(TargetId id);
  [[nodiscard]] bool treated_before(const Target& target) const;
  [[nodiscard]] double planning_speed_mps() const;
  void commit_due_stops();
  void commit(AxisRecord& axis, const Stop& stop);
  void pass_stops();
  void finish_passed_targets();
  void finish(Record& record, Decision decision);
  void drop_stops(AxisRecord& axis);
  void forget_old();
  [[nodiscard]] bool may_plan(const Record& record) const;
  [[nodiscard]] bool collect();
  [[nodiscard]] Status may_change_speed() const;
  [[nodiscard]] PlanningProblem problem() const;
  void merge();

  PlannerParameters parameters_;
  bool segments_ = false;
  std::unique_ptr<RoutePlanner> planner_;
  PlanChecker checker_;
  std::vector<AxisRecord> axes_;
  std::vector<AxisSpec> specs_;
  std::vector<Record> records_;            ///< by id
  std::vector<ProtectedPlant> protected_;  ///< by id
  RobotState robot_;                       ///< at the furthest point that it reached
  double behind_m_ = 0.0;                  ///< how far the robot is behind that point now
  std::optional<SpeedProfile> speeds_;
  bool placed_ = false;
  bool changed_ = false;
  double seen_until_x_m_ = 0.0;
  double planned_until_x_m_ = 0.0;  ///< segment view
  double planned_speed_mps_ = 0.0;
  double planned_y_m_ = 0.0;
  double forgotten_x_m_ = 0.0;

  std::vector<Target> targets_;  ///< the problem at hand
  std::vector<std::size_t> target_records_;
  std::vector<AxisState> states_;
  Plan fresh_;
  Plan trial_;
  std::vector<LeftTarget> left_;
  Plan plan_;
  std::vector<TargetOutcome> outcomes_;
  std::vector<double> travel_m_;
};

}  // namespace furrow::planning
