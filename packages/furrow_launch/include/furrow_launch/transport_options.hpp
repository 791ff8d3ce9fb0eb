#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "furrow_dds/dds_parameters.hpp"

namespace furrow::launch {

/// How a tool joins the DDS domain of a running system.
struct TransportOptions {
  std::optional<std::int64_t> domain_id;  ///< nothing: ROS_DOMAIN_ID, else 0
  std::vector<std::string> settings;      ///< "KEY=VALUE" of dds::DdsParameters
};

/// The value of ROS_DOMAIN_ID; nothing where it is unset or empty. Throws ConfigError when it is
/// not a whole number from 0 to 232.
[[nodiscard]] std::optional<std::int64_t> domain_from_environment();

/// Throws ConfigError for an unknown key or a bad value. A `domain_id` among the settings has
/// precedence over options.domain_id, which has precedence over ROS_DOMAIN_ID.
[[nodiscard]] dds::DdsParameters transport_parameters(const TransportOptions& options,
                                                      const std::string& process_name);

}  // namespace furrow::launch
