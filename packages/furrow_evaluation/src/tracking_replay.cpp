#include "furrow_evaluation/tracking_replay.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <memory>

#include "furrow_components/rendered_dataset.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_tracking/pose_correction.hpp"

namespace furrow::evaluation {
namespace {

using components::BaseOdometry;

constexpr double kSamePlant_m = 0.025;

localization::PoseFilterParameters filter_for(const ReplayOptions& options) {
  localization::PoseFilterParameters filter = options.filter;
  filter.use_odometry = options.pose != PoseSource::kGnss;
  filter.use_imu = options.pose != PoseSource::kGnss;
  filter.use_gnss = options.pose != PoseSource::kOdometry;
  return filter;
}

class Replay {
 public:
  Replay(const SensingLog& log, const geometry::CameraModel& camera, const ReplayOptions& options)
      : log_(log),
        camera_model_(camera),
        camera_(camera.intrinsics),
        options_(options),
        georeference_(options.georeference),
        filter_(filter_for(options)),
        tracker_(options.tracker),
        // Similarity 0.5, from which on the scores accept a pair, lies at kSamePlant_m.
        evaluation_(2.0 * kSamePlant_m) {
    for (const field::Plant& plant : log.field.plants) plants_[plant.id] = &plant;
  }

  ReplayResult run() {
    for (const SensingLog::Event& event : log_.events) {
      std::visit([this](const auto& message) { take(*message); }, event);
    }
    keep(tracker_.tracks());
    count();
    result_.scores = evaluation_.scores();
    return std::move(result_);
  }

 private:
  void take(const nav_msgs::msg::Odometry& message) {
    const BaseOdometry wheels = components::from_msg(message);
    if (!started_) start(wheels.stamp);
    const auto& told = message.twist().covariance();
    localization::WheelOdometry measurement{wheels.stamp, wheels.speed_mps, wheels.yaw_rate_radps};
    if (told[0] > 0.0) measurement.speed_variance = told[0];
    if (told[35] > 0.0) measurement.yaw_rate_variance = told[35];
    filter_.add(measurement);
    follow(wheels.stamp);
    while (!waiting_.empty() && stamp_of(*waiting_.front()) <= wheels.stamp) {
      track(*waiting_.front());
      waiting_.pop_front();
    }
  }
  void take(const sensor_msgs::msg::Imu& message) {
    localization::ImuYawRate measurement{graph::from_msg(message.header().stamp()),
                                         message.angular_velocity().z()};
    if (const double told = message.angular_velocity_covariance()[8]; told > 0.0) {
      measurement.yaw_rate_variance = told;
    }
    filter_.add(measurement);
  }
  void take(const sensor_msgs::msg::NavSatFix& message) {
    filter_.add(georeference_.from_msg(message));
  }
  void take(const furrow_msgs::msg::PlantInstances& message) { waiting_.push_back(&message); }

  // The ground truth needs no correction.
  void follow(Time stamp) {
    if (options_.pose == PoseSource::kTruth) return;
    if (const auto pose = filter_.predict(stamp); pose.ok()) {
      (void)correction_.add(stamp, pose->X_FB, pose->speed_mps, pose->yaw_rate_radps);
    }
  }

  // All begin where the robot truly stands, as well as it is known of a row's start.
  void start(Time stamp) {
    started_ = true;
    const double position_m = options_.filter.initial_position_sigma_m;
    const double heading_rad = options_.filter.initial_heading_sigma_rad;
    const Eigen::Matrix3d covariance =
        Eigen::Vector3d(position_m * position_m, position_m * position_m, heading_rad * heading_rad)
            .asDiagonal();
    const Status reset = filter_.reset(stamp, truth_at(stamp).X_FB, covariance);
    if (!reset.ok()) throw ConfigError(reset.error().message);
  }

  [[nodiscard]] static Time stamp_of(const furrow_msgs::msg::PlantInstances& message) {
    return graph::from_msg(message.header().stamp());
  }
  [[nodiscard]] const BaseOdometry& truth_at(Time stamp) const {
    const auto at = std::ranges::lower_bound(log_.truth, stamp, {}, &BaseOdometry::stamp);
    return at == log_.truth.end() ? log_.truth.back() : *at;
  }

  [[nodiscard]] Result<localization::PoseEstimate> pose_at(Time stamp) const {
    if (options_.pose != PoseSource::kTruth) return filter_.predict(stamp);
    return localization::PoseEstimate{.stamp = stamp, .X_FB = truth_at(stamp).X_FB};
  }

  void track(const furrow_msgs::msg::PlantInstances& message) {
    const Time stamp = stamp_of(message);
    const auto pose = pose_at(stamp);
    if (!pose.ok()) {
      ++result_.frames_without_pose;
      return;
    }
    const Eigen::Isometry3d X_FC = geometry::to_isometry(pose->X_FB) * camera_model_.X_BC;
    tracking::View view{.stamp = stamp,
                        .X_FB = pose->X_FB,
                        .pose_covariance = pose->covariance,
                        .correction = correction_.pending()};
    if (auto visible = tracking::visible_ground(camera_, X_FC); visible.ok()) {
      view.visible = std::move(visible).value();
    }
    std::vector<tracking::Observation> observations;
    for (const auto& instance : message.instances()) {
      auto seen = components::observe(instance, camera_, X_FC, options_.observation);
      if (seen.ok()) observations.push_back(std::move(seen).value());
    }
    if (tracker_.update(view, observations).fault == tracking::ViewFault::kNone) {
      correction_.clear();
    }
    keep(tracker_.ended());
    compare(view, truth_at(stamp));
  }

  void keep(std::span<const tracking::Track> tracks) {
    for (const tracking::Track& track : tracks) {
      if (track.confirmed && track.end_reason != tracking::EndReason::kMerged) {
        result_.tracks.push_back(track);
      }
    }
  }

  void compare(const tracking::View& view, const BaseOdometry& truth) {
    const geometry::Pose2& true_X_FB = truth.X_FB;
    result_.position_errors_mm.push_back(
        1e3 * std::hypot(view.X_FB.x_m - true_X_FB.x_m, view.X_FB.y_m - true_X_FB.y_m));
    result_.heading_errors_rad.push_back(
        geometry::wrap_angle_rad(view.X_FB.heading_rad - true_X_FB.heading_rad));

    const Eigen::Isometry3d X_FC = geometry::to_isometry(true_X_FB) * camera_model_.X_BC;
    const auto seen = tracking::visible_ground(camera_, X_FC);
    if (!seen.ok()) return;
    truth_points_.clear();
    for (const field::Plant& plant : log_.field.plants) {
      if (seen->contains(plant.p_F_m)) truth_points_.push_back({plant.id, plant.p_F_m});
    }
    // From the estimated pose to the true one: what is left is the tracker's.
    const geometry::Pose2 correction = geometry::compose(true_X_FB, geometry::inverse(view.X_FB));
    track_points_.clear();
    for (const tracking::Track& track : tracker_.tracks()) {
      const Eigen::Vector2d p_F = geometry::transform(correction, track.p_F_m);
      if (track.confirmed && seen->contains(p_F)) {
        track_points_.push_back({static_cast<std::int64_t>(track.id), p_F});
      }
    }
    (void)evaluation_.add_frame(truth_points_, track_points_);
  }

  void count() {
    std::map<std::int64_t, const tracking::Track*> by_id;
    for (const tracking::Track& track : result_.tracks) {
      by_id[static_cast<std::int64_t>(track.id)] = &track;
      if (track.p_F_m.x() < 0.0 || track.p_F_m.x() > log_.field.length_m) continue;
      const bool crop = track.plant_class() == tracking::PlantClass::kCrop;
      ++(crop ? result_.crops : result_.weeds).counted;
    }
    for (std::size_t i = 0; i < log_.field.plants.size(); ++i) {
      const bool crop = log_.field.plants[i].kind == field::PlantKind::kCrop;
      PlantCounts& counts = crop ? result_.crops : result_.weeds;
      ++counts.all;
      if (log_.most_visible_px[i] >= components::kLeastVisible_px) ++counts.visible;
    }
    for (const tracking::IdentityPair& pair : evaluation_.identity_pairs()) {
      const auto found = by_id.find(pair.track_id);
      if (found == by_id.end()) continue;
      result_.stem_errors_mm.push_back(
          1e3 * (found->second->p_F_m - plants_.at(pair.truth_id)->p_F_m).norm());
    }
  }

  const SensingLog& log_;
  const geometry::CameraModel& camera_model_;
  geometry::PinholeCamera camera_;
  const ReplayOptions& options_;
  components::Georeference georeference_;
  localization::PoseFilter filter_;
  tracking::PoseCorrection correction_;
  tracking::Tracker tracker_;
  tracking::TrackingEvaluation evaluation_;
  bool started_ = false;
  std::deque<const furrow_msgs::msg::PlantInstances*> waiting_;
  std::map<std::int64_t, const field::Plant*> plants_;
  std::vector<tracking::LabelledPoint> truth_points_;
  std::vector<tracking::LabelledPoint> track_points_;
  ReplayResult result_;
};

}  // namespace

std::string_view to_string(PoseSource source) {
  switch (source) {
    case PoseSource::kOdometry:
      return "odometry";
    case PoseSource::kGnss:
      return "gnss";
    case PoseSource::kFused:
      return "fused";
    case PoseSource::kTruth:
      break;
  }
  return "truth";
}

ReplayResult replay_tracking(const SensingLog& log, const geometry::CameraModel& camera,
                             const ReplayOptions& options) {
  return Replay(log, camera, options).run();
}

}  // namespace furrow::evaluation
