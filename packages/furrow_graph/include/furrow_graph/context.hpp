#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_core/time.hpp"
#include "furrow_graph/health.hpp"
#include "furrow_graph/transport.hpp"
#include "furrow_log/level.hpp"
#include "furrow_msgs/topics.hpp"

namespace furrow::graph {

/// The publishing end of a topic. Cheap to copy; lives as long as its component's Context.
template <class T>
class Output {
 public:
  using Message = typename T::Message;

  /// Delivers the message to every input of this process without a copy, and to the transport if
  /// another process reads the topic. The message must not change from then on. Call it from the
  /// component's callbacks or constructor only. In real time the readers may run at once, on other
  /// threads; in lock-step they run after the callback.
  void publish(std::shared_ptr<const Message> message) const { send_(std::move(message)); }
  void publish(Message message) const {
    publish(std::make_shared<const Message>(std::move(message)));
  }

 private:
  friend class Context;
  explicit Output(std::function<void(MessagePtr)> send) : send_(std::move(send)) {}
  std::function<void(MessagePtr)> send_;
};

/// A component gets its Context at construction and keeps it by reference. Not thread-safe: for
/// the component's own constructor and callbacks.
class Context {
 public:
  virtual ~Context() = default;

  /// The component's name in the graph.
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// The time of the graph's clock: that of the simulation step in lock-step, else Unix time.
  [[nodiscard]] virtual Time now() const = 0;
  /// When the message of the current callback arrived, on the same clock. It is before now() if the
  /// message waited for a thread. @pre Within a callback of an input.
  [[nodiscard]] virtual Time arrival() const = 0;
  /// The seed of the run. Draw random streams by the component's name.
  [[nodiscard]] virtual std::uint64_t seed() const = 0;

  /// The component's parameters, checked and loaded over the defaults.
  template <class Parameters>
  [[nodiscard]] Parameters parameters() const {
    Parameters parameters;
    ParameterLoader::load(given_parameters(), parameters);
    return parameters;
  }

  /// Calls back for each message, in the order of arrival over all inputs of the component. If
  /// `depth` messages already wait, the oldest is dropped and counted. The default depth is that of
  /// the topic's QoS.
  template <class T>
  void input(std::function<void(const std::shared_ptr<const typename T::Message>&)> callback,
             std::optional<int> depth = {}) {
    bind_input(
        T::topic(),
        [callback = std::move(callback)](const MessagePtr& message) {
          callback(std::static_pointer_cast<const typename T::Message>(message));
        },
        depth.value_or(T::topic().qos.depth));
  }
  template <class T>
  [[nodiscard]] Output<T> output() {
    return Output<T>(bind_output(T::topic()));
  }
  /// Calls back at whole multiples of `period` after the start. A tick is skipped and counted if
  /// the call of the one before has not begun.
  virtual void every(Duration period, std::function<void(Time)> callback) = 0;

  /// Sets the level that diagnostics show; kOk with an empty message clears it. A change is a line
  /// of the log.
  virtual void health(HealthLevel level, std::string_view message) = 0;
  /// Adds to a counter that diagnostics show.
  virtual void count(std::string_view counter, std::int64_t by = 1) = 0;
  /// Writes a line to the log, which names the component by itself. The message is one sentence:
  /// "CAUSE; EFFECT". Repetitions are suppressed and counted.
  virtual void log(log::Level level, std::string_view message) = 0;
  /// Counts what was refused or dropped, and logs a warning.
  void warn(std::string_view counter, std::string_view message) {
    count(counter);
    log(log::Level::kWarn, message);
  }
  /// Ends the run after the current callbacks. The user sees the reason.
  virtual void request_stop(std::string_view reason) = 0;

 protected:
  [[nodiscard]] virtual const std::vector<GivenParameter>& given_parameters() const = 0;
  virtual void bind_input(const msgs::Topic& topic, std::function<void(const MessagePtr&)> callback,
                          int depth) = 0;
  [[nodiscard]] virtual std::function<void(MessagePtr)> bind_output(const msgs::Topic& topic) = 0;
};

}  // namespace furrow::graph
