#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "dataset_common.hpp"
#include "furrow_core/file.hpp"
#include "furrow_vision/coco_rle.hpp"
#include "furrow_vision/dataset_coco.hpp"

namespace furrow::vision {
namespace {

using Json = nlohmann::json;

/// A malformed file, on its way to the Error that names it.
struct Malformed {
  std::string key;
  std::string message;
};

/// A JSON value and the key under which it stands.
class Node {
 public:
  Node(const Json& json, std::string key) : json_(json), key_(std::move(key)) {}

  [[nodiscard]] bool has(const char* name) const {
    return json_.is_object() && json_.contains(name) && !json_.at(name).is_null();
  }
  [[nodiscard]] Node at(const char* name) const {
    if (!has(name)) throw Malformed{path(name), "is missing"};
    return {json_.at(name), path(name)};
  }
  [[nodiscard]] Node entry(std::size_t i) const {
    return {json_.at(i), key_ + "[" + std::to_string(i) + "]"};
  }
  /// The length of a list.
  [[nodiscard]] std::size_t size() const {
    if (!json_.is_array()) throw Malformed{key_, "is not a list"};
    return json_.size();
  }
  [[nodiscard]] double number() const {
    if (!json_.is_number()) throw Malformed{key_, "is not a number"};
    return json_.get<double>();
  }
  [[nodiscard]] std::int64_t integer(std::int64_t low, std::int64_t high) const {
    if (!json_.is_number_integer()) throw Malformed{key_, "is not an integer"};
    const auto value = json_.get<std::int64_t>();
    if (value < low || value > high) throw Malformed{key_, "is out of range"};
    return value;
  }
  [[nodiscard]] std::string text() const {
    if (!json_.is_string()) throw Malformed{key_, "is not a string"};
    return json_.get<std::string>();
  }
  [[nodiscard]] bool truth() const {
    if (json_.is_boolean()) return json_.get<bool>();
    return integer(0, 1) == 1;
  }
  [[nodiscard]] bool is_array() const { return json_.is_array(); }
  [[nodiscard]] bool is_string() const { return json_.is_string(); }
  [[nodiscard]] const std::string& key() const { return key_; }

 private:
  [[nodiscard]] std::string path(const char* name) const {
    return key_.empty() ? name : key_ + "." + name;
  }
  const Json& json_;
  std::string key_;
};

constexpr std::int64_t kMaxInteger = std::numeric_limits<std::int64_t>::max();

struct Category {
  SubClass sub_class;
  int stem_keypoint = -1;
};

cv::Mat read_polygons(const Node& node, cv::Size size) {
  constexpr int kShift = 8;  // fractional bits of fillPoly
  std::vector<std::vector<cv::Point>> polygons;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const Node corners = node.entry(i);
    if (corners.size() < 6 || corners.size() % 2 != 0) {
      throw Malformed{corners.key(), "is not a polygon of at least three corners"};
    }
    std::vector<cv::Point>& polygon = polygons.emplace_back();
    for (std::size_t k = 0; k < corners.size(); k += 2) {
      // COCO counts from the corner of the upper left pixel, fillPoly from its centre.
      const double u = std::clamp(corners.entry(k).number(), 0.0, double(size.width)) - 0.5;
      const double v = std::clamp(corners.entry(k + 1).number(), 0.0, double(size.height)) - 0.5;
      polygon.emplace_back(static_cast<int>(std::lround(u * (1 << kShift))),
                           static_cast<int>(std::lround(v * (1 << kShift))));
    }
  }
  cv::Mat mask = cv::Mat::zeros(size, CV_8U);
  for (const auto& polygon : polygons) {
    cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{polygon}, 255, cv::LINE_8, kShift);
  }
  return mask;
}

cv::Mat read_runs(const Node& node, cv::Size size) {
  const Node given = node.at("size");
  if (given.size() != 2 || given.entry(0).integer(1, kMaxImageSide_px) != size.height ||
      given.entry(1).integer(1, kMaxImageSide_px) != size.width) {
    throw Malformed{given.key(), "is not the image's [height, width]"};
  }
  const Node counts = node.at("counts");
  RunLengths runs;
  if (counts.is_string()) {
    auto decompressed = decompress_run_lengths(counts.text());
    if (!decompressed) throw Malformed{counts.key(), decompressed.error().message};
    runs = std::move(*decompressed);
  } else {
    for (std::size_t i = 0; i < counts.size(); ++i) {
      runs.push_back(static_cast<std::uint32_t>(counts.entry(i).integer(0, kMaxImageArea_px)));
    }
  }
  auto mask = decode_run_lengths(runs, size);
  if (!mask) throw Malformed{counts.key(), mask.error().message};
  return std::move(*mask);
}

std::map<std::int64_t, Category> read_categories(const Node& list, Dataset& dataset) {
  std::map<std::int64_t, Category> categories;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Node node = list.entry(i);
    Category category;
    category.sub_class.name = node.at("name").text();
    const bool crop = node.has("supercategory") && node.at("supercategory").text() == "crop";
    category.sub_class.kind = crop ? SubClassKind::kCrop : SubClassKind::kWeed;
    if (node.has("keypoints")) {
      const Node keypoints = node.at("keypoints");
      for (std::size_t k = 0; k < keypoints.size(); ++k) {
        if (keypoints.entry(k).text() == "stem") category.stem_keypoint = static_cast<int>(k);
      }
    }
    const std::int64_t id = node.at("id").integer(0, kMaxInteger);
    dataset.classes.push_back(category.sub_class);
    if (!categories.emplace(id, std::move(category)).second) {
      throw Malformed{node.key() + ".id", "is given twice"};
    }
  }
  return categories;
}

AnnotatedImage read_image(const Node& node, const std::filesystem::path& folder) {
  AnnotatedImage image;
  const std::filesystem::path name = node.at("file_name").text();
  image.path = name.is_absolute() ? name : folder / name;
  image.width_px = static_cast<int>(node.at("width").integer(1, kMaxImageSide_px));
  image.height_px = static_cast<int>(node.at("height").integer(1, kMaxImageSide_px));
  if (static_cast<std::int64_t>(image.width_px) * image.height_px > kMaxImageArea_px) {
    throw Malformed{node.key(), "is an image larger than allowed"};
  }
  if (node.has("depth_file_name")) image.depth_path = folder / node.at("depth_file_name").text();
  if (node.has("pose")) {
    const Node pose = node.at("pose");
    if (pose.size() != 3) throw Malformed{pose.key(), "is not [x_m, y_m, heading_rad]"};
    image.X_FB =
        geometry::Pose2{pose.entry(0).number(), pose.entry(1).number(), pose.entry(2).number()};
  }
  if (node.has("velocity_mps")) image.velocity_mps = node.at("velocity_mps").number();
  if (node.has("stamp_ns")) {
    image.stamp = Time::from_nanoseconds(node.at("stamp_ns").integer(-kMaxInteger, kMaxInteger));
  }
  if (node.has("sequence")) image.sequence = node.at("sequence").text();
  if (node.has("labelled")) image.labelled = node.at("labelled").truth();
  return image;
}

void read_instance(const Node& node, const std::map<std::int64_t, Category>& categories,
                   AnnotatedImage& image) {
  const Node category_id = node.at("category_id");
  const auto found = categories.find(category_id.integer(0, kMaxInteger));
  if (found == categories.end()) throw Malformed{category_id.key(), "names no category"};
  const cv::Size size(image.width_px, image.height_px);
  const Node segmentation = node.at("segmentation");
  AnnotatedInstance instance;
  if (!cut_to_box(segmentation.is_array() ? read_polygons(segmentation, size)
                                          : read_runs(segmentation, size),
                  instance)) {
    throw Malformed{segmentation.key(), "holds no pixel of the image"};
  }
  instance.kind = found->second.sub_class.kind;
  instance.category = found->second.sub_class.name;
  instance.crowd = node.has("iscrowd") && node.at("iscrowd").truth();
  if (node.has("keypoints") && found->second.stem_keypoint >= 0) {
    const Node keypoints = node.at("keypoints");
    const auto at = 3 * static_cast<std::size_t>(found->second.stem_keypoint);
    if (keypoints.size() < at + 3) throw Malformed{keypoints.key(), "is shorter than its category"};
    if (keypoints.entry(at + 2).integer(0, 2) > 0) {
      instance.stem_px = {keypoints.entry(at).number(), keypoints.entry(at + 1).number()};
    }
  }
  if (node.has("area_mm2")) instance.area_mm2 = node.at("area_mm2").number();
  if (node.has("score")) instance.score = node.at("score").number();
  image.instances.push_back(std::move(instance));
}

Dataset read_root(const Node& root, const std::filesystem::path& folder) {
  Dataset dataset;
  if (root.has("info") && root.at("info").has("description")) {
    dataset.name = root.at("info").at("description").text();
  }
  const auto categories = read_categories(root.at("categories"), dataset);
  std::map<std::int64_t, std::size_t> image_of_id;
  const Node images = root.at("images");
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::int64_t id = images.entry(i).at("id").integer(0, kMaxInteger);
    if (!image_of_id.emplace(id, i).second) {
      throw Malformed{images.entry(i).key() + ".id", "is given twice"};
    }
    dataset.images.push_back(read_image(images.entry(i), folder));
  }
  const Node annotations = root.at("annotations");
  for (std::size_t i = 0; i < annotations.size(); ++i) {
    const Node image_id = annotations.entry(i).at("image_id");
    const auto found = image_of_id.find(image_id.integer(0, kMaxInteger));
    if (found == image_of_id.end()) throw Malformed{image_id.key(), "names no image"};
    read_instance(annotations.entry(i), categories, dataset.images[found->second]);
  }
  return dataset;
}

}  // namespace

Result<Dataset> read_coco(const std::filesystem::path& file) {
  const auto text = read_file(file);
  if (!text) return text.error();
  Json root;
  try {
    root = Json::parse(*text);
    return read_root(Node(root, ""), file.parent_path());
  } catch (const Json::exception& failure) {
    return Error{ErrorCode::kParse, file.string() + ": " + failure.what()};
  } catch (const Malformed& failure) {
    return Error{ErrorCode::kParse, file.string() + ": " + failure.key + ": " + failure.message};
  }
}

}  // namespace furrow::vision
