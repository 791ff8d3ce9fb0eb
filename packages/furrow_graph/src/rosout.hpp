#pragma once

#include <functional>
#include <memory>

#include "furrow_graph/transport.hpp"
#include "furrow_log/log.hpp"

namespace furrow::graph {

/// Publishes lines of the log as rcl_interfaces/msg/Log. `writer` may be null; `deliver` delivers a
/// message to the readers in this process. Where time is simulated, these get no text of libraries,
/// so that their input does not depend on the computer.
[[nodiscard]] std::shared_ptr<log::Sink> make_rosout_sink(
    std::unique_ptr<TransportWriter> writer, std::function<void(const MessagePtr&)> deliver,
    bool real_time);

}  // namespace furrow::graph
