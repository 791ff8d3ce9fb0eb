#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_experiments/drive.hpp"
#include "furrow_experiments/field_case.hpp"
#include "furrow_experiments/setup.hpp"
#include "furrow_planning/parameters.hpp"

namespace furrow::experiments {

/// Fields and seeds of an experiment.
struct SamplingParameters {
  std::int64_t seeds = 20;
  std::int64_t first_seed = 1;
  RowParameters row;

  void visit(ParameterVisitor& v);
};

/// One way to work: a planner with everything that it depends on.
struct Variant {
  planning::PlannerParameters planner;
  SetupParameters setup;
  bool by_priority = false;  ///< plan with the weights below; else all weeds weigh 1
};
inline constexpr double kLowWeight = 0.1;  ///< the paper's
inline constexpr double kHighWeight = 1.0;

/// What came of one drive. The clairvoyant optimum is the best joint plan of one spray for each
/// weed, made at once for the whole row with all plants known. Footprints that take several weeds
/// can do better.
struct DriveFigures {
  std::size_t weeds = 0;
  std::size_t treated = 0;
  std::size_t high = 0;
  std::size_t high_treated = 0;
  std::size_t left_for_crop = 0;  ///< no spray could keep out of the protection zone
  std::size_t outside = 0;        ///< beyond the span of every axis
  std::size_t sprays = 0;
  std::size_t optimum_treated = 0;
  std::vector<double> travel_m;   ///< of each axis
  std::vector<double> replan_us;  ///< measured, not repeatable

  [[nodiscard]] double loss_pct() const;  ///< 0 without weeds
  [[nodiscard]] double optimum_loss_pct() const;
};

/// A row of a result table: one variant on the fields of one case. Loss is the mean over the seeds
/// with its 95 % confidence interval (NaN for one seed); travel the mean and the standard deviation
/// over axes and seeds.
struct EvaluationRow {
  std::string field;
  double weeds_per_m2 = 0.0;
  std::string kinematics;
  std::string assignment;
  std::string planner;
  std::string view;
  double loss_pct = 0.0;
  double loss_ci95 = 0.0;
  double travel_m_mean = 0.0;
  double travel_m_sd = 0.0;
  double replan_p50_us = 0.0;  ///< measured, not repeatable
  double replan_p99_us = 0.0;
  std::optional<double> paper_loss_pct;
  double optimum_loss_pct = 0.0;
  /// Planners that place footprints: what no placement at all can treat, so that loss_pct minus
  /// this is the most that any plan could gain.
  std::optional<double> bound_loss_pct;
  double left_for_crop_pct = 0.0;
  double sprays_per_weed = 0.0;  ///< treated

  /// Of the biodiversity experiment.
  struct Priorities {
    std::string scheme;  ///< "plain", "biodiversity"
    double treated_low_pct = 0.0;
    double treated_high_pct = 0.0;
    std::optional<double> paper_low_pct;
    std::optional<double> paper_high_pct;
  };
  std::optional<Priorities> priorities;
};

/// Called now and then with the share that is done, by one thread at a time.
using Progress = std::function<void(double)>;

/// Figures by case, variant, seed. The same on any number of threads (0: as many as there are),
/// times apart. Imported fields are driven once, where no variant plans by priority. Error: the
/// first of a drive. Throws ConfigError for parameters that do not fit.
using Figures = std::vector<std::vector<std::vector<DriveFigures>>>;
[[nodiscard]] Result<Figures> drive_all(const std::vector<FieldCase>& fields,
                                        const std::vector<Variant>& variants,
                                        const SamplingParameters& sampling, std::size_t threads,
                                        const Progress& progress = {});

/// The most weeds that can be treated with one spray each, by weight, knowing the whole row.
[[nodiscard]] Result<std::size_t> clairvoyant_treated(const FieldTargets& field,
                                                      const planning::PlannerParameters& planner,
                                                      const SetupParameters& setup);

/// Aggregates over seeds; the paper's figures are not filled in.
[[nodiscard]] EvaluationRow summarize(const FieldCase& field, const Variant& variant,
                                      const std::vector<DriveFigures>& figures);

}  // namespace furrow::experiments
