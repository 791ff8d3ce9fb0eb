#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depth_watch.hpp"
#include "furrow_components/camera_calibration.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_components/frame_pairing.hpp"
#include "furrow_components/image_conversions.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_vision/rectifier.hpp"
#include "perception_parameters.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

/// But for the header.
bool same_calibration(const sensor_msgs::msg::CameraInfo& a, sensor_msgs::msg::CameraInfo b) {
  b.header(a.header());
  return a == b;
}

/// Detects the plants of each image.
class Perception final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Plants of each image: class, mask, stem, area.")
        .parameters<PerceptionParameters>()
        .input<topics::CameraImage>()
        .input<topics::CameraDepth>(graph::Need::kOptional)
        .input<topics::CameraInfo>()
        .output<topics::Instances>();
  }

  explicit Perception(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<PerceptionParameters>()),
        detector_(vision::make_detector(parameters_.detector)),
        growth_(parameters_.growth),
        pairing_(Duration::seconds(parameters_.depth_tolerance_s),
                 Duration::seconds(parameters_.depth_patience_s)),
        depth_watch_(Duration::seconds(parameters_.depth_tolerance_s),
                     parameters_.ground_distance_m),
        out_(context.output<topics::Instances>()) {
    context.input<topics::CameraInfo>([this](const auto& info) {
      calibrate(*info);
      detect_what_is_settled();
    });
    context.input<topics::CameraDepth>([this](const auto& depth) {
      if (!parameters_.use_depth) return;
      const Time stamp = graph::from_msg(depth->header().stamp());
      depth_watch_.depth_came(stamp);
      pairing_.add_depth(stamp, context_.now(), depth);
      detect_what_is_settled();
    });
    context.input<topics::CameraImage>([this](const auto& image) {
      if (parameters_.use_depth) {
        pairing_.add_colour(graph::from_msg(image->header().stamp()), context_.now(), image);
        detect_what_is_settled();
      } else {
        take(*image, nullptr);
      }
    });
  }

 private:
  void calibrate(const sensor_msgs::msg::CameraInfo& info) {
    if (calibration_message_ && same_calibration(*calibration_message_, info)) return;
    if (calibration_message_) {
      context_.warn("calibration_changes", "camera_info changed; the new calibration is used");
    }
    calibration_message_ = info;
    const CameraCalibration calibration = calibration_of(info, parameters_.rectified);
    camera_.reset();
    rectifier_.reset();
    try {
      camera_.emplace(calibration.intrinsics);
    } catch (const ConfigError& error) {
      calibration_error_ = std::string("camera_info: ") + error.what();
      return;
    }
    auto rectifier = vision::Rectifier::make(calibration.intrinsics, calibration.distortion);
    if (rectifier.ok()) {
      rectifier_ = std::move(rectifier).value();
    } else {
      camera_.reset();
      calibration_error_ = "camera_info: " + rectifier.error().message;
    }
  }

  void detect_what_is_settled() {
    while (const auto frame = pairing_.next(context_.now())) {
      if (frame->depth != nullptr) {
        depth_watch_.image_paired();
      } else {
        context_.warn("images_without_depth", "no depth image came in time for a colour image");
        depth_watch_.image_in_vain(graph::from_msg(frame->colour->header().stamp()));
        if (parameters_.without_depth == "drop") {
          if (const std::string missing = depth_watch_.missing(); !missing.empty()) {
            context_.health(graph::HealthLevel::kError, missing);
          }
          continue;
        }
      }
      take(*frame->colour, frame->depth.get());
    }
  }

  void take(const sensor_msgs::msg::Image& image, const sensor_msgs::msg::Image* depth) {
    if (!camera_) {
      context_.warn("images_before_camera_info", "no camera_info received; the image was not used");
      if (calibration_message_) context_.health(graph::HealthLevel::kError, calibration_error_);
      return;
    }
    if (const Status done = detect(image, depth); !done.ok()) {
      context_.count("bad_images");
      context_.health(graph::HealthLevel::kWarn, done.error().message + "; no plant was detected");
      return;
    }
    const std::string doubt = what_to_doubt(image);
    context_.health(doubt.empty() ? graph::HealthLevel::kOk : graph::HealthLevel::kWarn, doubt);
  }

  /// What the user should know although the image was used.
  [[nodiscard]] std::string what_to_doubt(const sensor_msgs::msg::Image& image) const {
    if (is_grey(image)) return "images are grey, and the network was trained on colour";
    if (const std::string missing = depth_watch_.missing(); !missing.empty()) return missing;
    return depth_watch_.contradiction();
  }

  Status detect(const sensor_msgs::msg::Image& image, const sensor_msgs::msg::Image* depth) {
    if (is_grey(image) && parameters_.detector.detector == "index") {
      return Error{ErrorCode::kInvalidArgument,
                   "images are grey (" + image.encoding() +
                       "); the index detector needs colour: set perception.detector"};
    }
    const auto raw_bgr = bgr_of(image);
    if (!raw_bgr.ok()) return raw_bgr.error();
    const auto raw_depth_m = depth == nullptr ? Result<cv::Mat>(cv::Mat())
                                              : depth_m_of(*depth, parameters_.depth_unit_m);
    if (!raw_depth_m.ok()) return raw_depth_m.error();
    if (const Status fits = check_size(*raw_bgr); !fits.ok()) return fits;
    const cv::Mat bgr = rectifier_->colour(*raw_bgr);
    const cv::Mat depth_m = rectified_depth(*raw_depth_m);
    if (!depth_m.empty()) depth_watch_.measured(depth_m);
    const auto found = detector_->detect({.bgr = bgr,
                                          .depth_m = depth_m,
                                          .camera = *camera_,
                                          .ground_distance_m = parameters_.ground_distance_m});
    if (!found.ok()) return found.error();
    furrow_msgs::msg::PlantInstances message;
    message.header(image.header());
    for (const vision::Instance& instance : *found) {
      if (instance.score >= parameters_.min_score) message.instances().push_back(to_msg(instance));
    }
    context_.count("instances", static_cast<std::int64_t>(message.instances().size()));
    out_.publish(std::move(message));
    return {};
  }

  [[nodiscard]] Status check_size(const cv::Mat& image) const {
    const auto& intrinsics = camera_->intrinsics();
    if (image.cols == intrinsics.width_px && image.rows == intrinsics.height_px) return {};
    return Error{ErrorCode::kInvalidArgument,
                 "image is " + std::to_string(image.cols) + " x " + std::to_string(image.rows) +
                     " px, camera_info says " + std::to_string(intrinsics.width_px) + " x " +
                     std::to_string(intrinsics.height_px)};
  }

  /// A depth of another size is not resampled, so that the detector refuses it.
  [[nodiscard]] cv::Mat rectified_depth(const cv::Mat& depth_m) const {
    const auto& intrinsics = camera_->intrinsics();
    const bool fits = depth_m.cols == intrinsics.width_px && depth_m.rows == intrinsics.height_px;
    return fits ? rectifier_->depth(depth_m) : depth_m;
  }

  [[nodiscard]] furrow_msgs::msg::PlantInstance to_msg(const vision::Instance& instance) const {
    furrow_msgs::msg::PlantInstance message;
    message.score(static_cast<float>(instance.score));
    message.crop_probability(static_cast<float>(instance.crop_probability));
    message.species(species_of(instance));
    message.box().x_offset(static_cast<std::uint32_t>(instance.box_px.x));
    message.box().y_offset(static_cast<std::uint32_t>(instance.box_px.y));
    message.box().width(static_cast<std::uint32_t>(instance.box_px.width));
    message.box().height(static_cast<std::uint32_t>(instance.box_px.height));
    message.mask_runs(mask_runs(instance.mask));
    message.stem_u_px(instance.stem_px.x());
    message.stem_v_px(instance.stem_px.y());
    message.stem(to_point(camera_->unproject(instance.stem_px, instance.stem_depth_m)));
    message.radius_m(instance.radius_m);
    message.area_mm2(instance.area_mm2);
    message.leaves(static_cast<std::uint8_t>(vision::leaf_count(growth_.stage(instance.area_mm2))));
    return message;
  }

  /// Of classes that are species, such as "thistle".
  [[nodiscard]] std::vector<furrow_msgs::msg::SpeciesProbability> species_of(
      const vision::Instance& instance) const {
    constexpr double kLeast = 0.001;
    std::vector<furrow_msgs::msg::SpeciesProbability> result;
    const auto& classes = detector_->classes();
    for (std::size_t i = 0; i < std::min(classes.size(), instance.class_scores.size()); ++i) {
      const std::string name = annotation::species_of(classes[i]);
      if (name.empty() || instance.class_scores[i] < kLeast) continue;
      auto& species = result.emplace_back();
      species.species(name);
      species.crop(classes[i].kind == vision::SubClassKind::kCrop);
      species.probability(static_cast<float>(std::min(instance.class_scores[i], 1.0)));
    }
    return result;
  }

  using Image = sensor_msgs::msg::Image;

  graph::Context& context_;
  PerceptionParameters parameters_;
  std::unique_ptr<vision::Detector> detector_;
  vision::GrowthStageEstimator growth_;
  FramePairing<Image> pairing_;
  DepthWatch depth_watch_;
  graph::Output<topics::Instances> out_;
  std::optional<sensor_msgs::msg::CameraInfo> calibration_message_;
  std::string calibration_error_;  // why there is no camera_ although there was a message
  std::optional<geometry::PinholeCamera> camera_;
  std::optional<vision::Rectifier> rectifier_;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::Perception>("perception");
}
