#include "furrow_vision/annotated_image.hpp"

#include <algorithm>

#include "furrow_core/file.hpp"
#include "furrow_vision/image_file.hpp"

namespace furrow::vision {
namespace {

/// The decoder fills what a truncated JPEG lacks with grey. Its end mark is missing then; one in
/// the first half is that of a preview.
bool is_truncated_jpeg(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  if (!bytes.ok() || !bytes->starts_with("\xFF\xD8")) return false;
  return bytes->find("\xFF\xD9", bytes->size() / 2) == std::string::npos;
}

}  // namespace

Status load_pixels(AnnotatedImage& image) {
  const std::string file = image.path.string();
  auto read = read_image(image.path, ImageChannels::kColour);
  if (!read.ok()) return read.error();
  cv::Mat bgr = std::move(read).value();
  if (is_truncated_jpeg(image.path)) {
    return Error{ErrorCode::kParse, file + ": not an image, or a truncated one"};
  }
  if (image.width_px > 0 && bgr.size() != cv::Size(image.width_px, image.height_px)) {
    return Error{ErrorCode::kParse, file + ": is " + std::to_string(bgr.cols) + "x" +
                                        std::to_string(bgr.rows) + ", annotated as " +
                                        std::to_string(image.width_px) + "x" +
                                        std::to_string(image.height_px)};
  }
  image.width_px = bgr.cols;
  image.height_px = bgr.rows;
  image.bgr = std::move(bgr);
  return {};
}

cv::Mat semantic_labels(const AnnotatedImage& image) {
  cv::Mat labels = cv::Mat::zeros(image.height_px, image.width_px, CV_8U);
  for (const AnnotatedInstance& instance : image.instances) {
    labels(instance.box_px).setTo(instance.kind == SubClassKind::kCrop ? 2 : 1, instance.mask);
  }
  return labels;
}

std::vector<AnnotatedInstance> to_annotations(const std::vector<Instance>& instances,
                                              const std::vector<SubClass>& classes) {
  std::vector<AnnotatedInstance> annotations;
  for (const Instance& instance : instances) {
    const auto best = std::max_element(instance.class_scores.begin(), instance.class_scores.end());
    const SubClass& sub_class = classes.at(best - instance.class_scores.begin());
    annotations.push_back({.kind = sub_class.kind,
                           .category = sub_class.name,
                           .box_px = instance.box_px,
                           .mask = instance.mask,
                           .stem_px = instance.stem_px,
                           .area_mm2 = instance.area_mm2,
                           .score = instance.score * *best});
  }
  return annotations;
}

}  // namespace furrow::vision
