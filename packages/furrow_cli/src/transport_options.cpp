#include "transport_options.hpp"

namespace furrow::cli {

void add_transport_options(Command command, launch::TransportOptions& options) {
  command.option("--domain", options.domain_id, "DDS domain; default: ROS_DOMAIN_ID, else 0")
      .range(0, 232);
  command.option("--dds,--wire", options.settings, "KEY=VALUE of the DDS parameters");
}

}  // namespace furrow::cli
