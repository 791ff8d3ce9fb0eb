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

/// One message as bytes, of any type.
struct RawMessage {
  std::vector<std::byte>
      payload;          ///< encapsulation header (4 bytes), CDR form, up to 3 bytes of padding
  Time source_time;     ///< Unix time at the writer's host
  Time reception_time;  ///< Unix time at this host
  Guid writer;
};

using RawPayload = std::shared_ptr<const std::vector<std::byte>>;

/// Reads any topic, for recorders and tools.
using RawReader = graph::TransportReader;

/// Writes any topic, for players. As graph::TransportWriter, with bytes instead of messages.
class RawWriter {
 public:
  virtual ~RawWriter() = default;
  [[nodiscard]] virtual bool has_readers() const = 0;
  /// `payload`: encapsulation header and CDR form. A shorter payload, or null, is dropped and
  /// counted.
  virtual void write(RawPayload payload) = 0;
  /// Sends on the calling thread without the queue, and may block: plain DDS, for benchmarks. False
  /// if DDS refused the message. Do not mix with write(), which it may overtake.
  [[nodiscard]] virtual bool write_now(const std::vector<std::byte>& payload) = 0;
  [[nodiscard]] virtual graph::TransportCounters counters() const = 0;
};

}  // namespace furrow::dds
