#include <string>

#include "commands.hpp"
#include "furrow_core/version.hpp"

namespace furrow::cli {

Command bag_group(Command root) {
  return root.group("bag",
                    "Inspects, checks, repairs and converts recordings: MCAP, ROS 1 .bag, ROS 2 "
                    ".db3 and rosbag2 folders.");
}

Command bench_group(Command root) {
  return root.group("bench", "Measures speeds, each beside an alternative.");
}

Command eval_group(Command root) {
  return root.group("eval", "Runs the experiments, with the paper's figures beside ours.");
}

Command field_group(Command root) {
  return root.group("field", "Makes and shows field models.");
}

}  // namespace furrow::cli

int main(int argc, char** argv) {
  using namespace furrow::cli;
  CommandLine command_line("furrow",
                           "Furrow: detects plants, decides which weeds matter, and treats them.",
                           std::string(furrow::version()));
  const Command root = command_line.root();
  add_run_command(root);
  add_up_command(root);
  add_calibrate_command(root);
  add_graph_commands(root);
  add_params_command(root);
  add_doctor_command(root);
  add_dataset_commands(root);
  add_field_commands(root);
  add_field_import_command(root);
  add_eval_planner_commands(root);
  add_eval_tracking_command(root);
  add_eval_trial_command(root);
  add_eval_vision_command(root);
  add_bench_planner_command(root);
  add_bench_program_commands(root);
  add_bench_graph_command(root);
  add_bench_recording_command(root);
  add_bench_vision_command(root);
  add_topic_commands(root);
  add_record_command(root);
  add_play_command(root);
  add_bag_commands(root);
  add_bag_copy_commands(root);
  add_bag_export_command(root);
  add_detect_command(root);
  return command_line.run(argc, argv);
}
