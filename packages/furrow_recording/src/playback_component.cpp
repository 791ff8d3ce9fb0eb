#include <algorithm>
#include <cmath>
#include <concepts>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/nav_msgs.h"
#include "furrow_msgs/sensor_msgs.h"
#include "furrow_recording/player.hpp"
#include "topic_list.hpp"

namespace furrow::recording {
namespace {

namespace topics = msgs::topics;

/// Earlier than that no clock of the world stood: the recording is of simulated time.
constexpr Time kSimulatedBefore = Time::from_nanoseconds(10'000'000'000'000'000);
/// Stamps are a little earlier than the first message.
constexpr Duration kLead = Duration::milliseconds(1000);
constexpr Duration kStep = Duration::milliseconds(1);

struct Parameters {
  std::vector<std::string> files;
  std::vector<std::string> include = {"*"};
  std::vector<std::string> exclude;
  std::vector<std::string> remap;
  double start_s = 0.0;
  double duration_s = 0.0;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "files", .description = "files or rosbag2 folders of one recording"}, files);
    v.visit({.name = "include", .description = "topics to play, as patterns with * and ?"},
            include);
    v.visit({.name = "exclude", .description = "topics to leave out"}, exclude);
    v.visit({.name = "remap",
             .description = "RECORDED=PLAYED, where the recording has other names for the topics"},
            remap);
    v.visit({.name = "start_s",
             .unit = "s",
             .description = "begin so long after the first message",
             .min = 0.0,
             .max = 1e7},
            start_s);
    v.visit({.name = "duration_s",
             .unit = "s",
             .description = "play so much; 0: to the end",
             .min = 0.0,
             .max = 1e7},
            duration_s);
  }
};

template <class Message>
concept Stamped = requires(Message message) {
  message.header().stamp();
};

Player open(const Parameters& parameters) {
  if (parameters.files.empty()) throw ConfigError("files: none is given");
  PlayerOptions options;
  options.topics = {parameters.include, parameters.exclude};
  options.start_offset = Duration::seconds(parameters.start_s);
  if (parameters.duration_s > 0.0) options.duration = Duration::seconds(parameters.duration_s);
  for (const std::string& remap : parameters.remap) {
    const auto equals = remap.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == remap.size()) {
      throw ConfigError("remap: '" + remap + "' is not RECORDED=PLAYED");
    }
    options.remap[remap.substr(0, equals)] = remap.substr(equals + 1);
  }
  std::vector<std::filesystem::path> files(parameters.files.begin(), parameters.files.end());
  auto player = Player::open(files, options);
  if (!player) throw ConfigError("files: " + player.error().message);
  return std::move(player).value();
}

/// Replaces the sensors. A recording in simulated time keeps its times. Other stamps are moved: the
/// first message comes a second after the start.
class Playback final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc(
         "Plays camera, odometry, IMU and GNSS of a recording in place of robot and camera, and "
         "the ground truth of simulated runs.")
        .parameters<Parameters>();
    PlayedTopics::for_each([&d]<class T>() { d.output<T>(); });
  }

  explicit Playback(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<Parameters>()),
        player_(open(parameters_)),
        status_out_(context.output<topics::RunStatus>()) {
    const Time begin = player_.begin() + Duration::seconds(parameters_.start_s);
    const bool as_recorded =
        context.now() == Time() && begin < kSimulatedBefore && parameters_.start_s == 0.0;
    first_ = begin;
    shift_ = as_recorded ? Duration() : context.now() + kLead - begin;
    publishers_.resize(player_.topics().size());
    PlayedTopics::for_each([this]<class T>() { connect<T>(); });
    report_damage();
    fetch();
    // Messages from before the first step, such as the field.
    if (as_recorded) publish_until(context.now());
    context.every(kStep, [this](Time now) { step(now); });
  }

 private:
  using Publisher = std::function<Status(const std::vector<std::byte>&)>;

  template <class T>
  void connect() {
    const msgs::Topic& topic = T::topic();
    const auto output = context_.output<T>();
    for (std::size_t i = 0; i < player_.topics().size(); ++i) {
      const TopicDescription& recorded = player_.topics()[i];
      if (recorded.name != topic.name) continue;
      if (recorded.type_name != topic.type->ros_name) {
        throw ConfigError("files: " + recorded.name + " is recorded as " + recorded.type_name +
                          ", not " + std::string(topic.type->ros_name));
      }
      publishers_[i] = [this, output, type = topic.type](const std::vector<std::byte>& payload) {
        auto message = std::make_shared<typename T::Message>();
        if (Status read = type->deserialize(payload, message.get()); !read) return read;
        adapt(*message);
        output.publish(std::shared_ptr<const typename T::Message>(std::move(message)));
        return Status();
      };
    }
  }

  void report_damage() {
    const RecordingInfo& info = player_.recording();
    for (const UnplayableTopic& topic : player_.unplayable()) {
      context_.count("topics_not_played");
      context_.health(graph::HealthLevel::kWarn, topic.name + " is not played: " + topic.reason);
    }
    if (!info.whole()) {
      context_.count("damaged_parts");
      context_.health(graph::HealthLevel::kWarn,
                      "the recording is not whole: " +
                          (info.damage.empty() ? info.faults.front() : info.damage));
    }
  }

  template <class Message>
  void adapt(Message& message) {
    if constexpr (Stamped<Message>) {
      if (shift_ != Duration()) {
        const Time stamp = graph::from_msg(message.header().stamp()) + shift_;
        message.header().stamp(graph::to_msg(std::max(stamp, Time())));
      }
    }
    if constexpr (std::same_as<Message, topics::WheelOdometry::Message>) measure_way(message);
    if constexpr (std::same_as<Message, topics::RunStatus::Message>) {
      status_recorded_ = true;
      finished_ = finished_ || message.finished();
    }
  }

  // For recordings that say nothing of the run, and of both kinds of odometry the true one too.
  void measure_way(const nav_msgs::msg::Odometry& wheels) {
    const Time stamp = graph::from_msg(wheels.header().stamp());
    speed_mps_ = wheels.twist().twist().linear().x();
    constexpr double kMaxGap_s = 1.0;
    if (last_odometry_) {
      const double dt_s = (stamp - *last_odometry_).to_seconds();
      if (dt_s > 0.0 && dt_s < kMaxGap_s && std::isfinite(speed_mps_)) {
        distance_m_ += std::abs(speed_mps_) * dt_s;
      }
    }
    last_odometry_ = stamp;
  }

  void step(Time now) {
    publish_until(now);
    if (next_ || finished_) return;
    finished_ = true;
    report(now, true);
  }

  void publish_until(Time now) {
    while (next_ && std::max(next_->log_time, first_) + shift_ <= now) {
      if (const Publisher& publisher = publishers_[next_->topic]) {
        if (publisher(*next_->payload).ok()) {
          context_.count("messages");
        } else {
          context_.count("malformed");
          context_.health(graph::HealthLevel::kWarn, "malformed messages in the recording");
        }
      }
      fetch();
    }
    constexpr Duration kReportPeriod = Duration::milliseconds(200);
    if (!status_recorded_ && next_ && now - last_report_ >= kReportPeriod) report(now, false);
  }

  void report(Time now, bool finished) {
    const double length_s = (player_.end() - first_).to_seconds();
    const double done_s = (now - shift_ - first_).to_seconds();
    furrow_msgs::msg::RunStatus status;
    status.header().stamp(graph::to_msg(now));
    status.finished(finished);
    status.progress(length_s > 0.0 ? std::clamp(done_s / length_s, 0.0, 1.0) : 1.0);
    status.distance_m(distance_m_);
    status.speed_mps(speed_mps_);
    status_out_.publish(std::move(status));
    last_report_ = now;
  }

  /// Reads the next message of a port. Damaged parts of the file are left out and counted.
  void fetch() {
    while (true) {
      auto next = player_.next_message();
      if (next) {
        next_ = std::move(*next);
        return;
      }
      context_.count("damaged_parts");
      context_.health(graph::HealthLevel::kWarn, next.error().message);
      if (next.error().code == ErrorCode::kIo) {
        next_.reset();
        return;
      }
    }
  }

  graph::Context& context_;
  Parameters parameters_;
  Player player_;
  graph::Output<topics::RunStatus> status_out_;
  std::vector<Publisher> publishers_;  // by the player's topics; empty: not a port
  std::optional<PlayedMessage> next_;
  Time first_;
  Duration shift_;
  std::optional<Time> last_odometry_;
  double speed_mps_ = 0.0;
  double distance_m_ = 0.0;
  bool status_recorded_ = false;
  bool finished_ = false;
  Time last_report_;
};

}  // namespace
}  // namespace furrow::recording

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::recording::Playback>("playback");
}
