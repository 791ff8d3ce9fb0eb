#include "furrow_experiments/biodiversity_experiment.hpp"

#include <utility>

#include "furrow_experiments/paper_figures.hpp"

namespace furrow::experiments {
namespace {

constexpr const char* kPlain = "plain";
constexpr const char* kBiodiversity = "biodiversity";

double share_pct(std::size_t part, std::size_t whole) {
  return whole == 0 ? 100.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

/// Over all seeds together: one field of low density holds few weeds of high priority.
EvaluationRow::Priorities priorities_of(const std::vector<DriveFigures>& figures, bool weighted,
                                        const PaperFigures* paper) {
  DriveFigures sum;
  for (const DriveFigures& drive : figures) {
    sum.weeds += drive.weeds;
    sum.treated += drive.treated;
    sum.high += drive.high;
    sum.high_treated += drive.high_treated;
  }
  EvaluationRow::Priorities result;
  result.scheme = weighted ? kBiodiversity : kPlain;
  result.treated_low_pct = share_pct(sum.treated - sum.high_treated, sum.weeds - sum.high);
  result.treated_high_pct = share_pct(sum.high_treated, sum.high);
  if (paper != nullptr) {
    result.paper_low_pct = weighted ? paper->low_biodiversity_pct : paper->low_plain_pct;
    result.paper_high_pct = weighted ? paper->high_biodiversity_pct : paper->high_plain_pct;
  }
  return result;
}

}  // namespace

Result<BiodiversityResult> run(const BiodiversityExperiment& experiment, const Progress& progress) {
  std::vector<Variant> variants;
  for (const PlannerChoice& choice : experiment.planners) {
    for (const std::string& view : experiment.views) {
      for (const bool weighted : {false, true}) {
        Variant variant{experiment.planner, experiment.setup, weighted};
        variant.planner.planner = choice.planner;
        variant.planner.assignment = choice.assignment;
        variant.planner.view = view;
        variants.push_back(std::move(variant));
      }
    }
  }
  const auto figures =
      drive_all(experiment.fields, variants, experiment.sampling, experiment.threads, progress);
  if (!figures.ok()) return figures.error();
  BiodiversityResult result;
  for (std::size_t f = 0; f < experiment.fields.size(); ++f) {
    const PaperFigures* paper = paper_figures(experiment.fields[f].name);
    for (std::size_t v = 0; v < variants.size(); ++v) {
      const auto& drives = (*figures)[f][v];
      EvaluationRow row = summarize(experiment.fields[f], variants[v], drives);
      // The paper's table does not say of which view it is: it stands beside the paper's own.
      row.priorities = priorities_of(drives, variants[v].by_priority,
                                     variants[v].planner.view == "rolling" ? paper : nullptr);
      result.rows.push_back(std::move(row));
    }
  }
  return result;
}

}  // namespace furrow::experiments
