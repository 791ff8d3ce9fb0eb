#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include "furrow_graph/registry.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_recording/recorder_thread.hpp"
#include "topic_list.hpp"

namespace furrow::recording {
namespace {

struct Parameters {
  std::string file;
  bool wait_for_disk = false;
  RecorderParameters recorder;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "file",
             .description = "path of the recording, to which _0.mcap, _1.mcap, ... is added"},
            file);
    v.visit({.name = "wait_for_disk",
             .description =
                 "for lock-step: hold the graph up rather than lose a message, and end chunks by "
                 "simulated time alone"},
            wait_for_disk);
    recorder.visit(v);
  }
};

std::string stem_of(const std::string& file) {
  if (file.empty()) throw ConfigError("file: is not given");
  std::filesystem::path path(file);
  return path.extension() == ".mcap" ? path.replace_extension().string() : file;
}

/// The recorder waits for a worker, which may compute for a second. No message that arrives
/// meanwhile may be lost, even where other readers want only the newest.
int mailbox_depth(const msgs::Qos& qos) {
  constexpr int kLeast = 64;
  constexpr int kOfOthers = 20;
  return std::max(kLeast, kOfOthers * qos.depth);
}

/// Records the topics of the graph that it lives in, on the graph's clock, as of when they came.
class RecorderComponent final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc(
         "Records every topic of Furrow's table into MCAP files. With a pre-trigger window an "
         "emergency stop triggers it.")
        .parameters<Parameters>();
    AllTopics::for_each([&d]<class T>() { d.input<T>(graph::Need::kOptional); });
  }

  explicit RecorderComponent(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<Parameters>()),
        recorder_(parameters_.recorder, stem_of(parameters_.file),
                  parameters_.wait_for_disk ? RecorderClock::kSimulated : RecorderClock::kReal) {
    AllTopics::for_each([this]<class T>() { subscribe<T>(); });
    context.every(Duration::milliseconds(1000), [this](Time) { report(); });
  }

 private:
  template <class T>
  void subscribe() {
    const msgs::Topic& topic = T::topic();
    const std::string name(topic.name);
    const bool triggers = std::is_same_v<T, msgs::topics::EmergencyStop>;
    if (!recorder_.accepts(name) && !triggers) return;
    const auto style =
        parameters_.recorder.schema == "omgidl" ? SchemaStyle::kOmgidl : SchemaStyle::kRos2msg;
    const std::size_t number =
        recorder_.add_topic(describe_topic(name, topic.type->ros_name, {topic.qos}, style));
    const bool wanted = recorder_.accepts(name);
    context_.input<T>(
        [this, number, wanted, type = topic.type](const auto& message) {
          if (wanted) record(number, message, *type);
          if constexpr (std::is_same_v<T, msgs::topics::EmergencyStop>) {
            if (message->active()) recorder_.trigger();
          }
        },
        mailbox_depth(topic.qos));
  }

  void record(std::size_t topic, std::shared_ptr<const void> message,
              const msgs::MessageType& type) {
    const Time came = context_.arrival();
    if (!recorder_.record(topic, came, came, std::move(message), type)) {
      context_.warn("lost", "the disk is too slow; a message was not recorded");
    }
  }

  void report() {
    const RecorderStatus status = recorder_.status();
    if (status.state == RecorderState::kStopped) {
      context_.health(graph::HealthLevel::kError, "not recording: " + status.fault);
    } else if (status.dropped > 0) {
      context_.health(graph::HealthLevel::kWarn, std::to_string(status.dropped) + " messages lost");
    }
  }

  graph::Context& context_;
  Parameters parameters_;
  RecorderThread recorder_;
};

}  // namespace
}  // namespace furrow::recording

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::recording::RecorderComponent>("recorder");
}
