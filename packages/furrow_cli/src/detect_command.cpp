#include <iostream>
#include <memory>

#include "commands.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/text.hpp"
#include "furrow_evaluation/image_detection.hpp"
#include "output_options.hpp"
#include "vision_options.hpp"

namespace furrow::cli {
namespace {

constexpr double kDefaultResolution_mm = 1.15;

struct DetectOptions {
  VisionOptions vision;
  std::vector<std::string> images;
  std::string out = "detections";
  double min_score = 0.1;
  bool force = false;
};

int detect(const DetectOptions& options) {
  evaluation::DetectorChoices choices = options.vision.choices;
  if (choices.detectors.empty()) {
    choices.detectors = {choices.models.empty() ? "index" : "one_stage"};
  }
  const auto detectors = evaluation::make_detectors(choices);
  if (detectors.size() != 1) throw ConfigError("--detector: give one; furrow detect runs only one");
  const OutputFolder folder = claim_folder(options.out, {"detections.json"}, options.force);
  const evaluation::ImageDetectionResult result = evaluation::detect_images(
      detectors.front(),
      {.images = {options.images.begin(), options.images.end()},
       .resolution_mm_per_px = options.vision.resolution_mm_per_px.value_or(kDefaultResolution_mm),
       .min_score = options.min_score,
       .folder = folder.path(),
       .overwrite = options.force ? Overwrite::kYes : Overwrite::kNo});
  for (const std::string& fault : result.faults) std::cerr << "furrow: " << fault << '\n';
  std::vector<std::vector<std::string>> table = {{"image", "plants", "crops", "weeds"}};
  for (const evaluation::DetectedImage& image : result.images) {
    table.push_back({image.picture.string(), std::to_string(image.plants),
                     std::to_string(image.crops), std::to_string(image.plants - image.crops)});
  }
  std::cout << text_table(table) << result.json.string() << '\n';
  return result.faults.empty() ? 0 : 1;
}

}  // namespace

void add_detect_command(Command root) {
  auto options = std::make_shared<DetectOptions>();
  Command command = root.subcommand(
      "detect",
      "Detects plants in images. Writes pictures with classes, scores, stems and areas, and COCO.");
  command.option("images", options->images, "image files").required();
  add_vision_options(command, options->vision);
  command.option("--out", options->out, "folder; numbered when it holds a detections.json");
  command.option("--min-score", options->min_score, "plants with a lower score are left out")
      .range(0.0, 1.0);
  add_force_option(command, options->force);
  command.on_run([options] { return detect(*options); });
}

}  // namespace furrow::cli
