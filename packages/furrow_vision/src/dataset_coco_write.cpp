#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "furrow_core/file.hpp"
#include "furrow_vision/coco_rle.hpp"
#include "furrow_vision/dataset_coco.hpp"

namespace furrow::vision {
namespace {

using Json = nlohmann::ordered_json;

std::string relative_to(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const auto relative = path.lexically_normal().lexically_relative(folder.lexically_normal());
  if (relative.empty() || *relative.begin() == "..") return path.string();
  return relative.string();
}

Json image_json(const AnnotatedImage& image, std::size_t id, const std::filesystem::path& folder) {
  Json json = {{"id", id},
               {"file_name", relative_to(image.path, folder)},
               {"width", image.width_px},
               {"height", image.height_px}};
  if (!image.depth_path.empty()) json["depth_file_name"] = relative_to(image.depth_path, folder);
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
  return json;
}

}  // namespace

Status write_coco(const std::filesystem::path& file, const Dataset& dataset) {
  Json root = {{"info", {{"description", dataset.name}}},
               {"images", Json::array()},
               {"annotations", Json::array()},
               {"categories", Json::array()}};
  std::map<std::string, std::size_t> category_ids;
  for (const SubClass& sub_class : dataset.classes) {
    const std::size_t id = category_ids.size() + 1;
    if (!category_ids.emplace(sub_class.name, id).second) {
      return Error{ErrorCode::kInvalidArgument, "category '" + sub_class.name + "' stands twice"};
    }
    root["categories"].push_back(
        {{"id", id},
         {"name", sub_class.name},
         {"supercategory", sub_class.kind == SubClassKind::kCrop ? "crop" : "weed"},
         {"keypoints", {"stem"}},
         {"skeleton", Json::array()}});
  }
  const std::filesystem::path folder = file.parent_path();
  for (std::size_t i = 0; i < dataset.images.size(); ++i) {
    const AnnotatedImage& image = dataset.images[i];
    root["images"].push_back(image_json(image, i + 1, folder));
    const cv::Size size(image.width_px, image.height_px);
    for (const AnnotatedInstance& instance : image.instances) {
      const auto category = category_ids.find(instance.category);
      if (category == category_ids.end()) {
        return Error{ErrorCode::kInvalidArgument,
                     "category '" + instance.category + "' is not in the class list"};
      }
      const bool inside = !instance.box_px.empty() &&
                          (instance.box_px & cv::Rect(cv::Point(), size)) == instance.box_px &&
                          instance.mask.type() == CV_8U &&
                          instance.mask.size() == instance.box_px.size();
      if (!inside) {
        return Error{ErrorCode::kInvalidArgument,
                     image.path.string() + ": an instance's box or mask does not fit the image"};
      }
      Json json = {{"id", root["annotations"].size() + 1},
                   {"image_id", i + 1},
                   {"category_id", category->second}};
      json.update(annotation_json(instance, size));
      root["annotations"].push_back(std::move(json));
    }
  }
  try {
    return write_file_atomically(file, root.dump(1));
  } catch (const Json::exception& failure) {  // a name that is not UTF-8
    return Error{ErrorCode::kInvalidArgument, file.string() + ": " + failure.what()};
  }
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
