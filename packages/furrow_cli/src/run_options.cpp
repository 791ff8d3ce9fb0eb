#include "run_options.hpp"

namespace furrow::cli {

void add_run_options(Command command, launch::RunOptions& options) {
  command.option("--graph", options.graph, "graph file, or the name of a shipped graph");
  command.option("--deploy", options.deploy, "deployment file, or the name of a shipped one");
  command.option("--set", options.settings,
                 "COMPONENT.KEY=VALUE overrides a parameter; common.KEY=VALUE for all components");
  command.option("--dds,--wire", options.dds_settings,
                 "KEY=VALUE overrides a DDS parameter of the deployment");
  command
      .option("--domain", options.domain_id,
              "DDS domain; default: that of the deployment, else ROS_DOMAIN_ID, else 0")
      .range(0, 232);
  command.option("--address", options.addresses,
                 "HOST=ADDRESS overrides an address of the deployment");
  command.option("--field", options.field,
                 "field: a shipped preset, a preset file, or plants as CSV or GeoJSON");
  command.option("--ground", options.ground,
                 "what the simulated camera shows: rendered, or photos:FOLDER");
  command.option("--length", options.length_m, "length of the row, m");
  command.option("--seed", options.seed, "seed of all random numbers").at_least(0);
  command
      .option("--clock", options.clock,
              "lockstep: simulated time, as fast as possible; real: real time")
      .choices({"lockstep", "real"});
  command.option("--threads", options.threads, "worker threads").range(1, 256);
  command.option("--out", options.out,
                 "folder for the report; numbered when it holds an earlier report");
  command.option("--record", options.record,
                 "record the topics to PATH_0.mcap, PATH_1.mcap, ... (parameters of recorder)");
  command.option("--recording", options.recordings,
                 "play camera and odometry from these recordings in place of the simulator "
                 "(parameters of playback)");
  command.option("--log-level", options.log_levels,
                 "LEVEL or COMPONENT=LEVEL: the least level to log, of debug, info, warn, error, "
                 "fatal");
}

}  // namespace furrow::cli
