#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_geometry/camera.hpp"
#include "furrow_geometry/tool_model.hpp"

namespace furrow::diagnosis {

/// What a topic carries for Furrow, in the order of reports.
enum class Role : std::uint8_t { kImage, kCameraInfo, kDepth, kWheels, kImu, kGnss, kOther };

/// A writer of another process on an input's topic.
struct ObservedWriter {
  std::string process;
  std::string type;             ///< ROS name
  std::string incompatibility;  ///< policies with offered and requested value; empty: compatible
};

/// The times of one message, all as Unix time.
struct MessageTimes {
  Time stamp;    ///< of the header, by the driver's clock
  Time sent;     ///< by the clock of the writer's host; zero: unknown
  Time arrival;  ///< by the clock of this host
};

/// One input as the domain shows it.
struct TopicObservation {
  std::string topic;
  Role role = Role::kOther;
  std::string type;     ///< the wanted one, ROS name
  std::string readers;  ///< the components that need it, for texts
  bool required = false;
  std::vector<ObservedWriter> writers;
  std::vector<std::string> alternatives;  ///< other topics of this type that have a writer
  std::vector<MessageTimes> times;        ///< in the order of arrival; bounded
  std::string frame;                      ///< frame_id of the newest message
  std::uint64_t messages = 0;
  std::uint64_t malformed = 0;  ///< of these, messages that are no CDR form of the type
};

struct ImageObservation {
  int width_px = 0;
  int height_px = 0;
  std::string encoding;
  std::string problem;   ///< why perception cannot use it; empty: it can
  bool grey = false;     ///< the encoding has no colour
  bool uniform = false;  ///< all bytes are equal
};

struct CalibrationObservation {
  geometry::CameraIntrinsics intrinsics;  ///< after region of interest and binning
  std::string problem;                    ///< why the distortion model is not usable; or empty
};

struct DepthObservation {
  int width_px = 0;
  int height_px = 0;
  std::string encoding;
  std::string problem;             ///< why perception cannot use it; empty: it can
  std::optional<double> median_m;  ///< of the known depths, with the unit of the graph
};

struct ImuSample {
  Time arrival;
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_mps2 = Eigen::Vector3d::Zero();
  bool rate_unknown = false;  ///< the first covariance is -1 (REP 145)
};

struct WheelSample {
  Time stamp;
  Time arrival;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
};

struct GnssSample {
  Time arrival;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double altitude_m = 0.0;
  int status = 0;  ///< NavSatStatus: -1 no fix, 0 plain, 1 satellite, 2 ground augmented
  bool covariance_known = false;
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
  Eigen::Vector2d p_FA_m = Eigen::Vector2d::Zero();  ///< antenna in the field frame
};

/// All that was observed in some seconds.
struct Observations {
  double seconds = 0.0;
  bool only_this_host = false;  ///< processes of other hosts could not be found
  std::vector<TopicObservation> topics;
  std::optional<ImageObservation> image;
  std::optional<CalibrationObservation> calibration;
  std::optional<DepthObservation> depth;
  std::vector<ImuSample> imu;
  std::vector<WheelSample> wheels;
  std::string wheels_child_frame;
  std::vector<GnssSample> gnss;

  /// The first topic of the role; null: the graph does not read it.
  [[nodiscard]] const TopicObservation* find(Role role) const;
};

/// What the graph and its URDF say about the sensors.
struct Expectation {
  std::optional<geometry::CameraModel> camera;
  std::string base_link = "base_link";
  double ground_distance_m = 1.0;  ///< perception's
  double depth_unit_m = 0.001;
  double depth_tolerance_s = 0.02;
  bool grey_is_refused = false;   ///< the detector needs colour
  double max_field_m = 10'000.0;  ///< farther from the origin, positions are refused
};

}  // namespace furrow::diagnosis
