#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "furrow_components/conversions.hpp"
#include "furrow_components/field_conversion.hpp"
#include "furrow_components/field_source.hpp"
#include "furrow_components/image_conversions.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_simulation/photo_ground.hpp"
#include "furrow_simulation/renderer.hpp"
#include "photo_source.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

struct Parameters {
  std::string tool_file;
  std::string field_file;
  std::string species_file;
  double length_m = 20.0;
  double camera_rate_hz = 5.0;
  bool render = true;
  bool true_masks = false;
  std::string photos_folder;
  double photo_resolution_mm_per_px = 1.0;
  std::int64_t photo_quarter_turns = 0;
  std::int64_t photo_limit = 20;
  double photo_width_m = 1.39;
  simulation::RendererParameters renderer;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "tool_file", .description = "URDF of robot and tool"}, tool_file);
    v.visit({.name = "field_file", .description = "field preset (YAML), or plants (CSV, GeoJSON)"},
            field_file);
    v.visit({.name = "species_file", .description = "table of species; empty: the built-in one"},
            species_file);
    v.visit({.name = "length_m",
             .unit = "m",
             .description = "length of a generated field, or of a field of photographs",
             .min = 0.5,
             .max = 10000.0},
            length_m);
    v.visit({.name = "camera_rate_hz",
             .unit = "Hz",
             .description = "rate of the images",
             .min = 0.1,
             .max = 100.0},
            camera_rate_hz);
    v.visit({.name = "render", .description = "false: no images, only truth/instances"}, render);
    v.visit(
        {.name = "true_masks",
         .description = "truth/instances hold the mask and box of each plant as rendered, empty "
                        "where it is not visible"},
        true_masks);
    v.visit({.name = "photos_folder",
             .description = "annotated photographs as the ground, in the layout of CWFID or "
                            "Carrot-Weed; empty: the ground is rendered"},
            photos_folder);
    v.visit({.name = "photo_resolution_mm_per_px",
             .unit = "mm/px",
             .description = "resolution of the photographs on the ground",
             .min = 0.01,
             .max = 100.0},
            photo_resolution_mm_per_px);
    v.visit({.name = "photo_quarter_turns",
             .description = "quarter turns of the photographs, counter-clockwise",
             .min = 0,
             .max = 3},
            photo_quarter_turns);
    v.visit({.name = "photo_limit",
             .description = "most photographs to use from the folder",
             .min = 1,
             .max = 1000},
            photo_limit);
    v.visit({.name = "photo_width_m",
             .unit = "m",
             .description = "width covered with photographs",
             .min = 0.1,
             .max = 20.0},
            photo_width_m);
    PrefixedVisitor renderer_visitor(v, "render_");
    renderer.visit(renderer_visitor);
  }
};

std::unique_ptr<simulation::Scene> make_scene(const Parameters& parameters, std::uint64_t seed) {
  if (!parameters.photos_folder.empty()) {
    simulation::PhotoGroundParameters photo;
    photo.photo_resolution_mm_per_px = parameters.photo_resolution_mm_per_px;
    photo.length_m = parameters.length_m;
    photo.width_m = parameters.photo_width_m;
    photo.quarter_turns = parameters.photo_quarter_turns;
    photo.threads = parameters.renderer.threads;
    return std::make_unique<simulation::PhotoGround>(
        load_ground_photos(parameters.photos_folder, static_cast<int>(parameters.photo_limit)),
        photo, seed);
  }
  return std::make_unique<simulation::Renderer>(
      load_field(parameters.field_file, load_species(parameters.species_file), parameters.length_m,
                 seed),
      parameters.renderer, seed);
}

/// Simulates a down-facing RGB-D camera and the field below it.
class CameraSimulator final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Simulates an RGB-D camera over a rendered field or photographs, with ground truth.")
        .parameters<Parameters>()
        .input<topics::TrueOdometry>()
        .output<topics::TrueField>()
        .output<topics::TrueInstances>()
        .output<topics::CameraImage>()
        .output<topics::CameraDepth>()
        .output<topics::CameraInfo>();
  }

  explicit CameraSimulator(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<Parameters>()),
        tool_(geometry::load_tool_model(parameters_.tool_file)),
        scene_(make_scene(parameters_, context.seed())),
        truth_(context.output<topics::TrueInstances>()),
        image_(context.output<topics::CameraImage>()),
        depth_(context.output<topics::CameraDepth>()),
        info_(context.output<topics::CameraInfo>()) {
    if (tool_.cameras.empty()) throw ConfigError("the tool has no camera");
    camera_.emplace(tool_.cameras.front().intrinsics);
    context.output<topics::TrueField>().publish(to_msg(scene_->field(), context.now()));
    context.input<topics::TrueOdometry>([this](const auto& message) {
      const BaseOdometry base = from_msg(*message);
      if (frames_ > 0 && base.stamp < next_) return;
      const Duration period = Duration::seconds(1.0 / parameters_.camera_rate_hz);
      next_ = (frames_ == 0 ? base.stamp : std::max(next_, base.stamp - period)) + period;
      expose(base);
      ++frames_;
    });
  }

 private:
  void expose(const BaseOdometry& base) {
    const Eigen::Isometry3d X_FC = geometry::to_isometry(base.X_FB) * tool_.cameras.front().X_BC;
    if (!parameters_.render) {
      truth_.publish(true_instances(base.stamp, X_FC, nullptr));
      return;
    }
    const simulation::Frame frame = scene_->render(*camera_, X_FC, frames_);
    truth_.publish(
        true_instances(base.stamp, X_FC, parameters_.true_masks ? &frame.plant_index : nullptr));
    info_.publish(to_msg(camera_->intrinsics(), base.stamp));
    depth_.publish(to_msg(frame.depth_m, base.stamp, kCameraFrame));
    image_.publish(to_msg(frame.bgr, base.stamp, kCameraFrame));
    context_.count("images");
  }

  // Plants are sorted by x: only those near the camera are visited.
  [[nodiscard]] furrow_msgs::msg::PlantInstances true_instances(Time stamp,
                                                                const Eigen::Isometry3d& X_FC,
                                                                const cv::Mat* plant_index) const {
    furrow_msgs::msg::PlantInstances message;
    message.header(header(stamp, kCameraFrame));
    const auto& plants = scene_->field().plants;
    const Eigen::Isometry3d X_CF = X_FC.inverse();
    const double centre_x_m = X_FC.translation().x();
    constexpr double kReach_m = 3.0;
    const auto shown =
        plant_index == nullptr ? std::map<std::int32_t, cv::Rect>() : boxes_of_plants(*plant_index);
    const auto x_of = [](const field::Plant& plant) { return plant.p_F_m.x(); };
    const auto first = std::ranges::lower_bound(plants, centre_x_m - kReach_m, {}, x_of);
    for (auto plant = first; plant != plants.end() && plant->p_F_m.x() < centre_x_m + kReach_m;
         ++plant) {
      const Eigen::Vector3d p_C = X_CF * Eigen::Vector3d(plant->p_F_m.x(), plant->p_F_m.y(), 0.0);
      const auto pixel = camera_->project(p_C);
      if (!pixel || !camera_->in_image(*pixel)) continue;
      message.instances().push_back(true_instance(*plant, p_C, *pixel));
      if (plant_index != nullptr) {
        const auto index = static_cast<std::int32_t>(plant - plants.begin());
        const auto box = shown.find(index);
        show(box == shown.end() ? cv::Rect() : box->second, index, *plant_index,
             message.instances().back());
      }
    }
    return message;
  }

  static std::map<std::int32_t, cv::Rect> boxes_of_plants(const cv::Mat& plant_index) {
    std::map<std::int32_t, cv::Rect> boxes;
    for (int v = 0; v < plant_index.rows; ++v) {
      const auto* row = plant_index.ptr<std::int32_t>(v);
      for (int first = 0, end = 0; first < plant_index.cols; first = end) {
        end = first + 1;
        while (end < plant_index.cols && row[end] == row[first]) ++end;
        if (row[first] >= 0) boxes[row[first]] |= cv::Rect(first, v, end - first, 1);
      }
    }
    return boxes;
  }

  static void show(const cv::Rect& box, std::int32_t index, const cv::Mat& plant_index,
                   furrow_msgs::msg::PlantInstance& instance) {
    instance.box().x_offset(static_cast<std::uint32_t>(box.x));
    instance.box().y_offset(static_cast<std::uint32_t>(box.y));
    instance.box().width(static_cast<std::uint32_t>(box.width));
    instance.box().height(static_cast<std::uint32_t>(box.height));
    if (!box.empty()) instance.mask_runs(mask_runs(plant_index(box) == index));
  }

  [[nodiscard]] furrow_msgs::msg::PlantInstance true_instance(const field::Plant& plant,
                                                              const Eigen::Vector3d& p_C,
                                                              const Eigen::Vector2d& pixel) const {
    furrow_msgs::msg::PlantInstance instance;
    instance.score(1.0F);
    instance.crop_probability(plant.kind == field::PlantKind::kCrop ? 1.0F : 0.0F);
    if (!plant.species.empty()) {
      auto& species = instance.species().emplace_back();
      species.species(plant.species);
      species.crop(plant.kind == field::PlantKind::kCrop);
      species.probability(1.0F);
    }
    const auto& size = camera_->intrinsics();
    const double radius_px = plant.radius_m * size.fx_px / p_C.z();
    const int left = std::clamp(static_cast<int>(pixel.x() - radius_px), 0, size.width_px - 1);
    const int top = std::clamp(static_cast<int>(pixel.y() - radius_px), 0, size.height_px - 1);
    const int right = std::clamp(static_cast<int>(pixel.x() + radius_px), left, size.width_px - 1);
    const int bottom = std::clamp(static_cast<int>(pixel.y() + radius_px), top, size.height_px - 1);
    instance.box().x_offset(static_cast<std::uint32_t>(left));
    instance.box().y_offset(static_cast<std::uint32_t>(top));
    instance.box().width(static_cast<std::uint32_t>(right - left + 1));
    instance.box().height(static_cast<std::uint32_t>(bottom - top + 1));
    instance.stem_u_px(pixel.x());
    instance.stem_v_px(pixel.y());
    instance.stem(to_point(p_C));
    instance.radius_m(plant.radius_m);
    instance.area_mm2(plant.area_mm2);
    instance.leaves(static_cast<std::uint8_t>(std::clamp(plant.leaves, 0, 255)));
    return instance;
  }

  graph::Context& context_;
  Parameters parameters_;
  geometry::ToolModel tool_;
  std::unique_ptr<simulation::Scene> scene_;
  std::optional<geometry::PinholeCamera> camera_;
  graph::Output<topics::TrueInstances> truth_;
  graph::Output<topics::CameraImage> image_;
  graph::Output<topics::CameraDepth> depth_;
  graph::Output<topics::CameraInfo> info_;
  Time next_;
  std::uint64_t frames_ = 0;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::CameraSimulator>("camera_simulator");
}
