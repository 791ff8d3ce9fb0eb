#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::ledger {

/// Why a weed was missed. The first group is a limit of the vision system, the rest of planning,
/// of the machine or of the run.
enum class Reason : std::uint8_t {
  kNone,           ///< not missed
  kUndetected,     ///< no track ever stood near it
  kUnconfirmed,    ///< a track stood there, seen too seldom to be trusted
  kMisclassified,  ///< taken for a crop
  kLowPriority,    ///< left standing on purpose, for bio-diversity
  kProtectedCrop,  ///< too near a crop
  kUnreachable,    ///< no axis could be there in time, or others were worth more
  kStale,          ///< the track or the odometry was too old to fire on
  kOutside,        ///< beside the travel of every axis
  kFault,          ///< planned, but the axis or valve did not deliver
  kPlacement,      ///< sprayed at, but the spray landed beside it
  kEndOfRun,       ///< the run ended before a tool came over it, or started beyond it
  kInactive,       ///< the tool was raised or switched off
  kUnsure,         ///< too likely a crop to be treated
};
inline constexpr std::size_t kReasonCount = 14;

[[nodiscard]] std::string_view to_string(Reason reason);  ///< "low_priority"
[[nodiscard]] std::optional<Reason> reason_from_string(std::string_view name);
/// True for undetected, unconfirmed, misclassified and unsure.
[[nodiscard]] bool is_vision_loss(Reason reason);

/// One opening of a valve: what reached the ground, and what was meant.
struct Spray {
  Time time;                                            ///< when it reached the ground
  int axis = 0;                                         ///< index in the tool model
  Eigen::Vector2d p_F_m = Eigen::Vector2d::Zero();      ///< centre of what landed
  double radius_m = 0.025;                              ///< of the footprint
  Eigen::Vector2d sweep_F_m = Eigen::Vector2d::Zero();  ///< from first to last drop; drawn only
  Eigen::Vector2d aim_F_m = Eigen::Vector2d::Zero();    ///< where the centre was meant to be
  std::vector<std::int64_t> track_ids;                  ///< the tracks meant; several may share one
  bool commanded = true;                                ///< by the driver; else the valve's fault
};

/// What the tracker knew of one track in the end. Give each track that ever was, once.
struct TrackView {
  std::int64_t id = 0;
  Eigen::Vector2d p_F_m = Eigen::Vector2d::Zero();  ///< the stem
  field::PlantKind kind = field::PlantKind::kWeed;  ///< fused class
  bool confirmed = false;
  std::string species;  ///< the most probable of its kind; may be empty
  double species_probability = 0.0;
  int leaves = 0;         ///< growth stage; 0: not known
  double radius_m = 0.0;  ///< may be 0: not known
  double area_mm2 = 0.0;
};

/// How the planner valued the treatment of a weed. By the scheme "kappa" the worth is
/// area_mm2 * beta * crop_proximity; by "class" it is class_weight.
struct Appraisal {
  std::string scheme;
  std::string species;  ///< the most probable weed; empty: unknown
  double species_probability = 0.0;
  double unknown_probability = 0.0;  ///< of species that the planner's table does not have
  double area_mm2 = 0.0;
  int leaves = 0;
  double beta = 0.0;             ///< expected over the species
  double class_weight = 0.0;     ///< likewise
  double crop_distance_m = 0.0;  ///< to the nearest crop in range; infinite: none
  double crop_proximity = 0.0;   ///< sum of 1 / (crop area x distance), in 1/(mm2 m)
  double worth = 0.0;
  double threshold = 0.0;  ///< weeds of less worth are left standing
};

enum class Action : std::uint8_t {
  kNone,   ///< never decided upon
  kTreat,  ///< in the route of an axis
  kLeave,  ///< left standing, for `reason`
};
[[nodiscard]] std::string_view to_string(Action action);

/// A decision of planner or driver about a track. Give every change with its time: the latest is
/// the reason of a missed weed, the one before a spray led to that spray. A driver that skipped a
/// stop adds a kLeave with its reason (kUnreachable, kStale, kFault, kProtectedCrop).
struct Decision {
  Time time;
  std::int64_t track_id = 0;
  Action action = Action::kNone;
  Reason reason = Reason::kNone;  ///< of kLeave
  int axis = -1;                  ///< of kTreat
  std::optional<Appraisal> appraisal = {};
};

/// Where a nozzle went over the ground, for drawing.
struct RouteView {
  int axis = 0;
  std::vector<Eigen::Vector2d> p_F_m;  ///< in the order of time
};

/// A table for the report: health of components, drops, rates.
struct ReportTable {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

struct RunInfo {
  bool simulated = true;
  bool interrupted = false;  ///< ended by the user: what was not reached counts as end_of_run
  std::int64_t seed = 0;
  std::string version;                ///< of Furrow
  std::string graph;                  ///< graph file, as named by the user
  double speed_mps = 0.0;             ///< mean speed along the row
  double distance_m = 0.0;            ///< driven
  double duration_s = 0.0;            ///< by the clock of the run
  double wall_s = 0.0;                ///< by the wall clock; 0: not measured
  std::vector<double> axis_travel_m;  ///< per axis
  /// What the nozzles passed over, in F: x along the row, y across. Weeds beyond it count as
  /// end_of_run (x) or outside (y). Nothing: no limit known.
  std::optional<std::pair<double, double>> passed_x_m;
  std::optional<std::pair<double, double>> reach_y_m;
  /// More lines of provenance, as (name, value).
  std::vector<std::pair<std::string, std::string>> more;
};

/// All that a run leaves behind. The order within each list does not matter to the account.
struct RunRecord {
  RunInfo info;
  std::vector<TrackView> tracks;
  std::vector<Decision> decisions;
  std::vector<Spray> sprays;
  std::vector<RouteView> routes;
  std::vector<ReportTable> tables;
};

}  // namespace furrow::ledger
