#pragma once

#include "command_line.hpp"
#include "furrow_launch/transport_options.hpp"

namespace furrow::cli {

/// Adds --domain and --dds.
void add_transport_options(Command command, launch::TransportOptions& options);

}  // namespace furrow::cli
