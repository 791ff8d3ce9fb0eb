#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_map>

#include "coco_segmentation.hpp"
#include "file_names.hpp"
#include "furrow_annotation/coco.hpp"
#include "furrow_core/file.hpp"
#include "json_node.hpp"

namespace furrow::annotation {
namespace {

constexpr std::size_t kMaxAnnotations = 1'000'000;
constexpr std::int64_t kMaxMaskPixels = std::int64_t{1} << 31;
constexpr double kMaxResolution_mm = 1000.0;
constexpr std::int64_t kMaxTime_ns = std::numeric_limits<std::int64_t>::max();

/// A limit on the whole file that is exceeded.
struct TooLarge {
  std::string message;
};

struct Category {
  SubClass sub_class;
  bool kind_known = true;
  int stem_keypoint = -1;
};

std::optional<SubClassKind> kind_from(const std::string& word) {
  if (word == "crop") return SubClassKind::kCrop;
  if (word == "weed") return SubClassKind::kWeed;
  return std::nullopt;
}

Category read_category(const JsonNode& node, const CocoOptions& options) {
  Category category;
  category.sub_class.name = node.at("name").text();
  std::optional<SubClassKind> kind;
  const auto given = options.kinds.find(category.sub_class.name);
  if (given != options.kinds.end()) kind = given->second;
  if (!kind && node.has("supercategory")) kind = kind_from(node.at("supercategory").text());
  if (!kind) kind = kind_from(category.sub_class.name);
  category.kind_known = kind.has_value();
  category.sub_class.kind = kind.value_or(SubClassKind::kWeed);
  if (node.has("keypoints")) {
    const JsonNode keypoints = node.at("keypoints");
    for (std::size_t k = 0; k < keypoints.size(); ++k) {
      if (keypoints.entry(k).text() == "stem") category.stem_keypoint = static_cast<int>(k);
    }
  }
  return category;
}

std::optional<double> read_resolution(const JsonNode& node) {
  if (!node.has("resolution_mm_per_px")) return std::nullopt;
  const JsonNode resolution = node.at("resolution_mm_per_px");
  const double value = resolution.number();
  if (!(value > 0.0 && value <= kMaxResolution_mm)) {
    throw Malformed{resolution.key(), "is not in (0, 1000] mm"};
  }
  return value;
}

std::filesystem::path read_name(const JsonNode& node, const std::filesystem::path& folder) {
  std::filesystem::path name = node.at("file_name").text();
  if (node.has("file_name_percent")) {
    const JsonNode encoded = node.at("file_name_percent");
    const auto bytes = percent_decoded(encoded.text());
    if (!bytes) throw Malformed{encoded.key(), "a % is not followed by two hexadecimal digits"};
    name = *bytes;
  }
  return name.is_absolute() ? name : folder / name;
}

void read_capture(const JsonNode& node, AnnotatedImage& image) {
  if (node.has("pose")) {
    const JsonNode pose = node.at("pose");
    if (pose.size() != 3) throw Malformed{pose.key(), "is not [x_m, y_m, heading_rad]"};
    image.X_FB =
        geometry::Pose2{pose.entry(0).number(), pose.entry(1).number(), pose.entry(2).number()};
  }
  if (node.has("velocity_mps")) image.velocity_mps = node.at("velocity_mps").number();
  if (node.has("stamp_ns")) {
    image.stamp = Time::from_nanoseconds(node.at("stamp_ns").integer(-kMaxTime_ns, kMaxTime_ns));
  }
  if (node.has("sequence")) image.sequence = node.at("sequence").text();
  if (node.has("labelled")) image.labelled = node.at("labelled").truth();
}

AnnotatedImage read_image(const JsonNode& node, const std::filesystem::path& folder) {
  AnnotatedImage image;
  image.path = read_name(node, folder);
  image.width_px = static_cast<int>(node.at("width").integer(1, kMaxImageSide_px));
  image.height_px = static_cast<int>(node.at("height").integer(1, kMaxImageSide_px));
  if (static_cast<std::int64_t>(image.width_px) * image.height_px > kMaxImageArea_px) {
    throw Malformed{node.key(), "is an image larger than allowed"};
  }
  if (node.has("depth_file_name")) image.depth_path = folder / node.at("depth_file_name").text();
  image.resolution_mm_per_px = read_resolution(node);
  if (node.has("ignore_boxes")) {
    const JsonNode boxes = node.at("ignore_boxes");
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const cv::Rect box = read_box(boxes.entry(i), {image.width_px, image.height_px});
      if (!box.empty()) image.ignore_boxes.push_back(box);
    }
  }
  read_capture(node, image);
  return image;
}

std::optional<Eigen::Vector2d> read_stem(const JsonNode& node, const Category& category) {
  if (!node.has("keypoints") || category.stem_keypoint < 0) return std::nullopt;
  const JsonNode keypoints = node.at("keypoints");
  const auto at = 3 * static_cast<std::size_t>(category.stem_keypoint);
  if (keypoints.size() < at + 3) {
    throw Malformed{keypoints.key(), "fewer keypoints than the category names"};
  }
  if (keypoints.entry(at + 2).integer(0, 2) == 0) return std::nullopt;
  return Eigen::Vector2d(keypoints.entry(at).number(), keypoints.entry(at + 1).number());
}

/// Reads one file into a data set.
class CocoReader {
 public:
  CocoReader(std::filesystem::path folder, const CocoOptions& options)
      : folder_(std::move(folder)), options_(options) {}

  Dataset read(const JsonNode& root) {
    read_header(root);
    read_categories(root.at("categories"));
    read_images(root.at("images"));
    const JsonNode annotations = root.at("annotations");
    dataset_.report.annotations = annotations.size();
    if (annotations.size() > kMaxAnnotations) {
      throw TooLarge{"more than 1000000 annotations; split the file"};
    }
    for (std::size_t i = 0; i < annotations.size(); ++i) {
      try {
        read_annotation(annotations.entry(i));
      } catch (const Malformed& bad) {
        if (options_.strict) throw;
        dataset_.report.skip(bad.message, bad.key);
      }
    }
    return std::move(dataset_);
  }

  /// Categories in use that are neither crop nor weed.
  [[nodiscard]] const std::set<std::string>& unknown_kinds() const { return unknown_kinds_; }

 private:
  void read_header(const JsonNode& root) {
    dataset_.resolution_mm_per_px = read_resolution(root);
    if (!root.has("info")) return;
    const JsonNode info = root.at("info");
    if (info.has("description")) dataset_.name = info.at("description").text();
    if (!dataset_.resolution_mm_per_px) dataset_.resolution_mm_per_px = read_resolution(info);
  }

  void read_categories(const JsonNode& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const JsonNode node = list.entry(i);
      Category category = read_category(node, options_);
      dataset_.classes.push_back(category.sub_class);
      if (!categories_.emplace(node.at("id").id(), std::move(category)).second) {
        throw Malformed{node.key() + ".id", "is given twice"};
      }
    }
  }

  void read_images(const JsonNode& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const JsonNode node = list.entry(i);
      if (!image_of_id_.emplace(node.at("id").id(), i).second) {
        throw Malformed{node.key() + ".id", "is given twice"};
      }
      AnnotatedImage image = read_image(node, folder_);
      if (!image.resolution_mm_per_px) image.resolution_mm_per_px = dataset_.resolution_mm_per_px;
      dataset_.images.push_back(std::move(image));
    }
  }

  void read_annotation(const JsonNode& node) {
    const JsonNode image_id = node.at("image_id");
    const auto image_at = image_of_id_.find(image_id.id());
    if (image_at == image_of_id_.end()) throw Malformed{image_id.key(), "names no image"};
    AnnotatedImage& image = dataset_.images[image_at->second];
    const JsonNode category_id = node.at("category_id");
    const auto category = categories_.find(category_id.id());
    if (category == categories_.end()) throw Malformed{category_id.key(), "names no category"};
    AnnotatedInstance instance =
        read_instance(node, category->second, {image.width_px, image.height_px});
    if (!instance.crowd && !category->second.kind_known) {
      unknown_kinds_.insert(category->second.sub_class.name);
    }
    if (instance.crowd) ++dataset_.report.ignore_regions;
    if (instance.box_only) ++dataset_.report.box_only;
    if (node.has("keypoints") && category->second.stem_keypoint < 0) {
      ++dataset_.report.without_stem_keypoint;
    }
    image.instances.push_back(std::move(instance));
  }

  AnnotatedInstance read_instance(const JsonNode& node, const Category& category, cv::Size size) {
    AnnotatedInstance instance;
    instance.kind = category.sub_class.kind;
    instance.category = category.sub_class.name;
    instance.crowd = node.has("iscrowd") && node.at("iscrowd").truth();
    instance.stem_px = read_stem(node, category);
    if (node.has("area_mm2")) instance.area_mm2 = node.at("area_mm2").number();
    if (node.has("score")) instance.score = node.at("score").number();
    Segmentation segmentation =
        read_segmentation(node, size, options_.strict ? nullptr : &dataset_.report);
    instance.box_px = segmentation.mask.box_px;
    instance.mask = std::move(segmentation.mask.pixels);
    instance.box_only = segmentation.box_only;
    if (node.has("attributes")) {  // of any kind: other tools have attributes of their own
      const JsonNode attributes = node.at("attributes");
      instance.truncated = attributes.is_true("truncated");
      instance.box_only |= attributes.is_text("mask", "box");
    }
    mask_pixels_ += instance.box_px.area();
    if (mask_pixels_ > kMaxMaskPixels) throw TooLarge{"masks of more than 2^31 pixels in all"};
    return instance;
  }

  std::filesystem::path folder_;
  const CocoOptions& options_;
  std::unordered_map<std::int64_t, Category> categories_;
  std::unordered_map<std::int64_t, std::size_t> image_of_id_;
  std::set<std::string> unknown_kinds_;
  std::int64_t mask_pixels_ = 0;
  Dataset dataset_;
};

Result<Dataset> read_root(const nlohmann::json& root, const std::filesystem::path& file,
                          const CocoOptions& options) {
  CocoReader reader(file.parent_path(), options);
  Dataset dataset = reader.read(JsonNode(root, ""));
  const std::set<std::string>& unknown = reader.unknown_kinds();
  if (!unknown.empty() && options.unknown_kind == UnknownKind::kRefuse) {
    std::string names;
    for (const std::string& name : unknown) names += (names.empty() ? "'" : ", '") + name + "'";
    return Error{ErrorCode::kNotFound, file.string() + ": categories: it is not said whether " +
                                           names + " is a crop or a weed"};
  }
  dataset.report.assumed_weeds.assign(unknown.begin(), unknown.end());
  return dataset;
}

}  // namespace

Result<Dataset> read_coco(const std::filesystem::path& file, const CocoOptions& options) {
  const auto text = read_file(file);
  if (!text) return text.error();
  try {
    return read_root(nlohmann::json::parse(*text), file, options);
  } catch (const nlohmann::json::exception& failure) {
    return Error{ErrorCode::kParse, file.string() + ": " + failure.what()};
  } catch (const Malformed& bad) {
    return Error{ErrorCode::kParse, file.string() + ": " + bad.key + ": " + bad.message};
  } catch (const TooLarge& limit) {
    return Error{ErrorCode::kOutOfRange, file.string() + ": " + limit.message};
  }
}

}  // namespace furrow::annotation
