#include "furrow_evaluation/image_detection.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "furrow_annotation/coco.hpp"
#include "furrow_evaluation/loaded_image.hpp"
#include "furrow_vision/annotated_image.hpp"
#include "furrow_vision/image_file.hpp"
#include "furrow_vision/overlay.hpp"

namespace furrow::evaluation {
namespace {

namespace fs = std::filesystem;

/// One file has one such path, however it was named.
fs::path identity_of(const fs::path& file) {
  std::error_code failure;
  const fs::path path = fs::weakly_canonical(file, failure);
  return failure ? fs::absolute(file) : path;
}

void require(const Status& status) {
  if (!status.ok()) throw std::runtime_error(status.error().message);
}

/// The plants of one image, or what is wrong with it.
Result<std::vector<vision::Instance>> detect(vision::Detector& detector,
                                             const ImageDetection& detection,
                                             annotation::AnnotatedImage& image) {
  const auto loaded = load_image(image, detection.resolution_mm_per_px);
  detector.reset();                         // single images are no sequence
  if (!loaded.ok()) return loaded.error();  // names the file
  auto plants = detector.detect(loaded->view());
  if (!plants.ok()) {
    return Error{plants.error().code, image.path.string() + ": " + plants.error().message};
  }
  std::erase_if(*plants, [&](const auto& plant) { return plant.score < detection.min_score; });
  return plants;
}

DetectedImage draw(const annotation::AnnotatedImage& image,
                   const std::vector<vision::Instance>& plants,
                   const std::vector<annotation::SubClass>& classes, const fs::path& file) {
  cv::Mat picture = image.bgr.clone();
  vision::draw_instances(plants, classes, true, picture);
  require(vision::write_image(file, picture));
  const auto crops = std::ranges::count_if(
      plants, [](const auto& plant) { return plant.crop_probability >= 0.5; });
  return {.picture = file, .plants = plants.size(), .crops = static_cast<std::size_t>(crops)};
}

}  // namespace

fs::path picture_path(const fs::path& folder, const fs::path& image,
                      const std::vector<fs::path>& taken, Overwrite overwrite) {
  const std::string stem = image.stem().string();
  for (int number = 1;; ++number) {
    const std::string suffix = number == 1 ? "" : "-" + std::to_string(number);
    const fs::path path = folder / (stem + suffix + ".png");
    if (std::ranges::find(taken, identity_of(path)) != taken.end()) continue;
    if (overwrite == Overwrite::kYes || !fs::exists(fs::symlink_status(path))) return path;
  }
}

ImageDetectionResult detect_images(const NamedDetector& named, const ImageDetection& detection) {
  vision::Detector& detector = *named.detector;
  annotation::Dataset found{
      .name = "detections of " + named.name, .classes = detector.classes(), .images = {}};
  ImageDetectionResult result;
  std::vector<fs::path> taken;
  for (const fs::path& image : detection.images) taken.push_back(identity_of(image));
  for (const fs::path& path : detection.images) {
    annotation::AnnotatedImage image;
    image.path = path;
    const auto plants = detect(detector, detection, image);
    if (!plants.ok()) {
      result.faults.push_back(plants.error().message);
      continue;
    }
    const fs::path file = picture_path(detection.folder, path, taken, detection.overwrite);
    taken.push_back(identity_of(file));
    result.images.push_back(draw(image, *plants, detector.classes(), file));
    image.path = fs::absolute(image.path);
    image.width_px = image.bgr.cols;
    image.height_px = image.bgr.rows;
    image.instances = vision::to_annotations(*plants, detector.classes());
    image.bgr.release();
    found.images.push_back(std::move(image));
  }
  result.json = detection.folder / "detections.json";
  require(annotation::write_coco(result.json, found));
  return result;
}

}  // namespace furrow::evaluation
