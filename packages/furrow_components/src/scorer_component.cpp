#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "furrow_components/conversions.hpp"
#include "furrow_components/georeference.hpp"
#include "furrow_components/pose_buffer.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/enums.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

struct Parameters {
  std::string tool_file;
  double path_step_m = 0.02;
  GeoreferenceParameters georeference;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "tool_file", .description = "URDF of robot and tool"}, tool_file);
    v.visit({.name = "path_step_m",
             .unit = "m",
             .description = "distance between the points of a drawn path",
             .min = 0.001,
             .max = 1.0},
            path_step_m);
    georeference.visit(v);
  }
};

/// Collects the input of the ledger, and publishes it when the run is finished.
class Scorer final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Collects plants, decisions, sprays and paths; publishes the record at the end.")
        .parameters<Parameters>()
        .shared_parameters(GeoreferenceParameters::names())
        .input<topics::TrueField>(graph::Need::kOptional)
        .input<topics::TrueOdometry>(graph::Need::kOptional)
        .input<topics::TrueSpray>(graph::Need::kOptional)
        .input<topics::RobotOdometry>()
        .input<topics::Tracks>()
        .input<topics::Plan>()
        .input<topics::AxisEvent>(graph::Need::kOptional)
        .input<topics::AxisState>(graph::Need::kOptional)
        .input<topics::RunStatus>(graph::Need::kOptional)
        .output<topics::RunRecord>();
  }

  explicit Scorer(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<Parameters>()),
        tool_(geometry::load_tool_model(parameters_.tool_file)),
        out_(context.output<topics::RunRecord>()) {
    for (const geometry::AxisModel& axis : tool_.axes) {
      record_.paths().emplace_back().axis(axis.name);
    }
    context.input<topics::TrueField>([this](const auto& field) {
      record_.field(*field);
      field_known_ = true;
    });
    // Without it no landing of a spray is simulated.
    context.input<topics::TrueOdometry>([this](const auto&) { landing_known_ = true; });
    context.input<topics::TrueSpray>([this](const auto& spray) {
      if (bounded(record_.sprays())) record_.sprays().push_back(*spray);
    });
    context.input<topics::RobotOdometry>(
        [this](const auto& message) { drive(from_msg(*message)); });
    context.input<topics::Tracks>([this](const auto& message) {
      for (const auto& track : message->tracks()) take(track);
    });
    context.input<topics::Plan>([this](const auto& plan) {
      for (const auto& decision : plan->decisions()) {
        if (known(decision.decision())) take(decision);
      }
    });
    context.input<topics::AxisEvent>([this](const auto& event) {
      if (known(event->event()) && known(event->cause()) && bounded(record_.events())) {
        record_.events().push_back(*event);
      }
    });
    context.input<topics::AxisState>([this](const auto& state) { move(*state); });
    context.input<topics::RunStatus>([this](const auto& status) {
      if (status->finished()) finish(*status);
    });
  }

 private:
  // Far above any run: bounds the memory.
  static constexpr std::size_t kMaxEntries = 2'000'000;

  /// Whether an enumeration holds one of its constants.
  template <class Enumeration>
  bool known(const Enumeration& message) {
    const auto value = msgs::from_msg(message);
    if (!value.ok()) {
      context_.warn("unknown_values", value.error().message + "; it is not in the ledger");
    }
    return value.ok();
  }

  template <class T>
  bool bounded(const std::vector<T>& list) {
    if (list.size() < kMaxEntries) return true;
    context_.warn("entries_beyond_the_limit",
                  "the record is full; later sprays, events and paths are not in the ledger");
    return false;
  }

  void take(const furrow_msgs::msg::Track& track) {
    if (in_field(track.position().x(), track.position().y())) {
      tracks_[track.id()] = track;
    } else {
      context_.warn("bad_tracks", "position of track " + std::to_string(track.id()) +
                                      " is not finite or outside of the field; the ledger has "
                                      "no line for it");
    }
  }

  /// Keeps the first of equal decisions in a row, which has the time of the change, and the last.
  void take(const furrow_msgs::msg::Decision& decision) {
    auto& history = decisions_[decision.track_id()];
    const auto same = [&](const furrow_msgs::msg::Decision& other) {
      return other.decision() == decision.decision() && other.axis() == decision.axis();
    };
    const std::size_t size = history.size();
    if (size >= 2 && same(history[size - 1]) && same(history[size - 2])) {
      history.back() = decision;
    } else if (decision_count_ < kMaxEntries) {
      history.push_back(decision);
      ++decision_count_;
    } else {
      context_.warn("entries_beyond_the_limit",
                    "the record has too many decisions; the newest "
                    "are not in the ledger");
    }
  }

  void drive(const BaseOdometry& base) {
    if (!first_) {
      if (!in_field(base.X_FB.x_m, base.X_FB.y_m)) {
        context_.request_stop(context_.name() + ": " +
                              outside_field("localization/odometry", base.X_FB) +
                              " Publish it relative to a place in the field");
        return;
      }
      first_ = base;
    }
    // A pose that is refused below must not spoil the distance.
    const bool usable = in_field(base.X_FB.x_m, base.X_FB.y_m);
    if (usable && newest_) {
      way_m_ += std::hypot(base.X_FB.x_m - newest_->X_FB.x_m, base.X_FB.y_m - newest_->X_FB.y_m);
    }
    if (usable) newest_ = base;
    if (const Status added = poses_.add(base); !added.ok()) {
      context_.warn("bad_odometry", added.error().message + "; it was not used");
    }
  }

  void move(const furrow_msgs::msg::AxisState& state) {
    const auto axis = std::ranges::find(tool_.axes, state.axis(), &geometry::AxisModel::name);
    if (axis == tool_.axes.end() || poses_.empty()) return;
    auto& path = record_.paths()[static_cast<std::size_t>(axis - tool_.axes.begin())];
    path.travel_m(state.travel_m());
    states_[state.axis()] = state;
    const Time stamp = graph::from_msg(state.header().stamp());
    const auto base = poses_.at(stamp, Duration::seconds(0.1));
    if (!base.ok()) return;
    const Eigen::Vector2d p_F =
        geometry::transform(base->X_FB, axis->nozzle_position_B(state.position_m()).head<2>());
    const bool far =
        path.points().empty() ||
        (from_point(path.points().back()).head<2>() - p_F).norm() >= parameters_.path_step_m;
    if (far && bounded(path.points())) path.points().push_back(to_point(p_F));
  }

  void finish(const furrow_msgs::msg::RunStatus& status) {
    record_.header(status.header());
    record_.ground_truth(field_known_ && landing_known_);
    // On a robot no simulator and no recording tells the distance.
    const double distance_m = status.distance_m() > 0.0 ? status.distance_m() : way_m_;
    record_.distance_m(distance_m);
    const Time end = graph::from_msg(status.header().stamp());
    const double duration_s = first_ ? (end - first_->stamp).to_seconds() : 0.0;
    record_.duration_s(duration_s);
    record_.mean_speed_mps(duration_s > 0.0 ? distance_m / duration_s : 0.0);
    for (const auto& [id, track] : tracks_) record_.tracks().push_back(track);
    for (const auto& [id, history] : decisions_) {
      for (const auto& decision : history) record_.decisions().push_back(decision);
    }
    for (const auto& [axis, state] : states_) record_.axes().push_back(state);
    record_.georeferenced(true);
    record_.origin_latitude_deg(parameters_.georeference.origin_latitude_deg);
    record_.origin_longitude_deg(parameters_.georeference.origin_longitude_deg);
    record_.origin_altitude_m(parameters_.georeference.origin_altitude_m);
    record_.row_angle_rad(parameters_.georeference.row_angle_deg * std::numbers::pi / 180.0);
    out_.publish(record_);
  }

  graph::Context& context_;
  Parameters parameters_;
  geometry::ToolModel tool_;
  graph::Output<topics::RunRecord> out_;
  furrow_msgs::msg::RunRecord record_;
  std::map<std::int64_t, furrow_msgs::msg::Track> tracks_;
  std::map<std::int64_t, std::vector<furrow_msgs::msg::Decision>> decisions_;  ///< by track
  std::size_t decision_count_ = 0;
  bool field_known_ = false;    ///< from the ground truth
  bool landing_known_ = false;  ///< of sprays, from the ground truth
  std::map<std::string, furrow_msgs::msg::AxisState> states_;
  PoseBuffer poses_{Duration::seconds(2.0)};
  std::optional<BaseOdometry> first_;
  std::optional<BaseOdometry> newest_;
  double way_m_ = 0.0;  ///< by the poses
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::Scorer>("scorer");
}
