#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_graph/transport.hpp"
#include "step.hpp"

namespace furrow::graph {

/// Carries the steps of a lock-step among the processes of a deployment. Every process reads every
/// step of every other; who takes part in a step is known to all beforehand.
class StepExchange {
 public:
  using Steps = std::vector<std::shared_ptr<const Step>>;

  /// All processes take part in a step whose number is a multiple of this, so that none is further
  /// ahead of another than the transport keeps.
  static constexpr std::uint64_t kAllTakePart = 16;

  /// `processes` are all, in the same order everywhere; `run` is the same in all.
  StepExchange(Transport& transport, const std::vector<std::string>& processes,
               const std::string& own, std::uint64_t run);
  ~StepExchange();

  [[nodiscard]] std::size_t own() const { return own_; }
  [[nodiscard]] std::size_t size() const { return peers_.size(); }

  /// Sends this process's part, when it has one, and waits for that of every other process that is
  /// active: the parts by process, null where there is none. kUnavailable when a process is gone,
  /// never came, was started twice or runs something else, or when the wait was ended.
  [[nodiscard]] Result<Steps> exchange(std::uint64_t number, const std::vector<bool>& active,
                                       std::shared_ptr<Step> mine);

  /// Ends the wait, and tells the others that this process leaves. From any thread.
  void abort(const std::string& reason);

 private:
  struct Peer {
    std::string name;
    std::optional<std::uint64_t> instance;
    std::deque<std::shared_ptr<const Step>> waiting;
  };

  void take(const std::shared_ptr<const Step>& step);
  void fail(const std::string& reason);
  [[nodiscard]] std::string missing(std::uint64_t number, const std::vector<bool>& active) const;
  [[nodiscard]] bool some_process_is_gone(bool waiting_for_start);
  void send(std::shared_ptr<Step> step);

  const std::uint64_t run_;
  const std::uint64_t instance_;
  std::size_t own_ = 0;
  std::unique_ptr<TransportWriter> writer_;
  std::unique_ptr<TransportReader> reader_;

  std::mutex mutex_;  // of what follows
  std::condition_variable arrived_;
  std::vector<Peer> peers_;
  std::string failure_;
  bool all_were_there_ = false;
  std::optional<std::chrono::steady_clock::time_point> incomplete_since_;
};

}  // namespace furrow::graph
