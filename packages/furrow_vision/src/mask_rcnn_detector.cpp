#include "furrow_vision/mask_rcnn_detector.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "furrow_core/error.hpp"
#include "furrow_vision/region_proposals.hpp"
#include "network.hpp"

namespace furrow::vision {
namespace {

constexpr int kBoxCells = 7;
constexpr int kMaskCells = 14;

struct Region {
  RegionBox box;
  float score = 0.0f;                              ///< 1 - p(background)
  std::vector<double> class_scores;                ///< of the classes, given a plant
  int best = 0;                                    ///< class
  Eigen::Vector2d stem = Eigen::Vector2d::Zero();  ///< where the model tells stems
};

bool is_table(const cv::Mat& m, int rows) {
  return m.dims == 2 && m.type() == CV_32F && m.rows == rows && m.isContinuous();
}

/// Super- and sub-class scores of a row of logits, background first.
Region scores_of(const float* logits, int classes) {
  const float highest = *std::max_element(logits, logits + classes + 1);
  double plants = 0.0;
  Region region;
  for (int k = 1; k <= classes; ++k) {
    region.class_scores.push_back(std::exp(static_cast<double>(logits[k] - highest)));
    plants += region.class_scores.back();
  }
  const double background = std::exp(static_cast<double>(logits[0] - highest));
  region.score = static_cast<float>(plants / (plants + background));
  for (double& score : region.class_scores) score /= std::max(plants, 1e-300);
  region.best =
      static_cast<int>(std::max_element(region.class_scores.begin(), region.class_scores.end()) -
                       region.class_scores.begin());
  return region;
}

/// The densest place of a mask: the maximum of the mask blurred by a good part of its size, on at
/// most 64 x 64 pixels.
Eigen::Vector2d densest_place(const cv::Mat& mask) {
  constexpr double kSide = 64.0;
  const double scale = std::min(1.0, kSide / std::max(mask.cols, mask.rows));
  cv::Mat small;
  cv::resize(mask, small,
             {std::max(1, static_cast<int>(mask.cols * scale)),
              std::max(1, static_cast<int>(mask.rows * scale))},
             0.0, 0.0, cv::INTER_AREA);
  small.convertTo(small, CV_32F);
  const double deviation = std::max(0.8, 0.5 * std::sqrt(cv::sum(small)[0] / 255.0));
  cv::GaussianBlur(small, small, {}, deviation, deviation, cv::BORDER_CONSTANT);
  cv::Point at;
  cv::minMaxLoc(small, nullptr, nullptr, nullptr, &at);
  return {(at.x + 0.5) * mask.cols / small.cols - 0.5, (at.y + 0.5) * mask.rows / small.rows - 0.5};
}

}  // namespace

class MaskRcnnDetector::Implementation {
 public:
  Implementation(const MaskRcnnParameters& parameters, const std::filesystem::path& model_file)
      : parameters_(checked(parameters)),
        model_(load_model(model_file, ModelFile::Kind::kMaskRcnn, parameters.network.classes)),
        backbone_(load_network(model_, "backbone")),
        box_head_(load_network(model_, "box_head")),
        mask_head_(load_network(model_, "mask_head")) {
    const std::size_t levels = model_.anchors.sizes_px.size();
    for (std::size_t i = 0; i < levels; ++i) {
      outputs_.push_back("objectness_" + std::to_string(i));
      outputs_.push_back("deltas_" + std::to_string(i));
    }
    for (std::int64_t i = 0; i < model_.feature_levels; ++i) {
      outputs_.push_back("features_" + std::to_string(i));
    }
    if (model_.stems) head_outputs_.push_back("stems");
    // Networks that do not fit the model file are found here and not in the field.
    constexpr int kProbe_px = 128;
    const cv::Size size(kProbe_px, kProbe_px);
    const auto maps = pyramid(cv::Mat::zeros(size, CV_8UC3), size);
    if (!maps.ok()) throw ConfigError(backbone_.file() + ": " + maps.error().message);
    const auto proposals = propose(*maps, size);
    if (!proposals.ok()) {
      throw ConfigError(backbone_.file() + ": " + proposals.error().message);
    }
    Region region;
    region.box = {0.0f, 0.0f, 64.0f, 64.0f};
    const auto boxes = classify(*maps, {region.box}, size);
    if (!boxes.ok()) throw ConfigError(box_head_.file() + ": " + boxes.error().message);
    const auto masks = masks_of(*maps, {region});
    if (!masks.ok()) throw ConfigError(mask_head_.file() + ": " + masks.error().message);
  }

  Result<std::vector<Instance>> detect(const RgbdView& view) {
    if (const Status status = check_view(view); !status) return status.error();
    const double mm_per_px = view.ground_mm_per_px();
    const cv::Size input =
        network_input_size(view.bgr.size(), mm_per_px, model_.ground_resolution_mm_per_px,
                           parameters_.network.input_area_max_px);
    const auto maps = pyramid(view.bgr, input);
    if (!maps.ok()) return maps.error();
    const auto proposals = propose(*maps, input);
    if (!proposals.ok()) return proposals.error();
    const auto regions = classify(*maps, *proposals, input);
    if (!regions.ok()) return regions.error();
    const auto masks = masks_of(*maps, *regions);
    if (!masks.ok()) return masks.error();
    return instances(view, *regions, *masks, input);
  }

  [[nodiscard]] const ModelFile& model() const { return model_; }

 private:
  struct Pyramid {
    std::vector<cv::Mat> objectness, deltas, features;
  };

  static MaskRcnnParameters checked(const MaskRcnnParameters& parameters) {
    validate_parameters(parameters);
    return parameters;
  }

  Result<Pyramid> pyramid(const cv::Mat& bgr, cv::Size input) {
    const auto maps = backbone_.run(cv::dnn::blobFromImage(bgr, 1.0 / 255.0, input), outputs_);
    if (!maps.ok()) return maps.error();
    Pyramid result;
    const std::size_t levels = model_.anchors.sizes_px.size();
    for (std::size_t i = 0; i < levels; ++i) {
      result.objectness.push_back((*maps)[2 * i]);
      result.deltas.push_back((*maps)[2 * i + 1]);
    }
    for (std::size_t i = 2 * levels; i < maps->size(); ++i) {
      const cv::Mat& map = (*maps)[i];
      if (map.dims != 4 || map.type() != CV_32F || map.size[0] != 1 || !map.isContinuous() ||
          (!result.features.empty() && map.size[1] != result.features[0].size[1])) {
        return Error{ErrorCode::kInvalidArgument, "its features are not one map a level"};
      }
      result.features.push_back(map);
    }
    return result;
  }

  [[nodiscard]] Result<std::vector<RegionBox>> propose(const Pyramid& maps, cv::Size input) const {
    return propose_regions(
        maps.objectness, maps.deltas, model_.anchors, input,
        {.before_suppression = static_cast<std::size_t>(2 * parameters_.proposals_max),
         .after_suppression = static_cast<std::size_t>(parameters_.proposals_max),
         .iou_max = parameters_.proposal_iou_max});
  }

  [[nodiscard]] cv::Mat cut(const Pyramid& maps, const std::vector<RegionBox>& boxes,
                            int cells) const {
    const int shape[] = {static_cast<int>(boxes.size()), maps.features[0].size[1], cells, cells};
    cv::Mat regions(4, shape, CV_32F);
    const int levels = static_cast<int>(maps.features.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const int level = pyramid_level(boxes[i], levels);
      align_region(maps.features[level], boxes[i], 4.0 * std::pow(2.0, level), cells,
                   regions.ptr<float>(static_cast<int>(i)));
    }
    return regions;
  }

  Result<std::vector<Region>> classify(const Pyramid& maps, const std::vector<RegionBox>& boxes,
                                       cv::Size input) {
    if (boxes.empty()) return std::vector<Region>();
    const auto outputs = box_head_.run(cut(maps, boxes, kBoxCells), head_outputs_);
    if (!outputs.ok()) return outputs.error();
    const cv::Mat &logits = (*outputs)[0], &deltas = (*outputs)[1];
    const cv::Mat& stems = outputs->back();
    const int classes = static_cast<int>(model_.classes.size());
    const int rows = static_cast<int>(boxes.size());
    if (!is_table(logits, rows) || logits.cols != 1 + classes || !is_table(deltas, rows) ||
        (deltas.cols != 4 && deltas.cols != 4 * (1 + classes))) {
      return Error{ErrorCode::kInvalidArgument, "the box head is of other classes"};
    }
    if (model_.stems && (!is_table(stems, rows) || stems.cols != 2)) {
      return Error{ErrorCode::kInvalidArgument, "the box head's stems are not two values a region"};
    }
    if (!cv::checkRange(logits) || !cv::checkRange(deltas) || !cv::checkRange(stems)) {
      return Error{ErrorCode::kInvalidArgument, "the box head's output is not finite"};
    }
    std::vector<Region> candidates;
    for (int i = 0; i < rows; ++i) {
      Region region = scores_of(logits.ptr<float>(i), classes);
      if (region.score < static_cast<float>(parameters_.score_min)) continue;
      if (model_.stems) {
        const float* off = stems.ptr<float>(i);
        region.stem = {boxes[i].u0 + (0.5 + off[0]) * boxes[i].width(),
                       boxes[i].v0 + (0.5 + off[1]) * boxes[i].height()};
      }
      const float* d = deltas.ptr<float>(i) + (deltas.cols == 4 ? 0 : 4 * (1 + region.best));
      region.box = clip_box(
          decode_box(boxes[i], {d[0], d[1], d[2], d[3]}, {10.0f, 10.0f, 5.0f, 5.0f}), input);
      if (region.box.width() >= 1.0f && region.box.height() >= 1.0f) {
        candidates.push_back(std::move(region));
      }
    }
    std::vector<RegionBox> candidate_boxes;
    std::vector<float> scores;
    for (const Region& region : candidates) {
      candidate_boxes.push_back(region.box);
      scores.push_back(region.score);
    }
    std::vector<Region> kept;
    for (const int i : suppress_overlaps(candidate_boxes, scores, parameters_.iou_max,
                                         static_cast<std::size_t>(parameters_.plants_max))) {
      kept.push_back(std::move(candidates[i]));
    }
    return kept;
  }

  /// The map of logits of each region's class.
  Result<std::vector<cv::Mat>> masks_of(const Pyramid& maps, const std::vector<Region>& regions) {
    std::vector<cv::Mat> masks;
    if (regions.empty()) return masks;
    std::vector<RegionBox> boxes;
    for (const Region& region : regions) boxes.push_back(region.box);
    const auto outputs = mask_head_.run(cut(maps, boxes, kMaskCells), {"mask_logits"});
    if (!outputs.ok()) return outputs.error();
    const cv::Mat& logits = (*outputs)[0];
    const int classes = static_cast<int>(model_.classes.size());
    const bool fits = logits.dims == 4 && (logits.size[1] == 1 || logits.size[1] == classes ||
                                           logits.size[1] == 1 + classes);
    if (!fits || logits.type() != CV_32F || !logits.isContinuous() ||
        logits.size[0] != static_cast<int>(regions.size()) || logits.size[2] < 2 ||
        logits.size[3] < 2) {
      return Error{ErrorCode::kInvalidArgument, "the mask head is of other classes"};
    }
    if (!cv::checkRange(logits.reshape(1, 1))) {
      return Error{ErrorCode::kInvalidArgument, "the mask head's output is not finite"};
    }
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const int channel =
          logits.size[1] == 1 ? 0 : regions[i].best + (logits.size[1] == classes ? 0 : 1);
      const auto* map = logits.ptr<float>(static_cast<int>(i), channel);
      masks.push_back(
          cv::Mat(logits.size[2], logits.size[3], CV_32F, const_cast<float*>(map)).clone());
    }
    return masks;
  }

  [[nodiscard]] std::vector<Instance> instances(const RgbdView& view,
                                                const std::vector<Region>& regions,
                                                const std::vector<cv::Mat>& masks,
                                                cv::Size input) const {
    const auto scale_u = static_cast<float>(view.bgr.cols) / static_cast<float>(input.width);
    const auto scale_v = static_cast<float>(view.bgr.rows) / static_cast<float>(input.height);
    const cv::Rect frame(cv::Point(), view.bgr.size());
    // What no box covers is soil; where boxes overlap, the mask that is surest has the pixel.
    cv::Mat logit(view.bgr.size(), CV_32F, cv::Scalar(-1e3));
    cv::Mat owner = cv::Mat::zeros(view.bgr.size(), CV_32S);
    std::vector<cv::Rect> extents;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const RegionBox& b = regions[i].box;
      const RegionBox box{b.u0 * scale_u, b.v0 * scale_v, b.u1 * scale_u, b.v1 * scale_v};
      const cv::Point low(static_cast<int>(box.u0), static_cast<int>(box.v0));
      const cv::Point high(static_cast<int>(std::ceil(box.u1)),
                           static_cast<int>(std::ceil(box.v1)));
      const cv::Rect extent = cv::Rect(low, high) & frame;
      extents.push_back(extent);
      if (extent.empty()) continue;
      const cv::Mat own = stretch_mask(masks[i], box, extent);
      const cv::Mat better = own > logit(extent);
      own.copyTo(logit(extent), better);
      owner(extent).setTo(static_cast<int>(i) + 1, better);
    }
    const Vegetation vegetation = segment_vegetation(view.bgr, parameters_.vegetation.index);
    cv::Mat mask = fuse_vegetation(logit, vegetation, parameters_.vegetation);
    mask.setTo(0, owner == 0);
    std::vector<Instance> plants;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      if (extents[i].empty()) continue;
      cv::Mat own = (owner(extents[i]) == static_cast<int>(i) + 1) & mask(extents[i]);
      const cv::Rect inner = cv::boundingRect(own);
      if (inner.empty()) continue;
      Instance plant{.score = regions[i].score, .class_scores = regions[i].class_scores};
      shift_towards_crops(model_.crop_log_odds + parameters_.network.crop_log_odds, model_.classes,
                          plant.class_scores);
      plant.crop_probability = crop_probability(plant.class_scores, model_.classes);
      plant.box_px = inner + extents[i].tl();
      plant.mask = own(inner).clone();
      if (model_.stems) {
        const Eigen::Vector2d& stem = regions[i].stem;
        plant.stem_px = {stem.x() * scale_u - 0.5, stem.y() * scale_v - 0.5};
        measure_instance(view, plant);
        set_stem_depth_to_ground(view, mask, plant);
      } else {
        plant.stem_px = densest_place(plant.mask) + Eigen::Vector2d(plant.box_px.x, plant.box_px.y);
        measure_instance(view, plant);
        place_stem_on_ground(view, mask, plant);
      }
      if (plant.area_mm2 >= parameters_.min_plant_area_mm2) plants.push_back(std::move(plant));
    }
    return plants;
  }

  MaskRcnnParameters parameters_;
  ModelFile model_;
  Network backbone_, box_head_, mask_head_;
  std::vector<std::string> outputs_;
  std::vector<std::string> head_outputs_ = {"class_logits", "box_deltas"};
};

void MaskRcnnParameters::visit(ParameterVisitor& v) {
  vegetation.visit(v);
  v.visit({.name = "score_min",
           .description = "Least probability of a plant in a box",
           .min = 0.01,
           .max = 1.0},
          score_min);
  v.visit({.name = "iou_max",
           .description = "Of boxes that overlap more the less probable one goes",
           .min = 0.0,
           .max = 1.0},
          iou_max);
  v.visit({.name = "proposal_iou_max",
           .description = "The same among the proposals",
           .min = 0.0,
           .max = 1.0},
          proposal_iou_max);
  v.visit({.name = "proposals_max",
           .description = "Boxes that are looked at; time grows with them",
           .min = 1,
           .max = 2000},
          proposals_max);
  v.visit({.name = "plants_max", .description = "In one image", .min = 1, .max = 2000}, plants_max);
  v.visit({.name = "min_plant_area_mm2",
           .unit = "mm2",
           .description = "Smaller ones are taken for specks",
           .min = 0.0,
           .max = 1e5},
          min_plant_area_mm2);
  network.visit(v);
}

MaskRcnnDetector::MaskRcnnDetector(const MaskRcnnParameters& parameters,
                                   const std::filesystem::path& model_file)
    : implementation_(std::make_unique<Implementation>(parameters, model_file)) {}

MaskRcnnDetector::~MaskRcnnDetector() = default;

Result<std::vector<Instance>> MaskRcnnDetector::detect(const RgbdView& view) {
  return implementation_->detect(view);
}

const std::vector<SubClass>& MaskRcnnDetector::classes() const {
  return implementation_->model().classes;
}

}  // namespace furrow::vision
