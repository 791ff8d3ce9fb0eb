#include "furrow_vision/dataset_conversion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "furrow_annotation/coco.hpp"
#include "furrow_annotation/mask.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/random.hpp"
#include "furrow_vision/image_file.hpp"

namespace furrow::vision {
namespace {

enum Part : std::size_t { kTrain, kValidation, kEvaluation };

/// Images by sequence, single ones on their own.
std::vector<std::vector<std::size_t>> groups_of(const Dataset& dataset) {
  std::vector<std::vector<std::size_t>> groups;
  std::map<std::string, std::size_t> group_of_sequence;
  for (std::size_t i = 0; i < dataset.images.size(); ++i) {
    const std::string& sequence = dataset.images[i].sequence;
    if (sequence.empty()) {
      groups.push_back({i});
      continue;
    }
    const auto [at, fresh] = group_of_sequence.emplace(sequence, groups.size());
    if (fresh) groups.emplace_back();
    groups[at->second].push_back(i);
  }
  return groups;
}

std::size_t share_of(double share, std::size_t whole, std::size_t left) {
  if (share <= 0.0) return 0;
  const auto wanted = static_cast<std::size_t>(std::llround(share * static_cast<double>(whole)));
  return std::min(std::max<std::size_t>(wanted, 1), left);
}

cv::Mat scaled_mask(const cv::Mat& mask, cv::Size size) {
  cv::Mat shares;
  cv::resize(mask, shares, size, 0.0, 0.0, cv::INTER_AREA);
  constexpr double kHalf = 127.5;
  return shares > kHalf;
}

/// COCO has no mask of vegetation: what no instance covers becomes a crowd region.
void add_vegetation_without_class(const SubClass& sub_class, AnnotatedImage& image) {
  if (image.vegetation.empty()) return;
  cv::Mat without = image.vegetation > 0;
  without.setTo(0, semantic_labels(image) > 0);
  AnnotatedInstance crowd;
  crowd.kind = sub_class.kind;
  crowd.category = sub_class.name;
  crowd.crowd = true;
  if (annotation::cut_to_box(without, crowd)) image.instances.push_back(std::move(crowd));
}

}  // namespace

void ConversionParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "scale",
           .description = "Of training and validation images",
           .min = 0.01,
           .max = 10.0},
          scale);
  v.visit({.name = "validation_share",
           .description = "Of the images that are not for evaluation",
           .min = 0.0,
           .max = 0.9},
          validation_share);
  v.visit({.name = "evaluation_share", .description = "Of all images", .min = 0.0, .max = 0.9},
          evaluation_share);
}

DatasetSplit split_dataset(const Dataset& dataset, const ConversionParameters& parameters,
                           std::uint64_t seed) {
  const auto groups = groups_of(dataset);
  std::vector<std::size_t> order(groups.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  Random random(seed, "dataset_split");
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1],
              order[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(i) - 1))]);
  }
  const std::size_t evaluation =
      share_of(parameters.evaluation_share, groups.size(), groups.size());
  const std::size_t rest = groups.size() - evaluation;
  const std::size_t validation =
      share_of(parameters.validation_share, rest, rest > 0 ? rest - 1 : 0);
  std::vector<Part> part_of(dataset.images.size(), kTrain);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Part part = i < evaluation                ? kEvaluation
                      : i < evaluation + validation ? kValidation
                                                    : kTrain;
    for (const std::size_t image : groups[order[i]]) part_of[image] = part;
  }
  DatasetSplit split;
  const std::array parts = {&split.train, &split.validation, &split.evaluation};
  for (Dataset* part : parts) {
    part->name = dataset.name;
    part->classes = dataset.classes;
    part->resolution_mm_per_px = dataset.resolution_mm_per_px;
  }
  for (std::size_t i = 0; i < dataset.images.size(); ++i) {
    parts[part_of[i]]->images.push_back(dataset.images[i]);
  }
  return split;
}

void scale_image(AnnotatedImage& image, double scale) {
  const cv::Size before = image.bgr.size();
  const cv::Size after(std::max(1, static_cast<int>(std::lround(before.width * scale))),
                       std::max(1, static_cast<int>(std::lround(before.height * scale))));
  if (after == before) return;
  cv::resize(image.bgr, image.bgr, after, 0.0, 0.0,
             scale < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
  const double scale_u = static_cast<double>(after.width) / before.width;
  const double scale_v = static_cast<double>(after.height) / before.height;
  std::vector<AnnotatedInstance> kept;
  for (AnnotatedInstance& instance : image.instances) {
    cv::Mat full = cv::Mat::zeros(before, CV_8U);
    instance.mask.copyTo(full(instance.box_px));
    if (!annotation::cut_to_box(scaled_mask(full, after), instance)) continue;
    if (instance.stem_px) {
      instance.stem_px = Eigen::Vector2d((instance.stem_px->x() + 0.5) * scale_u - 0.5,
                                         (instance.stem_px->y() + 0.5) * scale_v - 0.5);
    }
    kept.push_back(std::move(instance));
  }
  image.instances = std::move(kept);
  if (!image.vegetation.empty()) {
    cv::Mat whole = image.vegetation > 0;
    image.vegetation = scaled_mask(whole, after);
  }
  for (cv::Rect& box : image.ignore_boxes) {
    const cv::Rect2d scaled(box.x * scale_u, box.y * scale_v, box.width * scale_u,
                            box.height * scale_v);
    const cv::Point low(static_cast<int>(scaled.x), static_cast<int>(scaled.y));
    const cv::Point high(static_cast<int>(std::ceil(scaled.br().x)),
                         static_cast<int>(std::ceil(scaled.br().y)));
    box = cv::Rect(low, high) & cv::Rect(cv::Point(), after);
  }
  if (image.resolution_mm_per_px) *image.resolution_mm_per_px /= scale_u;
  image.width_px = after.width;
  image.height_px = after.height;
  image.depth_path.clear();
}

Status convert_dataset(const Dataset& dataset, const ConversionParameters& parameters,
                       std::uint64_t seed, const std::filesystem::path& folder,
                       const std::function<void(std::size_t)>& progress) {
  try {
    validate_parameters(parameters);
  } catch (const ConfigError& error) {
    return Error{ErrorCode::kOutOfRange, error.what()};
  }
  std::error_code failure;
  std::filesystem::create_directories(folder / "images", failure);
  if (failure) {
    return Error{ErrorCode::kIo,
                 folder.string() + ": cannot make the folder: " + failure.message()};
  }
  DatasetSplit split = split_dataset(dataset, parameters, seed);
  std::size_t done = 0;
  const auto write_part = [&](Dataset& part, const char* name, double scale,
                              bool evaluation) -> Status {
    if (part.resolution_mm_per_px) *part.resolution_mm_per_px /= scale;
    for (AnnotatedImage& image : part.images) {
      if (const Status loaded = load_pixels(image); !loaded.ok()) return loaded;
      scale_image(image, scale);
      if (evaluation && !part.classes.empty()) {
        add_vegetation_without_class(part.classes.back(), image);
      }
      // Images of several folders may share a name.
      image.path = folder / "images" /
                   (std::string(name) + "_" + std::to_string(done) + "_" +
                    image.path.stem().string() + ".png");
      if (const Status written = write_image(image.path, image.bgr); !written.ok()) return written;
      image.bgr.release();
      image.vegetation.release();
      progress(++done);
    }
    return annotation::write_coco(folder / (std::string(name) + ".json"), part);
  };
  if (const Status s = write_part(split.train, "train", parameters.scale, false); !s.ok()) return s;
  if (const Status s = write_part(split.validation, "validation", parameters.scale, false);
      !s.ok()) {
    return s;
  }
  return write_part(split.evaluation, "evaluation", 1.0, true);
}

}  // namespace furrow::vision
