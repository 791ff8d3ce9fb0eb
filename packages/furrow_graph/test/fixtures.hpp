#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "furrow_graph/graph_file.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/std_msgs.h"

namespace furrow::graph::test {

/// A fresh folder for the running test.
inline std::filesystem::path scratch_folder() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(testing::TempDir()) / "furrow_graph" /
                      info->test_suite_name() / info->name();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

inline std::filesystem::path write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text;
  return path;
}

/// The text of the ConfigError that `call` throws, without the scratch folder; "" if it throws
/// none.
template <class Call>
std::string error_of(const std::filesystem::path& folder, Call call) {
  try {
    call();
  } catch (const ConfigError& error) {
    std::string text = error.what();
    const std::string prefix = folder.string() + "/";
    for (auto at = text.find(prefix); !folder.empty() && at != std::string::npos;
         at = text.find(prefix)) {
      text.erase(at, prefix.size());
    }
    return text;
  }
  return "";
}

/// Publishes numbered Tracks messages at a rate.
struct SourceParameters {
  double rate_hz = 10.0;
  std::string label = "source";
  void visit(ParameterVisitor& v) {
    v.visit({.name = "rate_hz", .unit = "Hz", .min = 0.1, .max = 1000.0}, rate_hz);
    v.visit({.name = "label"}, label);
  }
};

class Source final : public Component {
 public:
  static void describe(Description& d) {
    d.parameters<SourceParameters>().output<msgs::topics::Tracks>();
  }
  explicit Source(Context& context) : out_(context.output<msgs::topics::Tracks>()) {
    const auto parameters = context.parameters<SourceParameters>();
    context.every(Duration::seconds(1.0 / parameters.rate_hz), [this, parameters](Time) {
      furrow_msgs::msg::Tracks tracks;
      tracks.header().frame_id(parameters.label + std::to_string(count_++));
      out_.publish(std::move(tracks));
    });
  }

 private:
  Output<msgs::topics::Tracks> out_;
  int count_ = 0;
};

/// Publishes a Plan for each Tracks, with increasing revision.
class Relay final : public Component {
 public:
  static void describe(Description& d) {
    d.input<msgs::topics::Tracks>().output<msgs::topics::Plan>();
  }
  explicit Relay(Context& context) {
    auto out = context.output<msgs::topics::Plan>();
    context.input<msgs::topics::Tracks>(
        [this, out](const std::shared_ptr<const furrow_msgs::msg::Tracks>& tracks) {
          furrow_msgs::msg::Plan plan;
          plan.header().frame_id(tracks->header().frame_id());
          plan.revision(++count_);
          out.publish(std::move(plan));
        });
  }

 private:
  std::uint64_t count_ = 0;
};

inline Registry standard_registry() {
  Registry registry;
  registry.add<Source>("source");
  registry.add<Relay>("relay");
  return registry;
}

/// Registers a class "sink" that calls `take` for each Plan.
inline void add_sink(Registry& registry,
                     std::function<void(Context&, const furrow_msgs::msg::Plan&)> take) {
  ComponentClass sink{.name = "sink"};
  sink.description.input<msgs::topics::Plan>();
  sink.make = [take](Context& context) {
    context.input<msgs::topics::Plan>(
        [&context, take](const std::shared_ptr<const furrow_msgs::msg::Plan>& plan) {
          take(context, *plan);
        });
    return std::make_unique<Component>();
  };
  registry.add(std::move(sink));
}

inline ComponentSpec spec(const std::string& name, const std::string& class_name) {
  return {.name = name, .group = name, .class_name = class_name, .where = {"graph.yaml", 1}};
}

}  // namespace furrow::graph::test
