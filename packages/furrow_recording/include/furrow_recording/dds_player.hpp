#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "furrow_core/time.hpp"
#include "furrow_dds/dds_transport.hpp"
#include "furrow_recording/player.hpp"

namespace furrow::recording {

struct DdsPlayerOptions {
  /// The longest wait, before the first message, for a reader of any topic and until no further
  /// reader appears. Volatile messages without a reader are lost.
  Duration wait_for_readers;
};

struct DdsPlayerStatus {
  std::uint64_t messages = 0;
  std::uint64_t dropped = 0;  ///< refused by the transport
  std::uint64_t faults = 0;   ///< damaged chunks left out
  std::string last_fault;
  double lateness_p99_s = 0.0;  ///< of the last 4096 messages, against their due time
  Time position;                ///< in the recording
  bool paused = false;
  bool finished = false;
};

/// Publishes a recording in a domain, with the recorded QoS, from a dedicated thread.
class DdsPlayer {
 public:
  /// Starts at once. Throws ConfigError when an endpoint is refused. The transport must outlive it.
  DdsPlayer(dds::DdsTransport& transport, Player player, const DdsPlayerOptions& options = {});
  ~DdsPlayer();

  // Thread-safe.
  void pause();
  void resume();
  void step(std::uint64_t messages = 1);
  void seek(Time to);
  [[nodiscard]] Status set_rate(double rate);
  void stop();
  /// Waits for the end of the recording; false when `timeout` passed before.
  [[nodiscard]] bool wait(Duration timeout);
  [[nodiscard]] DdsPlayerStatus status() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::recording
