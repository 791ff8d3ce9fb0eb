#include "furrow_vision/augmentation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "furrow_core/error.hpp"

namespace furrow::vision {
namespace {

template <class Function>
void change_lightness(cv::Mat bgr, Function&& change) {
  cv::Mat lab;
  bgr.convertTo(lab, CV_32FC3, 1.0 / 255.0);
  cv::cvtColor(lab, lab, cv::COLOR_BGR2Lab);
  for (int v = 0; v < lab.rows; ++v) {
    auto* row = lab.ptr<cv::Vec3f>(v);
    for (int u = 0; u < lab.cols; ++u) {
      row[u][0] = std::clamp(row[u][0] + change(u, v), 0.0f, 100.0f);
    }
  }
  cv::cvtColor(lab, lab, cv::COLOR_Lab2BGR);
  lab.convertTo(bgr, CV_8UC3, 255.0);
}

/// Instance masks live on boxes: the transform is taken from box to box.
bool warp_instance(const cv::Matx23d& map, cv::Size size, AnnotatedInstance& instance) {
  const cv::Rect& box = instance.box_px;
  const std::vector<cv::Point2d> corners = {
      cv::Point2d(box.x, box.y), cv::Point2d(box.x + box.width, box.y),
      cv::Point2d(box.x, box.y + box.height), cv::Point2d(box.x + box.width, box.y + box.height)};
  cv::Point2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const cv::Point2d& c : corners) {
    const cv::Point2d p(map(0, 0) * c.x + map(0, 1) * c.y + map(0, 2),
                        map(1, 0) * c.x + map(1, 1) * c.y + map(1, 2));
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const cv::Point first(cvFloor(low.x) - 1, cvFloor(low.y) - 1);
  const cv::Point last(cvCeil(high.x) + 2, cvCeil(high.y) + 2);
  const cv::Rect target = cv::Rect(first, last) & cv::Rect(cv::Point(), size);
  if (target.empty()) return false;
  cv::Matx23d local = map;
  local(0, 2) += map(0, 0) * box.x + map(0, 1) * box.y - target.x;
  local(1, 2) += map(1, 0) * box.x + map(1, 1) * box.y - target.y;
  cv::Mat warped;
  cv::warpAffine(instance.mask, warped, local, target.size(), cv::INTER_NEAREST);
  const cv::Rect tight = cv::boundingRect(warped);
  if (tight.empty()) return false;
  instance.mask = warped(tight).clone();
  instance.box_px = tight + target.tl();
  if (instance.stem_px) {
    const Eigen::Vector2d p = *instance.stem_px;
    const Eigen::Vector2d q(map(0, 0) * p.x() + map(0, 1) * p.y() + map(0, 2),
                            map(1, 0) * p.x() + map(1, 1) * p.y() + map(1, 2));
    instance.stem_px.reset();
    if (q.x() >= -0.5 && q.y() >= -0.5 && q.x() < size.width - 0.5 && q.y() < size.height - 0.5) {
      instance.stem_px = q;
    }
  }
  return true;
}

void warp(const AugmentationDraw& draw, AnnotatedImage& image) {
  const cv::Size size = image.bgr.size();
  const cv::Point2d centre((size.width - 1) / 2.0, (size.height - 1) / 2.0);
  const double c = draw.scale * std::cos(draw.rotation_rad);
  const double s = draw.scale * std::sin(draw.rotation_rad);
  const cv::Matx23d map(c, -s, centre.x - c * centre.x + s * centre.y,  //
                        s, c, centre.y - s * centre.x - c * centre.y);
  cv::Mat warped;
  cv::warpAffine(image.bgr, warped, map, size, cv::INTER_LINEAR, cv::BORDER_CONSTANT,
                 cv::mean(image.bgr));
  image.bgr = warped;
  if (!image.vegetation.empty()) {
    cv::Mat vegetation;
    cv::warpAffine(image.vegetation, vegetation, map, size, cv::INTER_NEAREST);
    image.vegetation = vegetation;
  }
  std::erase_if(image.instances,
                [&](AnnotatedInstance& instance) { return !warp_instance(map, size, instance); });
}

/// @param code as of cv::flip: 1 left and right, 0 up and down.
void flip(int code, AnnotatedImage& image) {
  const auto flipped = [&](const cv::Mat& from) {
    cv::Mat to;
    cv::flip(from, to, code);
    return to;
  };
  image.bgr = flipped(image.bgr);
  if (!image.vegetation.empty()) image.vegetation = flipped(image.vegetation);
  for (AnnotatedInstance& instance : image.instances) {
    instance.mask = flipped(instance.mask);
    cv::Rect& box = instance.box_px;
    if (code == 1) {
      box.x = image.bgr.cols - box.x - box.width;
      if (instance.stem_px) instance.stem_px->x() = image.bgr.cols - 1 - instance.stem_px->x();
    } else {
      box.y = image.bgr.rows - box.y - box.height;
      if (instance.stem_px) instance.stem_px->y() = image.bgr.rows - 1 - instance.stem_px->y();
    }
  }
}

}  // namespace

void AugmentationParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "probability",
           .description = "Of each photometric transform, drawn on its own",
           .min = 0.0,
           .max = 1.0},
          probability);
  v.visit({.name = "luminance_range",
           .description = "Greatest shift of L of CIELAB (0 to 100), up or down",
           .min = 0.0,
           .max = 100.0},
          luminance_range);
  v.visit({.name = "colour_jitter",
           .description = "Greatest change of a colour channel, as a share",
           .min = 0.0,
           .max = 1.0},
          colour_jitter);
  v.visit({.name = "box_gain_min",
           .description = "Least gain in L inside the illumination box",
           .min = -100.0,
           .max = 100.0},
          box_gain_min);
  v.visit({.name = "box_gain_max",
           .description = "Greatest gain in L inside the illumination box",
           .min = -100.0,
           .max = 100.0},
          box_gain_max);
  v.visit({.name = "box_rotation_max_rad",
           .unit = "rad",
           .description = "Greatest rotation of the illumination box, either way",
           .min = 0.0,
           .max = std::numbers::pi},
          box_rotation_max_rad);
  v.visit({.name = "box_edge_kernel_px",
           .unit = "px",
           .description = "Side of the Gaussian kernel on the box's edges, odd",
           .min = 1.0,
           .max = 255.0},
          box_edge_kernel_px);
  v.visit({.name = "flip_probability",
           .description = "Of mirroring, drawn for each axis",
           .min = 0.0,
           .max = 1.0},
          flip_probability);
  v.visit({.name = "scale_min", .description = "Least zoom", .min = 0.1, .max = 10.0}, scale_min);
  v.visit({.name = "scale_max", .description = "Greatest zoom", .min = 0.1, .max = 10.0},
          scale_max);
  v.visit({.name = "rotation_max_rad",
           .unit = "rad",
           .description = "Greatest rotation of the image, either way",
           .min = 0.0,
           .max = std::numbers::pi},
          rotation_max_rad);
}

Augmenter::Augmenter(const AugmentationParameters& parameters) : parameters_(parameters) {
  validate_parameters(parameters_);
  if (parameters_.box_gain_min > parameters_.box_gain_max ||
      parameters_.scale_min > parameters_.scale_max) {
    throw ConfigError("augmentation: a least value is above its greatest");
  }
  if (parameters_.box_edge_kernel_px % 2 == 0) {
    throw ConfigError("augmentation: box_edge_kernel_px must be odd");
  }
}

AugmentationDraw Augmenter::draw(cv::Size image_size, Random& random) const {
  const AugmentationParameters& p = parameters_;
  AugmentationDraw draw;
  draw.flip_horizontal = random.bernoulli(p.flip_probability);
  draw.flip_vertical = random.bernoulli(p.flip_probability);
  draw.scale = random.uniform(p.scale_min, p.scale_max);
  draw.rotation_rad = random.uniform(-p.rotation_max_rad, p.rotation_max_rad);
  if (random.bernoulli(p.probability)) {
    draw.luminance = random.uniform(-p.luminance_range, p.luminance_range);
  }
  if (random.bernoulli(p.probability)) {
    draw.channel_gains.emplace();
    for (double& gain : *draw.channel_gains) {
      gain = random.uniform(1.0 - p.colour_jitter, 1.0 + p.colour_jitter);
    }
  }
  draw.blur = random.bernoulli(p.probability);
  if (random.bernoulli(p.probability)) {
    IlluminationBox& box = draw.box.emplace();
    const auto share = [&](int side, double low, double high) {
      return static_cast<float>(side * random.uniform(low, high));
    };
    box.box.center.x = share(image_size.width, 0.0, 1.0);
    box.box.center.y = share(image_size.height, 0.0, 1.0);
    box.box.size.width = share(image_size.width, 0.1, 1.0);
    box.box.size.height = share(image_size.height, 0.1, 1.0);
    box.box.angle = static_cast<float>(
        random.uniform(-p.box_rotation_max_rad, p.box_rotation_max_rad) * 180.0 / std::numbers::pi);
    box.gain = random.uniform(p.box_gain_min, p.box_gain_max);
    box.edge_kernel_px = static_cast<int>(p.box_edge_kernel_px);
  }
  return draw;
}

void shift_luminance(cv::Mat& bgr, double delta) {
  change_lightness(bgr, [delta](int, int) { return static_cast<float>(delta); });
}

void scale_channels(cv::Mat& bgr, const std::array<double, 3>& gains) {
  cv::multiply(bgr, cv::Scalar(gains[0], gains[1], gains[2]), bgr);
}

void blur_3x3(cv::Mat& bgr) {
  cv::GaussianBlur(bgr, bgr, {3, 3}, 0.0);
}

void brighten_box(cv::Mat& bgr, const IlluminationBox& box) {
  constexpr int kShift = 8;  // fractional bits of fillConvexPoly
  const int margin = box.edge_kernel_px + 1;
  const cv::Rect around = box.box.boundingRect();
  const cv::Rect area = cv::Rect(around.x - margin, around.y - margin, around.width + 2 * margin,
                                 around.height + 2 * margin) &
                        cv::Rect(cv::Point(), bgr.size());
  if (area.empty()) return;
  std::array<cv::Point2f, 4> corners;
  box.box.points(corners.data());
  std::vector<cv::Point> polygon;
  polygon.reserve(corners.size());
  for (const cv::Point2f& corner : corners) {
    polygon.emplace_back(cvRound((corner.x - static_cast<float>(area.x)) * (1 << kShift)),
                         cvRound((corner.y - static_cast<float>(area.y)) * (1 << kShift)));
  }
  cv::Mat share = cv::Mat::zeros(area.size(), CV_32F);
  cv::fillConvexPoly(share, polygon, cv::Scalar(1.0), cv::LINE_8, kShift);
  cv::GaussianBlur(share, share, {box.edge_kernel_px, box.edge_kernel_px}, 0.0);
  change_lightness(bgr(area), [&](int u, int v) {
    return static_cast<float>(box.gain) * share.at<float>(v, u);
  });
}

void apply_augmentation(const AugmentationDraw& draw, AnnotatedImage& image) {
  const bool warps = draw.scale != 1.0 || draw.rotation_rad != 0.0;
  if (draw.flip_horizontal) flip(1, image);
  if (draw.flip_vertical) flip(0, image);
  if (warps) warp(draw, image);
  if (draw.flip_horizontal || draw.flip_vertical || warps) {
    image.X_FB.reset();
    image.velocity_mps.reset();
    image.depth_path.clear();
  }
  if (draw.luminance) shift_luminance(image.bgr, *draw.luminance);
  if (draw.channel_gains) scale_channels(image.bgr, *draw.channel_gains);
  if (draw.blur) blur_3x3(image.bgr);
  if (draw.box) brighten_box(image.bgr, *draw.box);
}

}  // namespace furrow::vision
