#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_dds/dds_transport.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_launch/signals.hpp"

namespace furrow::benchmarks {

/// What is sent, and how often: images of each size in turn, so that all sizes have the same
/// conditions.
struct LatencyLoad {
  std::vector<std::size_t> bytes = {100};  ///< of an image's pixels
  Duration period = Duration::milliseconds(10);
  int messages = 1000;  ///< of each size

  [[nodiscard]] std::size_t bytes_of(std::uint32_t number) const {
    return bytes[number % bytes.size()];
  }
  [[nodiscard]] std::uint32_t total() const {
    return static_cast<std::uint32_t>(bytes.size()) * static_cast<std::uint32_t>(messages);
  }
};

/// Times from publication to the reader's callback.
class Latencies {
 public:
  /// Thread-safe. The number tells messages apart; the stamp is that of steady_now().
  void add(std::uint32_t number, Time stamp, std::size_t bytes);
  void note_address(bool same);

  /// Of messages with so many bytes, without those among the first ten of all; in us.
  [[nodiscard]] std::vector<double> times_us(std::size_t bytes) const;
  [[nodiscard]] std::size_t received(std::size_t bytes) const;
  /// Every payload was read where it was written.
  [[nodiscard]] bool never_copied() const;

 private:
  struct Entry {
    std::uint32_t number;
    std::size_t bytes;
    double us;
  };
  mutable std::mutex mutex_;
  std::vector<Entry> entries_;
  bool same_address_ = true;
};

/// The machine's clock that never jumps, the same in all its processes.
[[nodiscard]] Time steady_now();

/// The CDR form of an image with so many bytes of pixels, to be stamped by stamp_payload().
[[nodiscard]] std::vector<std::byte> image_payload(std::size_t bytes);
void stamp_payload(std::vector<std::byte>& payload, std::uint32_t number, Time stamp);
/// Adds what came as such a payload.
void add_payload(Latencies& latencies, const std::vector<std::byte>& payload);

/// A graph of a component that publishes images and, when wanted, one that reads them.
struct LatencyGraph {
  bool source = true;
  bool sink = true;
  LatencyLoad load;
  Duration sink_time;  ///< for which the reader computes with each image
  graph::Transport* transport = nullptr;
  /// Called between two images, half a period after each.
  std::function<void(std::uint32_t number)> between;
  /// Records the images into files of this path.
  std::string record;
  launch::SignalPipe* stop_signals = nullptr;  ///< a signal ends the run; none: nothing does
};

/// Runs the graph in real time until all images are published; a sink alone until a signal comes.
/// `started` is called before, with all components constructed.
void run_latency_graph(const LatencyGraph& graph, Latencies& latencies,
                       const std::function<void(graph::Runtime&)>& started = {});

}  // namespace furrow::benchmarks
