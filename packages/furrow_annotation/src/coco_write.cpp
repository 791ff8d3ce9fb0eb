#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "file_names.hpp"
#include "furrow_annotation/coco.hpp"
#include "furrow_annotation/run_lengths.hpp"
#include "furrow_core/file.hpp"
#include "furrow_core/utf8.hpp"

namespace furrow::annotation {
namespace {

using Json = nlohmann::ordered_json;

void add_name(const std::string& name, Json& json) {
  json["file_name"] = with_valid_utf8(name);
  if (!is_utf8(name)) json["file_name_percent"] = percent_encoded(name);
}

/// `resolution_mm` is that of the whole data set, which an image need not repeat.
Json image_json(const AnnotatedImage& image, std::size_t id, const std::filesystem::path& folder,
                const std::optional<double>& resolution_mm) {
  Json json = {{"id", id}};
  add_name(relative_to(image.path, folder), json);
  json["width"] = image.width_px;
  json["height"] = image.height_px;
  if (!image.depth_path.empty()) {
    json["depth_file_name"] = with_valid_utf8(relative_to(image.depth_path, folder));
  }
  if (image.resolution_mm_per_px != resolution_mm && image.resolution_mm_per_px) {
    json["resolution_mm_per_px"] = *image.resolution_mm_per_px;
  }
  for (const cv::Rect& box : image.ignore_boxes) {
    json["ignore_boxes"].push_back({box.x, box.y, box.width, box.height});
  }
  if (image.X_FB) json["pose"] = {image.X_FB->x_m, image.X_FB->y_m, image.X_FB->heading_rad};
  if (image.velocity_mps) json["velocity_mps"] = *image.velocity_mps;
  if (image.stamp) json["stamp_ns"] = image.stamp->count_ns();
  if (!image.sequence.empty()) json["sequence"] = image.sequence;
  if (!image.labelled) json["labelled"] = false;
  return json;
}

Json annotation_json(const AnnotatedInstance& instance, cv::Size size) {
  cv::Mat full = cv::Mat::zeros(size, CV_8U);
  instance.mask.copyTo(full(instance.box_px));
  const cv::Rect& box = instance.box_px;
  Json json = {{"bbox", {box.x, box.y, box.width, box.height}},
               {"area", cv::countNonZero(instance.mask)},
               {"iscrowd", instance.crowd ? 1 : 0},
               {"segmentation",
                {{"size", {size.height, size.width}},
                 {"counts", compress_run_lengths(encode_run_lengths(full))}}}};
  if (instance.stem_px) {
    json["keypoints"] = {instance.stem_px->x(), instance.stem_px->y(), 2};
    json["num_keypoints"] = 1;
  }
  if (instance.area_mm2) json["area_mm2"] = *instance.area_mm2;
  if (instance.score) json["score"] = *instance.score;
  if (instance.truncated) json["attributes"]["truncated"] = true;
  if (instance.box_only) json["attributes"]["mask"] = "box";
  return json;
}

bool fits(const AnnotatedInstance& instance, cv::Size size) {
  return !instance.box_px.empty() &&
         (instance.box_px & cv::Rect(cv::Point(), size)) == instance.box_px &&
         instance.mask.type() == CV_8U && instance.mask.size() == instance.box_px.size();
}

/// Ids by name; kInvalidArgument when a name stands twice.
Result<std::map<std::string, std::size_t>> add_categories(const std::vector<SubClass>& classes,
                                                          Json& list) {
  std::map<std::string, std::size_t> ids;
  for (const SubClass& sub_class : classes) {
    const std::size_t id = ids.size() + 1;
    if (!ids.emplace(sub_class.name, id).second) {
      return Error{ErrorCode::kInvalidArgument, "category '" + sub_class.name + "' stands twice"};
    }
    list.push_back({{"id", id},
                    {"name", sub_class.name},
                    {"supercategory", sub_class.kind == SubClassKind::kCrop ? "crop" : "weed"},
                    {"keypoints", {"stem"}},
                    {"skeleton", Json::array()}});
  }
  return ids;
}

Status add_annotations(const AnnotatedImage& image, std::size_t image_id,
                       const std::map<std::string, std::size_t>& category_ids, Json& list) {
  const cv::Size size(image.width_px, image.height_px);
  for (const AnnotatedInstance& instance : image.instances) {
    const auto category = category_ids.find(instance.category);
    if (category == category_ids.end()) {
      return Error{ErrorCode::kInvalidArgument,
                   "category '" + instance.category + "' is not in the class list"};
    }
    if (!fits(instance, size)) {
      return Error{ErrorCode::kInvalidArgument,
                   image.path.string() + ": an instance's box or mask does not fit the image"};
    }
    Json json = {
        {"id", list.size() + 1}, {"image_id", image_id}, {"category_id", category->second}};
    json.update(annotation_json(instance, size));
    list.push_back(std::move(json));
  }
  return {};
}

}  // namespace

Status write_coco(const std::filesystem::path& file, const Dataset& dataset) {
  Json root = {{"info", {{"description", with_valid_utf8(dataset.name)}}},
               {"images", Json::array()},
               {"annotations", Json::array()},
               {"categories", Json::array()}};
  if (dataset.resolution_mm_per_px) root["resolution_mm_per_px"] = *dataset.resolution_mm_per_px;
  const auto category_ids = add_categories(dataset.classes, root["categories"]);
  if (!category_ids) return category_ids.error();
  for (std::size_t i = 0; i < dataset.images.size(); ++i) {
    root["images"].push_back(
        image_json(dataset.images[i], i + 1, file.parent_path(), dataset.resolution_mm_per_px));
    const Status added =
        add_annotations(dataset.images[i], i + 1, *category_ids, root["annotations"]);
    if (!added.ok()) return added;
  }
  try {
    return write_file_atomically(file, root.dump(1));
  } catch (const Json::exception& failure) {  // a category that is not UTF-8
    return Error{ErrorCode::kInvalidArgument, file.string() + ": " + failure.what()};
  }
}

}  // namespace furrow::annotation
