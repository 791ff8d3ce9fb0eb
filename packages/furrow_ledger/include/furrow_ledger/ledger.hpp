#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"
#include "furrow_field/field_model.hpp"
#include "furrow_ledger/run_record.hpp"

namespace furrow::ledger {

enum class Outcome : std::uint8_t {
  kAccurate,  ///< weed: stem within the accurate radius of a spray's centre
  kPartial,   ///< weed: within the partial radius
  kMissed,    ///< weed: neither, for a Reason; also when left standing on purpose
  kSpared,    ///< crop: no spray's footprint on its stem
  kHit,       ///< crop: stem within the footprint radius of a spray's centre
};
[[nodiscard]] std::string_view to_string(Outcome outcome);

struct AccountParameters {
  double accurate_radius_m = 0.010;
  double partial_radius_m = 0.025;
  double association_radius_m = 0.050;
  void visit(ParameterVisitor& v);
};

/// One plant and what became of it.
struct LedgerRow {
  std::int64_t plant_id = 0;
  field::PlantKind kind = field::PlantKind::kWeed;
  std::string species;
  Eigen::Vector2d p_F_m = Eigen::Vector2d::Zero();
  double radius_m = 0.0;
  double area_mm2 = 0.0;
  Outcome outcome = Outcome::kMissed;
  Reason reason = Reason::kNone;  ///< of a missed weed; kNone otherwise
  /// The decision that led to the outcome: the one behind the spray, else the last on its track.
  Action action = Action::kNone;
  int axis = -1;  ///< that sprayed it or was to; -1: none
  /// The spray that treated or hit it, or else the nearest of those aimed at it.
  std::optional<Time> sprayed;
  std::optional<double> spray_distance_m;  ///< of that spray's centre to the stem
  std::optional<std::int64_t> track_id;
  std::optional<field::PlantKind> track_kind;
  std::optional<double> track_distance_m;
  std::string seen_species;  ///< of the appraisal, else of the track; empty: none
  std::optional<double> seen_probability;
  /// Of the decision, or else the last one on the track.
  std::optional<Appraisal> appraisal;
};

/// The figures of one run. Percentages are of all weeds; 0 when there are none.
struct Summary {
  std::string field;
  std::string source;
  /// False: nothing says that it was; no ground truth came with the sensors' data.
  bool simulated = true;
  /// False: computed from the robot's own tracks, for want of the true plants. Placement errors and
  /// the loss by vision are then unknown, and null in summary.json.
  bool against_truth = true;
  bool interrupted = false;  ///< see RunInfo
  std::int64_t weeds_total = 0;
  std::int64_t treated_accurate = 0;
  std::int64_t treated_partial = 0;
  std::int64_t missed = 0;
  std::array<std::int64_t, kReasonCount> missed_by_reason{};  ///< indexed by Reason
  double loss_pct = 0.0;                                      ///< missed; the sum of the two below
  double loss_planning_pct = 0.0;                             ///< every reason that is not vision's
  double loss_vision_pct = 0.0;                               ///< see is_vision_loss
  std::int64_t crops_total = 0;
  std::int64_t crops_hit = 0;
  std::int64_t sprays = 0;
  std::int64_t sprays_without_weed = 0;  ///< no weed's stem within the partial radius
  std::int64_t sprays_uncommanded = 0;   ///< by a valve that is stuck open or leaks
  std::vector<std::int64_t> sprays_by_axis;
  /// Placement error: offset of the spray's centre from the stem, minus the planned offset of its
  /// aim from the track. One sample for each weed with a spray aimed at it, hit or not (the nearest
  /// such spray). It contains the errors of vision, localization and actuation. It does not contain
  /// the planned offset by which a spray treats two weeds or spares a crop. In mm; eleven deciles
  /// from minimum to maximum, or none.
  std::optional<double> placement_error_p50_mm;
  std::optional<double> placement_error_p95_mm;
  std::vector<double> placement_error_deciles_mm;
  /// Spray centre to aim, over all sprays: the actuation's own part of the error.
  std::optional<double> aim_error_p50_mm;
  std::optional<double> aim_error_p95_mm;
  std::int64_t tracks_total = 0;
  std::int64_t tracks_without_plant = 0;  ///< no plant within the association radius
  std::vector<double> axis_travel_m;
  double speed_mps = 0.0;
  double distance_m = 0.0;
  double duration_s = 0.0;
  std::int64_t seed = 0;
  std::string version;
  std::optional<double> realtime_factor;  ///< duration_s / wall_s
  std::optional<double> wall_s;
};

/// The account of a run: one row for every plant, in the order of x, then id.
struct Ledger {
  std::vector<LedgerRow> rows;
  Summary summary;
  AccountParameters parameters;
  double length_m = 0.0;
  double width_m = 0.0;
  std::vector<double> row_y_m;
  std::vector<double> placement_errors_mm;  ///< the samples behind the summary, ascending
};

/// Accounts for every plant.
///
/// Tracks are associated with plants one to one, nearest first within the association radius,
/// confirmed tracks before others. Remaining tracks near a plant are its duplicates. A spray is
/// aimed at a plant when it names the plant's track or a duplicate of it; one that names none, when
/// its aim is within the partial radius. A missed weed takes the first cause that holds:
///   1 placement: a spray was aimed at it;
///   2 outside, then end_of_run: beyond RunInfo's reach_y_m, passed_x_m;
///   3 undetected: no track; unconfirmed; misclassified: its track says crop;
///   4 the reason of the last decision, when that was to leave it;
///   5 fault: the last decision was to treat it, and no spray came;
///   6 unreachable: nothing was decided (confirmed too late for a plan).
/// The result does not depend on the order of the input. O(n log n).
/// kInvalidArgument: a number that is not finite, a negative radius, two plants of one id.
[[nodiscard]] Result<Ledger> account(const field::FieldModel& truth, const RunRecord& record,
                                     const AccountParameters& parameters = {});

/// The account of a run without ground truth: every confirmed track stands for a plant at its
/// position. Outcomes are then computed, not measured, and summary.against_truth is false.
/// `strip` gives name, source, size and rows; its plants are not used.
[[nodiscard]] Result<Ledger> account_tracks(const field::FieldModel& strip, const RunRecord& record,
                                            const AccountParameters& parameters = {});

/// summary.json: one object; the figures that depend on the wall clock stand last under
/// "realtime_factor" and "wall_s". What was not measured is null.
[[nodiscard]] std::string to_json(const Summary& summary);
/// ledger.csv: a header with units, one line for every row (RFC 4180; empty: does not apply).
[[nodiscard]] std::string to_csv(const Ledger& ledger);

/// Writes summary.json, ledger.csv, map.svg and report.html into a folder, each whole or not at
/// all.
[[nodiscard]] Status write_run_files(const std::filesystem::path& folder, const Ledger& ledger,
                                     const RunRecord& record);

}  // namespace furrow::ledger
