#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "furrow_dds/dds_parameters.hpp"

namespace furrow::cli {

/// How a tool joins a running system.
struct WireOptions {
  std::int64_t domain_id = 0;
  std::vector<std::string> settings;
};

void add_wire_options(CLI::App& command, WireOptions& options);
/// Throws ConfigError for an unknown key or a bad value.
[[nodiscard]] dds::DdsParameters wire_parameters(const WireOptions& options,
                                                 const std::string& process_name);

}  // namespace furrow::cli
