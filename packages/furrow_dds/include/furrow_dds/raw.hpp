#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_dds/discovery.hpp"
#include "furrow_graph/transport.hpp"

namespace furrow::dds {

/// One message as it came, its type unknown.
struct RawMessage {
  std::vector<std::byte>
      payload;          ///< encapsulation header (4 bytes), CDR form, up to 3 bytes of padding
  Time source_time;     ///< Unix time at the writer's host
  Time reception_time;  ///< Unix time at this host
  Guid writer;
};

using RawPayload = std::shared_ptr<const std::vector<std::byte>>;

/// Reads any topic, for recorders and tools. What this process publishes itself is left out.
class RawReader {
 public:
  virtual ~RawReader() = default;
  [[nodiscard]] virtual graph::TransportCounters counters() const = 0;
  /// Writers outside this process that are matched now.
  [[nodiscard]] virtual int writers() const = 0;
};

/// Writes any topic, for players. As graph::TransportWriter, with bytes in place of messages.
class RawWriter {
 public:
  virtual ~RawWriter() = default;
  [[nodiscard]] virtual bool has_readers() const = 0;
  /// `payload`: the CDR form behind its encapsulation header. Shorter ones than that, and null, are
  /// dropped and counted.
  virtual void write(RawPayload payload) = 0;
  /// Sends on the calling thread, past the queue, and may block: the plain middleware, for
  /// measuring. False when it was refused. Not for use beside write(): they may overtake each
  /// other.
  [[nodiscard]] virtual bool write_now(const std::vector<std::byte>& payload) = 0;
  [[nodiscard]] virtual graph::TransportCounters counters() const = 0;
};

}  // namespace furrow::dds
