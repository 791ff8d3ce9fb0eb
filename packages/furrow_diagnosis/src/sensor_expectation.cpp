#include "furrow_diagnosis/sensor_expectation.hpp"

#include <algorithm>

#include "furrow_components/conversions.hpp"
#include "furrow_graph/graph_check.hpp"
#include "furrow_msgs/topics.hpp"

namespace furrow::diagnosis {
namespace {

namespace topics = msgs::topics;

Role role_of(const std::string& port) {
  const std::pair<std::string_view, Role> roles[] = {
      {topics::CameraImage::topic().name, Role::kImage},
      {topics::CameraInfo::topic().name, Role::kCameraInfo},
      {topics::CameraDepth::topic().name, Role::kDepth},
      {topics::WheelOdometry::topic().name, Role::kWheels},
      {topics::Imu::topic().name, Role::kImu},
      {topics::GnssFix::topic().name, Role::kGnss}};
  for (const auto& [name, role] : roles) {
    if (name == port) return role;
  }
  return Role::kOther;
}

/// The parameters of the first component of a class, given or by default.
class ComponentParameters {
 public:
  ComponentParameters(const graph::GraphSpec& graph, graph::Registry& registry,
                      const std::string& class_name) {
    const auto component =
        std::ranges::find(graph.components, class_name, &graph::ComponentSpec::class_name);
    if (component == graph.components.end()) return;
    const auto& description = registry.find(class_name, component->where).description;
    for (const DeclaredParameter& declared : description.declared_parameters_list()) {
      values_.push_back({declared.info.name, declared.default_value, {}});
    }
    for (const GivenParameter& given : graph::parameters_of(*component, graph, description)) {
      const auto value = std::ranges::find(values_, given.name, &GivenParameter::name);
      if (value != values_.end()) *value = given;
    }
  }

  [[nodiscard]] bool exists() const { return !values_.empty(); }
  template <class T>
  void read(const std::string& name, T& target) const {
    const auto it = std::ranges::find(values_, name, &GivenParameter::name);
    if (it == values_.end()) return;
    if (const T* value = std::get_if<T>(&it->value)) target = *value;
    if constexpr (std::is_same_v<T, double>) {
      // An integer is accepted where a number is declared.
      if (const auto* integer = std::get_if<std::int64_t>(&it->value)) {
        target = static_cast<double>(*integer);
      }
    }
  }

 private:
  std::vector<GivenParameter> values_;
};

}  // namespace

SensorSetup sensor_setup(const graph::GraphSpec& graph, const geometry::ToolModel& tool,
                         graph::Registry& registry) {
  SensorSetup setup;
  Expectation& expected = setup.expectation;
  const ComponentParameters perception(graph, registry, "perception");
  bool use_depth = true;
  std::string detector;
  perception.read("use_depth", use_depth);
  perception.read("detector", detector);
  perception.read("ground_distance_m", expected.ground_distance_m);
  perception.read("depth_unit_m", expected.depth_unit_m);
  perception.read("depth_tolerance_s", expected.depth_tolerance_s);
  perception.read("rectified", setup.rectified);
  expected.grey_is_refused = detector == "index";
  expected.max_field_m = components::kMaxField_m;
  if (!tool.base_link.empty()) expected.base_link = tool.base_link;
  if (!tool.cameras.empty()) expected.camera = tool.cameras.front();
  const ComponentParameters localization(graph, registry, "localization");
  auto& place = setup.georeference;
  localization.read("origin_latitude_deg", place.origin_latitude_deg);
  localization.read("origin_longitude_deg", place.origin_longitude_deg);
  localization.read("origin_altitude_m", place.origin_altitude_m);
  localization.read("row_angle_deg", place.row_angle_deg);
  for (launch::ExternalInput& input : launch::external_inputs(graph, registry)) {
    const Role role = role_of(input.port);
    if (role == Role::kDepth && !use_depth) continue;
    setup.inputs.push_back({std::move(input), role});
  }
  std::ranges::stable_sort(setup.inputs, {}, &SensorInput::role);
  return setup;
}

}  // namespace furrow::diagnosis
