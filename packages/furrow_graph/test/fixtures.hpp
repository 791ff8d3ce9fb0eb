#pragma once

#include <gtest/gtest.h>

#include <string>

#include "furrow_graph/graph_spec.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/std_msgs.h"

namespace furrow::graph::test {

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
