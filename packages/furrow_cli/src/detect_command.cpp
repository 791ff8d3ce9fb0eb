#include <filesystem>
#include <iostream>
#include <memory>

#include "command.hpp"
#include "console.hpp"
#include "furrow_annotation/coco.hpp"
#include "furrow_core/error.hpp"
#include "furrow_vision/annotated_image.hpp"
#include "furrow_vision/image_file.hpp"
#include "furrow_vision/overlay.hpp"
#include "vision_options.hpp"

namespace furrow::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kDefaultResolution_mm = 1.15;

struct DetectOptions {
  VisionOptions vision;
  std::vector<std::string> images;
  std::string out = "detections";
  double min_score = 0.1;
};

/// Names of images in several folders may agree; outputs may not.
fs::path output_name(const fs::path& folder, const fs::path& image, std::size_t index) {
  fs::path name = folder / (image.stem().string() + ".png");
  if (fs::exists(name)) {
    name = folder / (image.stem().string() + "_" + std::to_string(index) + ".png");
  }
  return name;
}

int detect(DetectOptions options) {
  if (options.vision.detectors.empty()) {
    options.vision.detectors = {options.vision.models.empty() ? "index" : "one_stage"};
  }
  auto detectors = make_detectors(options.vision);
  if (detectors.size() != 1) throw ConfigError("--detector: furrow detect runs one at a time");
  vision::Detector& detector = *detectors.front().detector;
  std::error_code failure;
  fs::create_directories(options.out, failure);
  if (failure) throw ConfigError(options.out + ": cannot make the folder: " + failure.message());

  annotation::Dataset found{.name = "detections of " + detectors.front().name,
                            .classes = detector.classes(),
                            .images = {}};
  std::vector<std::vector<std::string>> table = {{"image", "plants", "crops", "weeds"}};
  int faults = 0;
  for (std::size_t i = 0; i < options.images.size(); ++i) {
    annotation::AnnotatedImage image;
    image.path = options.images[i];
    const auto loaded =
        load_image(image, options.vision.resolution_mm_per_px.value_or(kDefaultResolution_mm));
    detector.reset();  // images on their own are no sequence
    if (!loaded.ok()) {
      std::cerr << "furrow: " << loaded.error().message << '\n';  // names the file
      ++faults;
      continue;
    }
    auto plants = detector.detect(loaded->view());
    if (!plants.ok()) {
      std::cerr << "furrow: " << options.images[i] << ": " << plants.error().message << '\n';
      ++faults;
      continue;
    }
    std::erase_if(*plants, [&](const auto& plant) { return plant.score < options.min_score; });
    cv::Mat picture = image.bgr.clone();
    vision::draw_instances(*plants, detector.classes(), true, picture);
    const fs::path file = output_name(options.out, image.path, i);
    if (const Status written = vision::write_image(file, picture); !written.ok()) {
      throw std::runtime_error(written.error().message);
    }
    const auto crops = std::count_if(plants->begin(), plants->end(), [](const auto& plant) {
      return plant.crop_probability >= 0.5;
    });
    const auto count = static_cast<std::ptrdiff_t>(plants->size());
    table.push_back({file.string(), std::to_string(count), std::to_string(crops),
                     std::to_string(count - crops)});
    image.path = fs::absolute(image.path);
    image.width_px = image.bgr.cols;
    image.height_px = image.bgr.rows;
    image.instances = vision::to_annotations(*plants, detector.classes());
    image.bgr.release();
    found.images.push_back(std::move(image));
  }
  const fs::path json = fs::path(options.out) / "detections.json";
  if (const Status written = annotation::write_coco(json, found); !written.ok()) {
    throw std::runtime_error(written.error().message);
  }
  std::cout << text_table(table) << json.string() << '\n';
  return faults == 0 ? 0 : 1;
}

}  // namespace

void add_detect_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DetectOptions>();
  CLI::App* command = app.add_subcommand(
      "detect",
      "Finds plants in images: pictures with classes, scores, stems and areas, and COCO.");
  command->add_option("images", options->images, "image files")->required();
  add_vision_options(command, options->vision);
  command->add_option("--out", options->out, "folder")->capture_default_str();
  command->add_option("--min-score", options->min_score, "plants below are left out")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = detect(*options); });
}

}  // namespace furrow::cli
