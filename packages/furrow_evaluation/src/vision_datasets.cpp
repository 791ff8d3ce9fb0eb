#include "furrow_evaluation/vision_datasets.hpp"

#include <stdexcept>

#include "furrow_annotation/read_dataset.hpp"
#include "furrow_components/field_source.hpp"
#include "furrow_components/rendered_dataset.hpp"
#include "furrow_core/error.hpp"
#include "furrow_launch/installation.hpp"
#include "furrow_vision/image_file.hpp"

namespace furrow::evaluation {
namespace {

namespace fs = std::filesystem;

annotation::Dataset value_or_throw(Result<annotation::Dataset> dataset) {
  if (!dataset.ok()) throw ConfigError(dataset.error().message);
  return std::move(dataset).value();
}

}  // namespace

EvaluationSet render_evaluation_set(const RenderedSet& wanted, const fs::path& folder,
                                    const std::function<void(double)>& progress) {
  components::RenderedDatasetParameters parameters;
  parameters.images = wanted.images;
  parameters.width_px = wanted.size_px.width;
  parameters.height_px = wanted.size_px.height;
  parameters.depth = true;
  const auto species = components::load_species(
      wanted.species_file.empty() ? launch::share_folder() / "params" / "species_evaluation.yaml"
                                  : wanted.species_file);
  // Not the equal shares of training sets: the first species are the most frequent.
  for (std::size_t i = 0; i < species.names(field::PlantKind::kWeed).size(); ++i) {
    parameters.weed_shares.push_back(1.0 / (1.0 + 0.25 * static_cast<double>(i)));
  }
  const auto done =
      components::render_dataset(parameters, species, wanted.seed, folder, [&](std::int64_t count) {
        progress(static_cast<double>(count) / static_cast<double>(wanted.images));
      });
  if (!done.ok()) throw std::runtime_error(done.error().message);
  EvaluationSet set{
      .name = "rendered", .resolution_mm_per_px = parameters.resolution_mm_per_px, .dataset = {}};
  for (const char* part : {"evaluation.json", "validation.json", "train.json"}) {
    annotation::Dataset read = value_or_throw(annotation::read_coco(folder / part));
    set.dataset.classes = read.classes;
    for (auto& image : read.images) set.dataset.images.push_back(std::move(image));
  }
  return set;
}

EvaluationSet open_evaluation_set(const fs::path& path) {
  auto dataset = annotation::read_dataset(path, vision::read_mask);
  if (!dataset.ok()) throw ConfigError("--dataset " + dataset.error().message);
  EvaluationSet set;
  set.notes = annotation::describe(dataset->report, path.string());
  set.name = dataset->name;
  set.resolution_mm_per_px = dataset->resolution_mm_per_px.value_or(set.resolution_mm_per_px);
  set.resolution_known = dataset->resolution_mm_per_px.has_value();
  set.dataset = std::move(*dataset);
  return set;
}

}  // namespace furrow::evaluation
