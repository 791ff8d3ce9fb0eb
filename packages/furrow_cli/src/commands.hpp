#pragma once

#include "command_line.hpp"

namespace furrow::cli {

// Each adds one command, or some of a group, below the root.
void add_bag_commands(Command root);
void add_bag_copy_commands(Command root);
void add_bag_export_command(Command root);
void add_bench_graph_command(Command root);
void add_bench_planner_command(Command root);
void add_bench_program_commands(Command root);
void add_bench_recording_command(Command root);
void add_bench_vision_command(Command root);
void add_calibrate_command(Command root);
void add_dataset_commands(Command root);
void add_detect_command(Command root);
void add_doctor_command(Command root);
void add_eval_planner_commands(Command root);
void add_eval_tracking_command(Command root);
void add_eval_trial_command(Command root);
void add_eval_vision_command(Command root);
void add_field_commands(Command root);
void add_field_import_command(Command root);
void add_graph_commands(Command root);
void add_params_command(Command root);
void add_play_command(Command root);
void add_record_command(Command root);
void add_run_command(Command root);
void add_topic_commands(Command root);
void add_up_command(Command root);

// Groups that several files fill.
[[nodiscard]] Command bag_group(Command root);
[[nodiscard]] Command bench_group(Command root);
[[nodiscard]] Command eval_group(Command root);
[[nodiscard]] Command field_group(Command root);

}  // namespace furrow::cli
