#include "coco_segmentation.hpp"

#include <cmath>

#include "furrow_annotation/dataset.hpp"
#include "furrow_annotation/polygon.hpp"

namespace furrow::annotation {
namespace {

constexpr double kLargestCoordinate_px = 100'000.0;
constexpr const char* kFewCorners = "polygon of fewer than three corners";

double coordinate(const JsonNode& node) {
  const double value = node.number();
  if (!(std::abs(value) <= kLargestCoordinate_px)) {
    throw Malformed{node.key(), "coordinate outside [-100000, 100000]"};
  }
  return value;
}

CornerPolygon read_polygon(const JsonNode& corners) {
  if (corners.size() % 2 != 0) {
    throw Malformed{corners.key(), "polygon of an odd number of coordinates"};
  }
  CornerPolygon polygon;
  polygon.reserve(corners.size() / 2);
  for (std::size_t k = 0; k < corners.size(); k += 2) {
    polygon.emplace_back(coordinate(corners.entry(k)), coordinate(corners.entry(k + 1)));
  }
  return polygon;
}

RunLengths read_polygons(const JsonNode& node, cv::Size size, ReadReport* report) {
  std::vector<RunLengths> masks;
  std::vector<std::string> left_out;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const CornerPolygon polygon = read_polygon(node.entry(i));
    if (polygon.size() >= 3) {
      masks.push_back(polygon_run_lengths(polygon, size));
    } else {
      left_out.push_back(node.entry(i).key());
    }
  }
  if (!left_out.empty() && (masks.empty() || report == nullptr)) {
    throw Malformed{left_out.front(), kFewCorners};
  }
  for (const std::string& key : left_out) report->skip(kFewCorners, key);
  return unite(masks);
}

RunLengths read_runs(const JsonNode& node, cv::Size size) {
  const JsonNode given = node.at("size");
  if (given.size() != 2 || given.entry(0).integer(1, kMaxImageSide_px) != size.height ||
      given.entry(1).integer(1, kMaxImageSide_px) != size.width) {
    throw Malformed{given.key(), "is not the image's [height, width]"};
  }
  const JsonNode counts = node.at("counts");
  if (counts.is_string()) {
    auto runs = decompress_run_lengths(counts.text());
    if (!runs) throw Malformed{counts.key(), runs.error().message};
    return std::move(*runs);
  }
  RunLengths runs;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    runs.push_back(static_cast<std::uint32_t>(counts.entry(i).integer(0, kMaxImageArea_px)));
  }
  return runs;
}

/// Left, top, right and bottom edge.
struct Edges {
  double left, top, right, bottom;
};

Edges read_edges(const JsonNode& node) {
  if (node.size() != 4) throw Malformed{node.key(), "is not [x, y, width, height]"};
  const double x = coordinate(node.entry(0)), y = coordinate(node.entry(1));
  const double width = coordinate(node.entry(2)), height = coordinate(node.entry(3));
  if (width < 0.0 || height < 0.0) throw Malformed{node.key(), "box of a negative size"};
  return {x, y, x + width, y + height};
}

BoxedMask to_mask(const RunLengths& runs, cv::Size size, const std::string& key) {
  auto mask = decode_run_lengths(runs, size);
  if (!mask) throw Malformed{key, "run lengths do not cover the image"};
  if (mask->box_px.empty()) throw Malformed{key, "no pixel of the image inside"};
  return std::move(*mask);
}

}  // namespace

Segmentation read_segmentation(const JsonNode& annotation, cv::Size size, ReadReport* report) {
  if (annotation.has("segmentation")) {
    const JsonNode node = annotation.at("segmentation");
    if (node.is_object()) return {to_mask(read_runs(node, size), size, node.key()), false};
    if (node.size() > 0)
      return {to_mask(read_polygons(node, size, report), size, node.key()), false};
  }
  if (!annotation.has("bbox")) {
    throw Malformed{annotation.key(), "neither a segmentation nor a box"};
  }
  const JsonNode node = annotation.at("bbox");
  const Edges box = read_edges(node);
  const CornerPolygon corners = {
      {box.left, box.top}, {box.left, box.bottom}, {box.right, box.bottom}, {box.right, box.top}};
  return {to_mask(polygon_run_lengths(corners, size), size, node.key()), true};
}

cv::Rect read_box(const JsonNode& node, cv::Size size) {
  const Edges box = read_edges(node);
  const cv::Point from(static_cast<int>(std::floor(box.left)),
                       static_cast<int>(std::floor(box.top)));
  const cv::Point to(static_cast<int>(std::ceil(box.right)),
                     static_cast<int>(std::ceil(box.bottom)));
  return cv::Rect(from, to) & cv::Rect(cv::Point(), size);
}

}  // namespace furrow::annotation
