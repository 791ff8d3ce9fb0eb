#include <memory>
#include <optional>
#include <string>

#include "furrow_components/conversions.hpp"
#include "furrow_components/image_conversions.hpp"
#include "furrow_geometry/camera.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_vision/detector_choice.hpp"
#include "furrow_vision/growth_stage.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

struct Parameters {
  vision::DetectorParameters detector;
  double ground_distance_m = 1.0;
  double min_score = 0.3;
  bool use_depth = true;
  vision::GrowthStageParameters growth;

  void visit(ParameterVisitor& v) {
    detector.visit(v);
    v.visit({.name = "ground_distance_m",
             .unit = "m",
             .description = "distance from camera to ground where depth is unknown",
             .min = 0.05,
             .max = 20.0},
            ground_distance_m);
    v.visit({.name = "min_score",
             .description = "instances with a lower score are not published",
             .min = 0.0,
             .max = 1.0},
            min_score);
    v.visit({.name = "use_depth",
             .description = "false: images are used without depth, at ground_distance_m"},
            use_depth);
    PrefixedVisitor growth_visitor(v, "stage_");
    growth.visit(growth_visitor);
  }
};

/// Detects the plants of each image.
class Perception final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Detects the plants of each image: class, mask, stem, area.")
        .parameters<Parameters>()
        .input<topics::CameraImage>()
        .input<topics::CameraDepth>(graph::Need::kOptional)
        .input<topics::CameraInfo>()
        .output<topics::Instances>();
  }

  explicit Perception(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<Parameters>()),
        detector_(vision::make_detector(parameters_.detector)),
        growth_(parameters_.growth),
        out_(context.output<topics::Instances>()) {
    context.input<topics::CameraInfo>([this](const auto& info) { calibrate(*info); });
    context.input<topics::CameraDepth>([this](const auto& depth) {
      if (!parameters_.use_depth) return;
      depth_ = depth;
      detect_when_complete();
    });
    context.input<topics::CameraImage>([this](const auto& image) {
      if (image_ != nullptr) {
        context_.warn("images_without_depth",
                      "no depth image with the stamp of the colour image; no plant was detected");
      }
      image_ = image;
      detect_when_complete();
    });
  }

 private:
  void calibrate(const sensor_msgs::msg::CameraInfo& info) {
    try {
      camera_.emplace(from_msg(info));
    } catch (const ConfigError& error) {
      context_.health(graph::HealthLevel::kError, error.what());
    }
  }

  // Image and depth of one exposure have the same stamp and arrive in either order.
  void detect_when_complete() {
    if (image_ == nullptr) return;
    if (parameters_.use_depth &&
        (depth_ == nullptr || !(depth_->header().stamp() == image_->header().stamp()))) {
      return;
    }
    const auto image = std::exchange(image_, nullptr);
    const auto depth = std::exchange(depth_, nullptr);
    if (!camera_) {
      context_.warn("images_before_camera_info", "no camera_info received; the image was not used");
      return;
    }
    if (const Status done = detect(*image, depth.get()); !done.ok()) {
      context_.count("bad_images");
      context_.health(graph::HealthLevel::kWarn, done.error().message + "; no plant was detected");
    }
  }

  Status detect(const sensor_msgs::msg::Image& image, const sensor_msgs::msg::Image* depth) {
    const auto bgr = bgr_of(image);
    if (!bgr.ok()) return bgr.error();
    const auto depth_m = depth == nullptr ? Result<cv::Mat>(cv::Mat()) : depth_m_of(*depth);
    if (!depth_m.ok()) return depth_m.error();
    const auto found = detector_->detect({.bgr = *bgr,
                                          .depth_m = *depth_m,
                                          .camera = *camera_,
                                          .ground_distance_m = parameters_.ground_distance_m});
    if (!found.ok()) return found.error();
    furrow_msgs::msg::PlantInstances message;
    message.header(image.header());
    for (const vision::Instance& instance : *found) {
      if (instance.score >= parameters_.min_score) message.instances().push_back(to_msg(instance));
    }
    context_.count("instances", static_cast<std::int64_t>(message.instances().size()));
    context_.health(graph::HealthLevel::kOk, "");
    out_.publish(std::move(message));
    return {};
  }

  [[nodiscard]] furrow_msgs::msg::PlantInstance to_msg(const vision::Instance& instance) const {
    furrow_msgs::msg::PlantInstance message;
    message.score(static_cast<float>(instance.score));
    message.crop_probability(static_cast<float>(instance.crop_probability));
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

  graph::Context& context_;
  Parameters parameters_;
  std::unique_ptr<vision::Detector> detector_;
  vision::GrowthStageEstimator growth_;
  graph::Output<topics::Instances> out_;
  std::optional<geometry::PinholeCamera> camera_;
  std::shared_ptr<const sensor_msgs::msg::Image> image_;
  std::shared_ptr<const sensor_msgs::msg::Image> depth_;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::Perception>("perception");
}
