#include "vision_datasets.hpp"

#include <iostream>
#include <stdexcept>

#include "console.hpp"
#include "furrow_annotation/read_dataset.hpp"
#include "furrow_components/field_source.hpp"
#include "furrow_components/rendered_dataset.hpp"
#include "furrow_core/error.hpp"
#include "furrow_vision/image_file.hpp"
#include "share.hpp"

namespace furrow::cli {
namespace {

namespace fs = std::filesystem;

annotation::Dataset value_or_throw(Result<annotation::Dataset> dataset) {
  if (!dataset.ok()) throw ConfigError(dataset.error().message);
  return std::move(dataset).value();
}

}  // namespace

EvaluationSet render_evaluation_set(const fs::path& folder, std::int64_t images, cv::Size size,
                                    std::uint64_t seed, const fs::path& species_file) {
  components::RenderedDatasetParameters parameters;
  parameters.images = images;
  parameters.width_px = size.width;
  parameters.height_px = size.height;
  parameters.depth = true;
  const auto species = components::load_species(
      species_file.empty() ? share_folder() / "params" / "species_evaluation.yaml" : species_file);
  // Not the equal shares of training sets: the first species are the most frequent.
  for (std::size_t i = 0; i < species.names(field::PlantKind::kWeed).size(); ++i) {
    parameters.weed_shares.push_back(1.0 / (1.0 + 0.25 * static_cast<double>(i)));
  }
  ProgressBar bar("rendering");
  const Status done =
      components::render_dataset(parameters, species, seed, folder, [&](std::int64_t count) {
        bar.show(static_cast<double>(count) / static_cast<double>(images), std::to_string(count));
      });
  bar.finish();
  if (!done.ok()) throw std::runtime_error(done.error().message);
  EvaluationSet set{"rendered", parameters.resolution_mm_per_px, {}};
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
  for (const std::string& note : annotation::describe(dataset->report, path.string())) {
    std::cerr << "furrow: " << note << '\n';
  }
  EvaluationSet set;
  set.name = dataset->name;
  set.resolution_mm_per_px = dataset->resolution_mm_per_px.value_or(set.resolution_mm_per_px);
  set.dataset = std::move(*dataset);
  return set;
}

}  // namespace furrow::cli
