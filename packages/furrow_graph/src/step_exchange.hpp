#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/mutex.hpp"
#include "furrow_core/result.hpp"
#include "furrow_graph/transport.hpp"
#include "furrow_msgs/furrow_graph.h"
#include "furrow_msgs/message_types.hpp"

namespace furrow::graph {

using furrow_graph::msg::Step;
using furrow_graph::msg::StepMessage;

/// Exchanges the simulation steps of a lock-step among the processes of a deployment. Every process
/// reads the steps of all others, and all know beforehand which processes take part in a step.
class StepExchange {
 public:
  using Steps = std::vector<std::shared_ptr<const Step>>;

  /// All processes take part in a step whose number is a multiple of this. So no process runs ahead
  /// of another by more steps than the topic's history keeps.
  static constexpr std::uint64_t kAllTakePart = 16;

  /// `processes` lists all processes in the same order everywhere; `run` is the same in all.
  StepExchange(Transport& transport, const std::vector<std::string>& processes,
               const std::string& own, std::uint64_t run);

  [[nodiscard]] std::size_t own() const { return own_; }
  [[nodiscard]] std::size_t size() const { return names_.size(); }

  /// Sends this process's part, if it has one, and waits for the part of every other active
  /// process. Returns the parts by process, null where there is none. kUnavailable if a process is
  /// gone, did not start, started twice or runs something else, or after abort().
  [[nodiscard]] Result<Steps> exchange(std::uint64_t number, const std::vector<bool>& active,
                                       std::shared_ptr<Step> mine);

  /// Ends the wait and tells the other processes that this one leaves. From any thread.
  void abort(const std::string& reason);

 private:
  struct Peer {
    std::optional<std::uint64_t> instance;
    std::deque<std::shared_ptr<const Step>> waiting;
  };

  void receive(const std::shared_ptr<const Step>& step);
  /// The first failure is the cause that exchange() reports.
  void fail(const std::string& reason) FURROW_REQUIRES(mutex_);
  /// Returns when the steps of all active processes are there, or at a failure.
  void wait_for_all(const std::vector<bool>& active, bool starting) FURROW_REQUIRES(mutex_);
  /// An active process whose step has not arrived.
  [[nodiscard]] std::optional<std::size_t> missing(const std::vector<bool>& active) const
      FURROW_REQUIRES(mutex_);
  [[nodiscard]] bool some_process_is_gone(bool starting) FURROW_REQUIRES(mutex_);
  void send(std::shared_ptr<Step> step);
  [[nodiscard]] std::string title(std::size_t process) const;

  const std::vector<std::string> names_;
  const std::uint64_t run_;
  const std::uint64_t instance_;
  std::size_t own_ = 0;

  Mutex mutex_;
  ConditionVariable arrived_;
  std::vector<Peer> peers_ FURROW_GUARDED_BY(mutex_);
  std::string failure_ FURROW_GUARDED_BY(mutex_);
  bool all_were_there_ FURROW_GUARDED_BY(mutex_) = false;
  std::optional<std::chrono::steady_clock::time_point> incomplete_since_ FURROW_GUARDED_BY(mutex_);

  std::unique_ptr<TransportWriter> writer_;
  std::unique_ptr<TransportReader> reader_;  // last: calls receive() as long as it exists
};

}  // namespace furrow::graph
