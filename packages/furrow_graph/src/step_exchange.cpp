#include "step_exchange.hpp"

#include <algorithm>
#include <random>

namespace furrow::graph {
namespace {

constexpr char kTopic[] = "lockstep/step";
constexpr std::chrono::milliseconds kLook{100};
// How long all processes may take to start, and how long one may be out of sight afterwards.
constexpr std::chrono::seconds kStartPatience{30};
constexpr std::chrono::seconds kGonePatience{2};

// Nobody is further ahead than the steps up to the next one in which all take part.
msgs::Qos step_qos() {
  return {.reliability = msgs::Reliability::kReliable,
          .durability = msgs::Durability::kTransientLocal,
          .depth = static_cast<int>(3 * StepExchange::kAllTakePart)};
}

std::uint64_t draw_instance() {
  std::random_device device;
  return (std::uint64_t{device()} << 32U) | device();
}

}  // namespace

StepExchange::StepExchange(Transport& transport, const std::vector<std::string>& processes,
                           const std::string& own, std::uint64_t run)
    : run_(run), instance_(draw_instance()) {
  for (const std::string& name : processes) {
    if (name == own) own_ = peers_.size();
    peers_.push_back({.name = name});
  }
  writer_ = transport.make_writer(kTopic, step_type(), step_qos());
  reader_ = transport.make_reader(kTopic, step_type(), step_qos(), [this](MessagePtr message) {
    take(std::static_pointer_cast<const Step>(message));
  });
}

StepExchange::~StepExchange() {
  reader_.reset();
}

void StepExchange::take(const std::shared_ptr<const Step>& step) {
  const std::lock_guard lock(mutex_);
  const auto peer = std::ranges::find(peers_, step->process, &Peer::name);
  const std::string name = "process '" + step->process + "'";
  if (peer == peers_.end() || step->run != run_) {
    fail(name + " runs another graph, deployment, seed or parameters");
  } else if (step->aborted) {
    // What was left behind by an earlier start of the process does not count.
    if (peer->instance == step->instance) fail(name + " left: " + step->reason);
  } else if (peer->instance.value_or(step->instance) != step->instance) {
    fail(name + " was started again, which a run in lock-step does not survive");
  } else {
    peer->instance = step->instance;
    peer->waiting.push_back(step);
  }
  arrived_.notify_all();
}

// With the mutex held. The first failure is the cause.
void StepExchange::fail(const std::string& reason) {
  if (failure_.empty()) failure_ = reason;
}

Result<StepExchange::Steps> StepExchange::exchange(std::uint64_t number,
                                                   const std::vector<bool>& active,
                                                   std::shared_ptr<Step> mine) {
  Steps steps(peers_.size());
  if (mine != nullptr) {
    mine->number = number;
    send(mine);
    steps[own_] = std::move(mine);
  }
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  std::string missing_name;
  while (failure_.empty() && !(missing_name = missing(number, active)).empty()) {
    arrived_.wait_for(lock, kLook);
    if (some_process_is_gone(number == 0)) {
      fail("process '" + missing_name + "' is gone");
    } else if (number == 0 && std::chrono::steady_clock::now() - start > kStartPatience) {
      fail("process '" + missing_name + "' did not come");
    }
  }
  if (!failure_.empty()) return Error{ErrorCode::kUnavailable, failure_};
  all_were_there_ = true;
  for (std::size_t i = 0; i < peers_.size(); ++i) {
    if (i == own_ || !active[i]) continue;
    steps[i] = std::move(peers_[i].waiting.front());
    peers_[i].waiting.pop_front();
    if (steps[i]->number != number) {
      return Error{ErrorCode::kUnavailable, "process '" + peers_[i].name + "' is in step " +
                                                std::to_string(steps[i]->number) + ", not " +
                                                std::to_string(number)};
    }
  }
  return steps;
}

// With the mutex held: a process whose part is still to come.
std::string StepExchange::missing(std::uint64_t /*number*/, const std::vector<bool>& active) const {
  for (std::size_t i = 0; i < peers_.size(); ++i) {
    if (i != own_ && active[i] && peers_[i].waiting.empty()) return peers_[i].name;
  }
  return {};
}

// With the mutex held.
bool StepExchange::some_process_is_gone(bool waiting_for_start) {
  const bool complete = reader_->writers() >= static_cast<int>(peers_.size()) - 1;
  const auto now = std::chrono::steady_clock::now();
  if (complete || waiting_for_start || !all_were_there_) {
    incomplete_since_.reset();
    return false;
  }
  if (!incomplete_since_) incomplete_since_ = now;
  return now - *incomplete_since_ > kGonePatience;
}

void StepExchange::abort(const std::string& reason) {
  {
    const std::lock_guard lock(mutex_);
    fail(reason);
  }
  arrived_.notify_all();
  auto step = std::make_shared<Step>();
  step->aborted = true;
  step->reason = reason;
  send(std::move(step));
}

void StepExchange::send(std::shared_ptr<Step> step) {
  step->run = run_;
  step->instance = instance_;
  step->process = peers_[own_].name;
  writer_->write(std::move(step));
}

}  // namespace furrow::graph
