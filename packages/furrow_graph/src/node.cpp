#include "node.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "furrow_graph/graph_check.hpp"

namespace furrow::graph {

Node::Node(ComponentSpec spec, const ComponentClass& type, std::vector<GivenParameter> parameters,
           std::uint64_t seed, NodeHost& host)
    : spec_(std::move(spec)),
      type_(type),
      parameters_(std::move(parameters)),
      seed_(seed),
      host_(host) {}

Node::~Node() = default;

void Node::construct(std::function<Route&(const std::string& topic)> route_of) {
  route_of_ = std::move(route_of);
  try {
    component_ = type_.make(*this);
  } catch (const ConfigError& error) {
    throw ConfigError(spec_.where, spec_.name, error.what());
  }
}

std::optional<std::size_t> Node::input_of(const std::string& topic) const {
  const MutexLock lock(mutex_);
  const auto it = std::ranges::find(inputs_, topic, &Input::topic);
  if (it == inputs_.end()) return std::nullopt;
  return static_cast<std::size_t>(it - inputs_.begin());
}

void Node::push(std::size_t input, MessagePtr message) {
  Mail oldest;  // freed after the lock: freeing an image takes a while
  const MutexLock lock(mutex_);
  Input& target = inputs_[input];
  ++target.received;
  if (target.waiting == target.depth) {
    oldest = mail_.take_oldest_of(input);
    --target.waiting;
    ++target.dropped;
  }
  mail_.push({input, std::move(message), host_.now()});
  ++target.waiting;
}

bool Node::has_messages() const {
  const MutexLock lock(mutex_);
  return !mail_.empty();
}

template <class Callback>
void Node::call(const Callback& callback) {
  const auto start = std::chrono::steady_clock::now();
  try {
    callback();
  } catch (const std::exception& failure) {
    host_.request_stop("component '" + spec_.name + "' failed: " + failure.what(), true);
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const MutexLock lock(mutex_);
  ++callbacks_;
  busy_s_ += took.count();
  longest_call_s_ = std::max(longest_call_s_, took.count());
}

void Node::run_messages() {
  std::size_t budget = 0;
  {
    const MutexLock lock(mutex_);
    budget = mail_.size();
  }
  for (; budget > 0; --budget) {
    Mail mail;
    const std::function<void(const MessagePtr&)>* callback = nullptr;
    std::uint64_t drops = 0;
    std::string topic;  ///< of an input whose mailbox dropped messages
    {
      const MutexLock lock(mutex_);
      mail = mail_.pop();
      Input& input = inputs_[mail.input];
      --input.waiting;
      callback = &input.callback;  // fixed since construction
      drops = input.dropped - std::exchange(input.dropped_logged, input.dropped);
      if (drops > 0) topic = input.topic;
    }
    if (drops > 0) log_drops(topic, drops);
    arrival_ = mail.arrived;
    call([&] { (*callback)(mail.message); });
  }
}

void Node::run_timer(std::size_t timer, Time due) {
  const Duration late = host_.now() - due;
  {
    const MutexLock lock(mutex_);
    lateness_.add(late);
  }
  call([&] { timers_[timer].callback(due); });
}

ComponentStatus Node::status() const {
  const MutexLock lock(mutex_);
  ComponentStatus status;
  status.name = spec_.name;
  status.class_name = spec_.class_name;
  status.health = health_;
  for (const Input& input : inputs_) {
    status.inputs.push_back({input.topic, input.received, input.dropped});
  }
  status.callbacks = callbacks_;
  status.missed_timers = missed_timers_;
  status.busy_s = busy_s_;
  status.longest_call_s = longest_call_s_;
  status.timers = lateness_.count();
  status.timer_late_p50 = lateness_.quantile(0.5);
  status.timer_late_p99 = lateness_.quantile(0.99);
  status.timer_late_max = lateness_.max();
  status.thread = memory_.empty() ? thread_ : thread_ + "; memory " + memory_;
  return status;
}

void Node::set_thread(std::string text) {
  const MutexLock lock(mutex_);
  thread_ = std::move(text);
}

void Node::set_memory(std::string text) {
  const MutexLock lock(mutex_);
  memory_ = std::move(text);
}

void Node::every(Duration period, std::function<void(Time)> callback) {
  if (period <= Duration()) throw ConfigError("a timer's period must be positive");
  timers_.push_back({period, Time(), std::move(callback)});
}

void Node::health(HealthLevel level, std::string_view message) {
  HealthLevel before = HealthLevel::kOk;
  {
    const MutexLock lock(mutex_);
    if (level == health_.level && message == health_.message) return;
    before = std::exchange(health_.level, level);
    health_.message = message;
  }
  if (level != HealthLevel::kOk) {
    log(level == HealthLevel::kWarn ? log::Level::kWarn : log::Level::kError, message);
  } else if (before != HealthLevel::kOk) {
    log(log::Level::kInfo, message.empty() ? "ok again" : message);
  }
}

void Node::log(log::Level level, std::string_view message) {
  if (log_ != nullptr) log_->write(host_.now(), level, spec_.name, message);
}

void Node::log_drops(const std::string& topic, std::uint64_t count) {
  log(log::Level::kWarn,
      "mailbox of '" + topic + "' was full; " + std::to_string(count) + " of its messages dropped");
}

void Node::count(std::string_view counter, std::int64_t by) {
  const MutexLock lock(mutex_);
  health_.counters[std::string(counter)] += by;
}

void Node::require_declared(const std::vector<PortInfo>& ports, const msgs::Topic& topic) const {
  const bool declared = std::ranges::any_of(
      ports, [&](const PortInfo& port) { return port.topic->name == topic.name; });
  if (!declared) {
    throw ConfigError("class '" + type_.name + "' does not describe its port '" +
                      std::string(topic.name) + "'");
  }
}

void Node::bind_input(const msgs::Topic& topic, std::function<void(const MessagePtr&)> callback,
                      int depth) {
  require_declared(type_.description.inputs(), topic);
  if (depth < 1) throw ConfigError("the depth of an input must be at least 1");
  const MutexLock lock(mutex_);
  inputs_.push_back(
      {resolved_topic(spec_, topic), static_cast<std::size_t>(depth), std::move(callback)});
}

std::function<void(MessagePtr)> Node::bind_output(const msgs::Topic& topic) {
  require_declared(type_.description.outputs(), topic);
  Route& route = route_of_(resolved_topic(spec_, topic));
  return [this, &route](MessagePtr message) { host_.publish(*this, route, std::move(message)); };
}

}  // namespace furrow::graph
