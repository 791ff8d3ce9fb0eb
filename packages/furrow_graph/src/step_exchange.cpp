#include "step_exchange.hpp"

#include <algorithm>
#include <random>

namespace furrow::graph {
namespace {

constexpr char kTopic[] = "lockstep/step";
constexpr std::chrono::milliseconds kCheckPeriod{100};
constexpr std::chrono::seconds kStartTimeout{30};  // for all processes to start
constexpr std::chrono::seconds kGoneTimeout{2};    // for an unmatched process to match again

// No process is ahead of another by more than the steps up to the next one in which all take part.
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
    : names_(processes),
      run_(run),
      instance_(draw_instance()),
      own_(static_cast<std::size_t>(std::ranges::find(names_, own) - names_.begin())),
      peers_(names_.size()) {
  writer_ = transport.make_writer(kTopic, msgs::message_type<Step>(), step_qos());
  reader_ = transport.make_reader(
      kTopic, msgs::message_type<Step>(), step_qos(),
      [this](MessagePtr message) { receive(std::static_pointer_cast<const Step>(message)); });
}

void StepExchange::receive(const std::shared_ptr<const Step>& step) {
  const auto index =
      static_cast<std::size_t>(std::ranges::find(names_, step->process()) - names_.begin());
  const std::string name = "process '" + step->process() + "'";
  const MutexLock lock(mutex_);
  if (index == names_.size() || step->run() != run_) {
    fail(name + " runs another graph, deployment, seed or parameters");
  } else if (Peer& peer = peers_[index]; step->aborted()) {
    // A message that an earlier instance of the process left behind does not count.
    if (peer.instance == step->instance()) fail(name + " left: " + step->reason());
  } else if (peer.instance.value_or(step->instance()) != step->instance()) {
    fail(name + " started again; a run in lock-step cannot continue without its old state");
  } else {
    peer.instance = step->instance();
    peer.waiting.push_back(step);
  }
  arrived_.notify_all();
}

void StepExchange::fail(const std::string& reason) {
  if (failure_.empty()) failure_ = reason;
}

Result<StepExchange::Steps> StepExchange::exchange(std::uint64_t number,
                                                   const std::vector<bool>& active,
                                                   std::shared_ptr<Step> mine) {
  Steps steps(size());
  if (mine != nullptr) {
    mine->number(number);
    send(mine);
    steps[own_] = std::move(mine);
  }
  const MutexLock lock(mutex_);
  wait_for_all(active, number == 0);
  if (!failure_.empty()) return Error{ErrorCode::kUnavailable, failure_};
  all_were_there_ = true;
  for (std::size_t i = 0; i < size(); ++i) {
    if (i == own_ || !active[i]) continue;
    steps[i] = std::move(peers_[i].waiting.front());
    peers_[i].waiting.pop_front();
    if (steps[i]->number() != number) {
      return Error{ErrorCode::kUnavailable, title(i) + " is in step " +
                                                std::to_string(steps[i]->number()) + ", not " +
                                                std::to_string(number)};
    }
  }
  return steps;
}

void StepExchange::wait_for_all(const std::vector<bool>& active, bool starting) {
  const auto start = std::chrono::steady_clock::now();
  while (failure_.empty()) {
    const auto process = missing(active);
    if (!process) return;
    arrived_.wait_until(mutex_, std::chrono::steady_clock::now() + kCheckPeriod);
    if (some_process_is_gone(starting)) {
      fail(title(*process) + " is gone");
    } else if (starting && std::chrono::steady_clock::now() - start > kStartTimeout) {
      fail(title(*process) + " did not start within 30 s");
    }
  }
}

std::optional<std::size_t> StepExchange::missing(const std::vector<bool>& active) const {
  for (std::size_t i = 0; i < size(); ++i) {
    if (i != own_ && active[i] && peers_[i].waiting.empty()) return i;
  }
  return std::nullopt;
}

bool StepExchange::some_process_is_gone(bool starting) {
  const bool complete = reader_->writers() >= static_cast<int>(size()) - 1;
  const auto now = std::chrono::steady_clock::now();
  if (complete || starting || !all_were_there_) {
    incomplete_since_.reset();
    return false;
  }
  if (!incomplete_since_) incomplete_since_ = now;
  return now - *incomplete_since_ > kGoneTimeout;
}

void StepExchange::abort(const std::string& reason) {
  {
    const MutexLock lock(mutex_);
    fail(reason);
  }
  arrived_.notify_all();
  auto step = std::make_shared<Step>();
  step->aborted(true);
  step->reason(reason);
  send(std::move(step));
}

void StepExchange::send(std::shared_ptr<Step> step) {
  step->run(run_);
  step->instance(instance_);
  step->process(names_[own_]);
  writer_->write(std::move(step));
}

std::string StepExchange::title(std::size_t process) const {
  return "process '" + names_[process] + "'";
}

}  // namespace furrow::graph
