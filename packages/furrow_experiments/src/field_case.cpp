#include "furrow_experiments/field_case.hpp"

#include <utility>

#include "furrow_core/random.hpp"
#include "furrow_experiments/paper_figures.hpp"
#include "furrow_field/generator.hpp"
#include "furrow_field/statistics.hpp"

namespace furrow::experiments {
namespace {

constexpr double kHighPriorityShare = 1.0 / 11.0;

Result<field::FieldModel> make_field(const FieldCase& field, const RowParameters& row,
                                     std::uint64_t seed) {
  if (field.imported) return *field.imported;
  field::FieldParameters parameters;
  parameters.name = field.name;
  parameters.length_m = row.length_m;
  parameters.width_m = row.width_m;
  parameters.weeds_per_m2 = field.weeds_per_m2;
  parameters.pattern = row.pattern;
  parameters.crop = row.crop;
  return field::generate_field(parameters, field::SpeciesTable::defaults(), seed);
}

}  // namespace

std::vector<FieldCase> paper_field_cases() {
  std::vector<FieldCase> cases;
  for (const PaperFigures& figures : kPaperFigures) {
    cases.push_back({std::string(figures.generated_as), figures.weeds_per_m2, std::nullopt});
  }
  return cases;
}

Result<FieldCase> imported_field_case(field::FieldModel field) {
  if (Status valid = field::validate(field); !valid.ok()) return valid.error();
  const field::FieldStatistics statistics = field::statistics_of(field);
  if (!(statistics.area_m2 > 0.0)) {
    return Error{ErrorCode::kInvalidArgument, "field " + field.name + " has no area"};
  }
  FieldCase result{field.name, statistics.weeds_per_m2, std::nullopt};
  result.imported = std::move(field);
  return result;
}

void RowParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "length_m",
           .unit = "m",
           .description = "length of a generated row",
           .min = 0.1,
           .max = field::kMaxFieldLength_m},
          length_m);
  v.visit({.name = "width_m",
           .unit = "m",
           .description = "width of a generated row",
           .min = 0.01,
           .max = field::kMaxFieldWidth_m},
          width_m);
  v.visit({.name = "pattern",
           .description = "how weeds are scattered",
           .choices = {"poisson", "clusters"}},
          pattern);
  v.visit({.name = "crop", .description = "whether crop stands in generated rows"}, crop);
}

Result<FieldTargets> make_targets(const FieldCase& field, const RowParameters& row,
                                  std::uint64_t seed) {
  auto model = make_field(field, row, seed);
  if (!model.ok()) return model.error();
  FieldTargets targets;
  targets.length_m = model->length_m;
  Random random(seed, "priority");
  for (const field::Plant& plant : model->plants) {
    if (plant.kind == field::PlantKind::kCrop) {
      targets.crops.push_back({.id = plant.id, .p_F = plant.p_F_m});
      continue;
    }
    planning::Target weed;
    weed.id = static_cast<planning::TargetId>(targets.weeds.size());
    weed.p_F = plant.p_F_m;
    weed.radius_m = plant.radius_m;
    targets.weeds.push_back(weed);
    targets.high_priority.push_back(random.bernoulli(kHighPriorityShare));
  }
  return targets;
}

}  // namespace furrow::experiments
