#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "furrow_components/conversions.hpp"
#include "furrow_components/observation_conversion.hpp"
#include "furrow_components/pose_buffer.hpp"
#include "furrow_components/species_names.hpp"
#include "furrow_components/track_conversion.hpp"
#include "furrow_components/track_field.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_tracking/pose_correction.hpp"
#include "furrow_tracking/tracker.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

struct Parameters {
  std::string tool_file;
  double max_wait_s = 0.5;
  std::int64_t max_empty_views = 30;
  ObservationParameters observation;
  TrackFieldParameters field;
  tracking::TrackerParameters tracker;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "tool_file", .description = "URDF of robot and tool"}, tool_file);
    v.visit({.name = "max_wait_s",
             .unit = "s",
             .description = "images without a pose for this long are dropped",
             .min = 0.01,
             .max = 10.0},
            max_wait_s);
    v.visit({.name = "max_empty_views",
             .description = "images in a row without a plant after which the health is a warning",
             .min = 1,
             .max = 1e6},
            max_empty_views);
    observation.visit(v);
    field.visit(v);
    tracker.visit(v);
  }
};

const geometry::CameraModel& first_camera(const geometry::ToolModel& tool) {
  if (tool.cameras.empty()) throw ConfigError("the tool has no camera");
  return tool.cameras.front();
}

/// Tracks the plants of the images in the field frame. Tracks have the stamp of the newest image
/// that was used. After an image that was not, their age is visible to planner and drivers.
class TrackerComponent final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Tracks plants over images: refines positions, fuses classes, confirms or deletes.")
        .parameters<Parameters>()
        .input<topics::RobotOdometry>()
        .input<topics::Instances>()
        .input<topics::RunStatus>(graph::Need::kOptional)
        .output<topics::Tracks>();
  }

  explicit TrackerComponent(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<Parameters>()),
        tool_(geometry::load_tool_model(parameters_.tool_file)),
        camera_model_(first_camera(tool_)),
        camera_(camera_model_.intrinsics),
        tracker_(parameters_.tracker),
        out_(context.output<topics::Tracks>()) {
    context.input<topics::RobotOdometry>([this](const auto& message) {
      const BaseOdometry odometry = from_msg(*message);
      if (poses_.add(odometry).ok()) {
        remember_covariance(*message);
        (void)correction_.add(odometry.stamp, odometry.X_FB, odometry.speed_mps,
                              odometry.yaw_rate_radps);
      } else {
        context_.count("bad_odometry");
        warn("odometry is not finite or goes back in time; it was not used");
      }
      use_waiting();
    });
    context.input<topics::Instances>([this](const auto& message) {
      waiting_.push_back(message);
      if (waiting_.size() > kMaxWaiting) drop_oldest("no odometry at the stamp of an image");
      use_waiting();
    });
    context.every(Duration::seconds(0.5 * parameters_.max_wait_s),
                  [this](Time now) { drop_overdue(now); });
    context.input<topics::RunStatus>([this](const auto& status) {
      if (status->finished() && !parameters_.field.field_model_file.empty()) save_field();
    });
  }

 private:
  static constexpr std::size_t kMaxWaiting = 8;
  static constexpr std::size_t kMaxCovariances = 512;
  static constexpr std::size_t kMaxDeleted = 1'000'000;

  void warn(const std::string& what) { context_.health(graph::HealthLevel::kWarn, what); }

  void drop_oldest(const std::string& why) {
    waiting_.pop_front();
    context_.count("images_without_pose");
    warn(why + "; the image was not used");
    publish();
  }

  void drop_overdue(Time now) {
    const Duration longest = Duration::seconds(parameters_.max_wait_s);
    while (!waiting_.empty() &&
           now - graph::from_msg(waiting_.front()->header().stamp()) > longest) {
      drop_oldest("no odometry at the stamp of an image");
    }
  }

  void remember_covariance(const nav_msgs::msg::Odometry& message) {
    covariances_.emplace_back(graph::from_msg(message.header().stamp()),
                              planar_covariance(message));
    if (covariances_.size() > kMaxCovariances) covariances_.pop_front();
  }

  // The covariance of the newest pose not after the stamp.
  [[nodiscard]] Eigen::Matrix3d covariance_at(Time stamp) const {
    const auto after = std::ranges::upper_bound(covariances_, stamp, {},
                                                [](const auto& entry) { return entry.first; });
    return after == covariances_.begin() ? covariances_.front().second : std::prev(after)->second;
  }

  // An image waits for odometry that is newer than its stamp.
  void use_waiting() {
    while (!waiting_.empty() && !poses_.empty()) {
      const Time stamp = graph::from_msg(waiting_.front()->header().stamp());
      if (stamp > poses_.newest().stamp) return;
      const auto message = waiting_.front();
      const auto pose = poses_.at(stamp);
      if (!pose.ok()) {
        drop_oldest(pose.error().message);
        continue;
      }
      waiting_.pop_front();
      update(*message, *pose);
    }
  }

  void update(const furrow_msgs::msg::PlantInstances& message, const BaseOdometry& pose) {
    const Eigen::Isometry3d X_FC = geometry::to_isometry(pose.X_FB) * camera_model_.X_BC;
    tracking::View view{.stamp = pose.stamp,
                        .X_FB = pose.X_FB,
                        .pose_covariance = covariance_at(pose.stamp),
                        .correction = correction_.pending()};
    if (auto visible = tracking::visible_ground(camera_, X_FC); visible.ok()) {
      view.visible = std::move(visible).value();
    }
    std::vector<tracking::Observation> observations;
    for (const auto& instance : message.instances()) {
      if (auto seen = observe(instance, camera_, X_FC, parameters_.observation); seen.ok()) {
        seen->species_probability = species_of(instance);
        observations.push_back(std::move(seen).value());
      } else {
        context_.warn("bad_instances", seen.error().message + "; the plant was not tracked");
      }
    }
    const tracking::UpdateSummary summary = tracker_.update(view, observations);
    context_.count("matched", summary.matched);
    context_.count("born", summary.born);
    context_.count("confirmed", summary.confirmed);
    context_.count("dropped", summary.dropped);
    if (summary.fault == tracking::ViewFault::kNone) {
      newest_used_ = pose.stamp;
      correction_.clear();
      empty_views_ = summary.empty_view ? empty_views_ + 1 : 0;
      if (summary.empty_view) context_.count("empty_views");
      if (summary.repeated_view) context_.count("repeated_views");
    }
    report(summary);
    if (!parameters_.field.field_model_file.empty()) keep_deleted();
    publish();
  }

  void report(const tracking::UpdateSummary& summary) {
    if (!summary.ok()) {
      context_.count("bad_views");
      warn("an image or a plant of it was invalid; it was not used");
    } else if (empty_views_ >= parameters_.max_empty_views) {
      warn("no plant in " + std::to_string(empty_views_) + " images in a row; nothing is tracked");
    } else {
      context_.health(graph::HealthLevel::kOk, "");
    }
  }

  void keep_deleted() {
    for (const tracking::Track& track : tracker_.ended()) {
      if (!track.confirmed || track.end_reason == tracking::EndReason::kMerged) continue;
      if (deleted_.size() < kMaxDeleted) deleted_.push_back(track);
    }
  }

  void save_field() {
    std::vector<tracking::Track> all = deleted_;
    all.insert(all.end(), tracker_.tracks().begin(), tracker_.tracks().end());
    const field::FieldModel field = field_of_tracks(all, species_, parameters_.field);
    if (const Status saved = write_field(field, parameters_.field.field_model_file); !saved.ok()) {
      context_.health(graph::HealthLevel::kError,
                      saved.error().message + "; the field was not saved");
      context_.count("fields_not_saved");
    }
  }

  std::vector<float> species_of(const furrow_msgs::msg::PlantInstance& instance) {
    bool overflow = false;
    std::vector<float> probability = species_.take(instance.species(), overflow);
    if (overflow) {
      context_.warn("species_beyond_the_limit", "more than " + std::to_string(SpeciesNames::kMost) +
                                                    " species; the others count as unknown");
    }
    return probability;
  }

  void publish() const {
    if (!newest_used_) return;
    furrow_msgs::msg::Tracks message;
    message.header(header(*newest_used_, kFieldFrame));
    for (const tracking::Track& track : tracker_.tracks()) {
      message.tracks().push_back(to_msg(track, species_));
    }
    // A deleted track is published once more, so that its readers can forget it.
    for (const tracking::Track& track : tracker_.ended()) {
      message.tracks().push_back(to_msg(track, species_));
    }
    out_.publish(std::move(message));
  }

  graph::Context& context_;
  Parameters parameters_;
  geometry::ToolModel tool_;
  const geometry::CameraModel& camera_model_;
  geometry::PinholeCamera camera_;
  tracking::Tracker tracker_;
  graph::Output<topics::Tracks> out_;
  PoseBuffer poses_{Duration::seconds(5.0)};
  tracking::PoseCorrection correction_;
  std::optional<Time> newest_used_;  ///< stamp of the newest view that was used
  std::int64_t empty_views_ = 0;     ///< in a row
  std::deque<std::shared_ptr<const furrow_msgs::msg::PlantInstances>> waiting_;
  std::deque<std::pair<Time, Eigen::Matrix3d>> covariances_;
  std::vector<tracking::Track> deleted_;  ///< for the field model; empty where none is saved
  SpeciesNames species_;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::TrackerComponent>("tracker");
}
