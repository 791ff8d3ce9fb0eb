#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "furrow_components/conversions.hpp"
#include "furrow_field/field_model.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::evaluation {

/// Messages of the sensors and of the detector in one run over a field, in the order of arrival,
/// with the ground truth. Localization and tracking are tried on it without rendering again.
struct SensingLog {
  using Wheels = std::shared_ptr<const nav_msgs::msg::Odometry>;
  using Imu = std::shared_ptr<const sensor_msgs::msg::Imu>;
  using Gnss = std::shared_ptr<const sensor_msgs::msg::NavSatFix>;
  using Instances = std::shared_ptr<const furrow_msgs::msg::PlantInstances>;
  using Event = std::variant<Wheels, Imu, Gnss, Instances>;

  field::FieldModel field;
  std::vector<components::BaseOdometry> truth;  ///< in the order of time
  /// Beside field.plants: the most pixels that one image shows of the plant, its stem in the image.
  std::vector<std::int64_t> most_visible_px;
  std::vector<Event> events;
};

struct SensingOptions {
  std::string graph = "sensing";
  std::vector<std::string> settings;  ///< COMPONENT.KEY=VALUE
  std::uint64_t seed = 1;
  int threads = 2;
  std::function<void(double)> progress;  ///< 0 to 1; may be empty
};

/// Runs the graph in lock-step. Throws ConfigError for what is asked wrongly, std::runtime_error
/// when the run fails.
[[nodiscard]] SensingLog record_sensing(const SensingOptions& options);

}  // namespace furrow::evaluation
