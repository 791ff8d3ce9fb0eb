#include "furrow_experiments/planner_choice.hpp"

namespace furrow::experiments {

std::string to_string(const PlannerChoice& choice) {
  return choice.planner + "/" + choice.assignment;
}

const std::vector<PlannerChoice>& all_planner_choices() {
  static const std::vector<PlannerChoice> kAll = {
      {"greedy", "distance"},      {"greedy", "static"},      {"greedy", "dynamic"},
      {"notsp", "distance"},       {"notsp", "static"},       {"notsp", "dynamic"},
      {"permutation", "distance"}, {"permutation", "static"}, {"permutation", "dynamic"},
      {"exact", "distance"},       {"exact", "static"},       {"exact", "dynamic"},
      {"greedy", "joint"},         {"exact", "joint"},        {"footprint", "joint"}};
  return kAll;
}

std::vector<PlannerChoice> main_planner_choices() {
  return {{"notsp", "static"},
          {"exact", "static"},
          {"greedy", "joint"},
          {"exact", "joint"},
          {"footprint", "joint"}};
}

Result<PlannerChoice> planner_choice_from(std::string_view text) {
  std::string known;
  const PlannerChoice* only = nullptr;
  int count = 0;
  for (const PlannerChoice& choice : all_planner_choices()) {
    if (to_string(choice) == text) return choice;
    if (choice.planner == text) {
      only = &choice;
      ++count;
    }
    known += (known.empty() ? "" : ", ") + to_string(choice);
  }
  if (count == 1) return *only;
  return Error{ErrorCode::kNotFound,
               "there is no planner '" + std::string(text) + "', only " + known};
}

}  // namespace furrow::experiments
