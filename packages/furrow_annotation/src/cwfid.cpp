#include "furrow_annotation/cwfid.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "folder_listing.hpp"
#include "furrow_annotation/mask.hpp"
#include "furrow_core/file.hpp"
#include "json_node.hpp"

namespace furrow::annotation {
namespace {

std::vector<double> numbers(const YAML::Node& node, const std::string& key) {
  std::vector<double> values;
  if (!node) throw Malformed{key, "is missing"};
  try {
    if (node.IsSequence()) {
      for (const auto& entry : node) values.push_back(entry.as<double>());
    } else {
      values.push_back(node.as<double>());
    }
  } catch (const YAML::Exception&) {
    throw Malformed{key, "an entry is not a number"};
  }
  for (const double value : values) {
    if (!std::isfinite(value)) throw Malformed{key, "an entry is not finite"};
  }
  return values;
}

std::vector<cv::Point> polygon(const YAML::Node& points, cv::Size size, const std::string& key) {
  if (!points || !points.IsMap()) throw Malformed{key, "is missing, or not a map of x and y"};
  const auto x = numbers(points["x"], key + ".x");
  const auto y = numbers(points["y"], key + ".y");
  if (x.size() != y.size() || x.empty()) throw Malformed{key, "x and y differ in length"};
  std::vector<cv::Point> corners;
  for (std::size_t i = 0; i < x.size(); ++i) {
    corners.emplace_back(
        static_cast<int>(std::lround(std::clamp(x[i], -1.0, static_cast<double>(size.width)))),
        static_cast<int>(std::lround(std::clamp(y[i], -1.0, static_cast<double>(size.height)))));
  }
  return corners;
}

/// Fewer than three corners enclose nothing: they stand for the pieces of vegetation that they hit.
cv::Mat region(const std::vector<cv::Point>& corners, const cv::Mat& vegetation) {
  cv::Mat filled = cv::Mat::zeros(vegetation.size(), CV_8U);
  if (corners.size() >= 3) {
    cv::fillPoly(filled, std::vector<std::vector<cv::Point>>{corners}, 255);
    return filled & vegetation;
  }
  cv::Mat labels;
  cv::connectedComponents(vegetation, labels, 8, CV_32S);
  for (const cv::Point& corner : corners) {
    if (!cv::Rect(cv::Point(), vegetation.size()).contains(corner)) continue;
    const int label = labels.at<int>(corner);
    if (label != 0) filled |= labels == label;
  }
  return filled;
}

AnnotatedInstance read_instance(const YAML::Node& node, const std::string& key,
                                const cv::Mat& vegetation) {
  if (!node.IsMap()) throw Malformed{key, "is not a map"};
  const auto& type = node["type"];
  if (!type || !type.IsScalar()) throw Malformed{key + ".type", "is missing"};
  AnnotatedInstance instance;
  instance.category = type.Scalar();
  if (instance.category != "crop" && instance.category != "weed") {
    throw Malformed{key + ".type", "is '" + instance.category + "'; known are crop and weed"};
  }
  instance.kind = instance.category == "crop" ? SubClassKind::kCrop : SubClassKind::kWeed;
  const auto corners = polygon(node["points"], vegetation.size(), key + ".points");
  if (!cut_to_box(region(corners, vegetation), instance)) instance.mask.release();
  return instance;
}

std::vector<AnnotatedInstance> read_annotation(const std::string& text, const cv::Mat& vegetation) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& failure) {
    throw Malformed{"line " + std::to_string(failure.mark.line + 1), failure.msg};
  }
  if (!root.IsMap() || !root["annotation"]) throw Malformed{"annotation", "is missing"};
  const YAML::Node list = root["annotation"];
  std::vector<AnnotatedInstance> instances;
  const auto add = [&](const YAML::Node& node, const std::string& key) {
    AnnotatedInstance instance = read_instance(node, key, vegetation);
    if (!instance.mask.empty()) instances.push_back(std::move(instance));
  };
  if (list.IsMap()) {
    add(list, "annotation");
  } else if (list.IsSequence()) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      add(list[i], "annotation[" + std::to_string(i) + "]");
    }
  } else if (!list.IsNull()) {
    throw Malformed{"annotation", "is neither a list nor a map"};
  }
  return instances;
}

}  // namespace

Result<Dataset> read_cwfid(const std::filesystem::path& folder, const MaskReader& read_mask) {
  const auto files = list_files(folder / "annotations", ".yaml");
  if (!files) return files.error();
  if (files->empty()) {
    return Error{ErrorCode::kNotFound, (folder / "annotations").string() + ": holds no YAML files"};
  }
  Dataset dataset;
  dataset.name = "cwfid";
  dataset.classes = {{"crop", SubClassKind::kCrop}, {"weed", SubClassKind::kWeed}};
  for (const auto& file : *files) {
    const std::string number = file.stem().string().substr(0, file.stem().string().find('_'));
    AnnotatedImage image;
    image.path = folder / "images" / (number + "_image.png");
    if (!std::filesystem::exists(image.path)) {
      return Error{ErrorCode::kNotFound, image.path.string() + ": no image for its annotation"};
    }
    const auto mask = read_mask(folder / "masks" / (number + "_mask.png"));
    if (!mask) return mask.error();
    const auto text = read_file(file, 16u << 20);
    if (!text) return text.error();
    image.width_px = mask->cols;
    image.height_px = mask->rows;
    image.vegetation = *mask == 0;
    try {
      image.instances = read_annotation(*text, image.vegetation);
    } catch (const Malformed& failure) {
      return Error{ErrorCode::kParse, file.string() + ": " + failure.key + ": " + failure.message};
    }
    dataset.images.push_back(std::move(image));
  }
  return dataset;
}

}  // namespace furrow::annotation
