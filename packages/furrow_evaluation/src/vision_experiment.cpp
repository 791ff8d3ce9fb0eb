#include "furrow_evaluation/vision_experiment.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "furrow_core/scratch_folder.hpp"
#include "furrow_core/statistics.hpp"
#include "furrow_core/text.hpp"
#include "furrow_evaluation/loaded_image.hpp"
#include "furrow_evaluation/vision_datasets.hpp"
#include "furrow_vision/evaluation.hpp"
#include "vision_gallery.hpp"

namespace furrow::evaluation {
namespace {

/// An image with fewer plants shows little.
constexpr std::size_t kLeastPlantsOfPicture = 5;

/// One detector on one data set.
struct DetectorOnSet {
  NamedDetector& named;
  vision::VisionEvaluation evaluation = {};
  std::vector<double> ms = {};
  VisionGallery gallery = {};
};

void evaluate_image(const annotation::AnnotatedImage& image, const LoadedImage& loaded,
                    const std::string& dataset, bool pictures, DetectorOnSet& on_set) {
  vision::Detector& detector = *on_set.named.detector;
  detector.reset();  // the images are no sequence
  const auto start = std::chrono::steady_clock::now();
  const auto found = detector.detect(loaded.view());
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  if (!found.ok()) {
    throw std::runtime_error(image.path.string() + ": " + found.error().message);
  }
  on_set.ms.push_back(took.count());
  const double miou = on_set.evaluation.add(image, *found, loaded.camera, loaded.ground_distance_m);
  if (pictures && image.instances.size() >= kLeastPlantsOfPicture && on_set.gallery.wants(miou)) {
    on_set.gallery.add({.dataset = dataset,
                        .detector = on_set.named.name,
                        .file = image.path.filename().string(),
                        .miou = miou,
                        .jpeg = side_by_side_jpeg(image, *found, detector.classes())});
  }
}

/// Lets a given resolution overrule the data set's. Adds a note where one has to be assumed, and
/// returns whether that is so.
bool settle_resolution(const std::optional<double>& given_mm_per_px, EvaluationSet& set,
                       std::vector<std::string>& notes) {
  auto& images = set.dataset.images;
  if (given_mm_per_px) {
    set.resolution_mm_per_px = *given_mm_per_px;
    for (auto& image : images) image.resolution_mm_per_px.reset();
    return false;
  }
  const bool of_each_image = std::all_of(images.begin(), images.end(), [](const auto& image) {
    return image.resolution_mm_per_px.has_value();
  });
  if (set.resolution_known || of_each_image) return false;
  notes.push_back(set.name + ": ground resolution is unknown; " +
                  fixed(set.resolution_mm_per_px, 2) +
                  " mm per px is assumed, so sizes and distances in mm may be wrong. Give it with "
                  "--resolution, or with resolution_mm_per_px in evaluation.json");
  return true;
}

void evaluate_set(EvaluationSet set, std::vector<NamedDetector>& detectors,
                  const VisionExperiment& experiment, const std::function<void(double)>& progress,
                  VisionReport& report) {
  const bool assumed = settle_resolution(experiment.resolution_mm_per_px, set, set.notes);
  report.notes.insert(report.notes.end(), set.notes.begin(), set.notes.end());
  auto& images = set.dataset.images;
  std::erase_if(images, [](const auto& image) { return !image.labelled; });
  if (experiment.limit > 0 && std::ssize(images) > experiment.limit) {
    images.resize(static_cast<std::size_t>(experiment.limit));
  }
  std::vector<DetectorOnSet> running;
  for (NamedDetector& named : detectors) running.push_back({.named = named});
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto loaded =
        load_image(images[i], images[i].resolution_mm_per_px.value_or(set.resolution_mm_per_px));
    if (!loaded.ok()) throw std::runtime_error(loaded.error().message);
    for (DetectorOnSet& on_set : running) {
      evaluate_image(images[i], *loaded, set.name, experiment.pictures, on_set);
    }
    images[i].bgr.release();
    progress(static_cast<double>(i + 1) / static_cast<double>(images.size()));
  }
  for (DetectorOnSet& on_set : running) {
    report.rows.push_back({.dataset = set.name,
                           .detector = on_set.named.name,
                           .scores = on_set.evaluation.scores(),
                           .intervals = on_set.evaluation.intervals(experiment.seed),
                           .ms_per_frame = quantile(on_set.ms, 0.5)});
    on_set.gallery.move_to(report.pictures);
  }
  report.parameters.emplace_back(
      set.name + "_mm_per_px", fixed(set.resolution_mm_per_px, 3) + (assumed ? " (assumed)" : ""));
}

}  // namespace

VisionReport run(const VisionExperiment& experiment,
                 const std::function<void(const std::string&, double)>& progress) {
  auto detectors = make_detectors(experiment.detectors);
  VisionReport report;
  report.seed = experiment.seed;
  for (const std::string& setting : experiment.detectors.settings) {
    const auto equals = setting.find('=');
    report.parameters.emplace_back(setting.substr(0, equals), setting.substr(equals + 1));
  }
  for (const std::string& dataset : experiment.datasets) {
    const auto evaluated = [&](double share) { progress(dataset, share); };
    if (dataset == "rendered") {
      const ScratchFolder scratch;
      EvaluationSet set = render_evaluation_set(
          {.images = experiment.images,
           .seed = experiment.seed,
           .species_file = experiment.species_file},
          scratch.path(), [&](double share) { progress("rendering", share); });
      evaluate_set(std::move(set), detectors, experiment, evaluated, report);
    } else {
      evaluate_set(open_evaluation_set(dataset), detectors, experiment, evaluated, report);
    }
  }
  return report;
}

}  // namespace furrow::evaluation
