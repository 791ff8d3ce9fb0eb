#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::dds {

/// Settings of one process in a DDS domain.
struct DdsParameters {
  std::int64_t domain_id = 0;
  std::string process_name = "furrow";
  std::vector<std::string> transports = {"shm", "udp"};
  std::vector<std::string> shm_types = {"sensor_msgs/msg/Image", "sensor_msgs/msg/PointCloud2"};
  std::vector<std::string> interfaces = {"127.0.0.1"};
  std::string discovery = "multicast";
  std::vector<std::string> peers;
  std::int64_t shm_segment_mb = 32;
  std::int64_t socket_buffer_kb = 4096;
  double lease_s = 3.0;
  std::int64_t bulk_threshold_kb = 64;
  std::int64_t queue_limit = 1000;
  double linger_s = 0.1;

  void visit(ParameterVisitor& v) {
    visit_participant(v);
    visit_discovery(v);
    visit_resources(v);
    visit_sending(v);
  }

 private:
  void visit_participant(ParameterVisitor& v) {
    v.visit({.name = "domain_id",
             .description = "DDS domain; only processes of one domain see each other",
             .min = 0,
             .max = 232},
            domain_id);
    v.visit({.name = "process_name", .description = "name by which other processes see this one"},
            process_name);
    v.visit({.name = "transports",
             .description = "\"shm\" (same host), \"udp\", or both; processes need a common one"},
            transports);
    v.visit({.name = "shm_types",
             .description = "with both transports, types whose messages use shared memory; "
                            "others use UDP, which a crashing process cannot damage"},
            shm_types);
    v.visit({.name = "interfaces",
             .description = "IPv4 addresses of this host that UDP may use; empty: all of them"},
            interfaces);
  }

  void visit_discovery(ParameterVisitor& v) {
    v.visit({.name = "discovery",
             .description = "how processes find each other",
             .choices = {"multicast", "static_peers", "discovery_server"}},
            discovery);
    v.visit({.name = "peers",
             .description = "IPv4 addresses, each with an optional \":port\": the other hosts "
                            "(static_peers), or the servers in the order of their ids "
                            "(discovery_server, port 11811 unless given)"},
            peers);
  }

  void visit_resources(ParameterVisitor& v) {
    v.visit({.name = "shm_segment_mb",
             .unit = "MB",
             .description = "shared memory of this process for messages being sent, allocated at "
                            "the start; at least twice the largest message",
             .min = 1,
             .max = 4000},
            shm_segment_mb);
    v.visit({.name = "socket_buffer_kb",
             .unit = "kB",
             .description = "send and receive buffers of UDP; the system may allow less",
             .min = 64,
             .max = 1048576},
            socket_buffer_kb);
    v.visit(
        {.name = "lease_s",
         .unit = "s",
         .description = "after this silence a process counts as gone; it announces itself three "
                        "times as often",
         .min = 0.3,
         .max = 3600},
        lease_s);
  }

  void visit_sending(ParameterVisitor& v) {
    v.visit({.name = "bulk_threshold_kb",
             .unit = "kB",
             .description = "topics with larger messages are sent by a second thread",
             .min = 1,
             .max = 1048576},
            bulk_threshold_kb);
    v.visit(
        {.name = "queue_limit",
         .description = "limit of each topic's send queue, which otherwise has the topic's depth",
         .min = 1,
         .max = 100000},
        queue_limit);
    v.visit({.name = "linger_s",
             .unit = "s",
             .description = "time for all writers together to deliver waiting messages at shutdown",
             .min = 0,
             .max = 10},
            linger_s);
  }
};

}  // namespace furrow::dds
