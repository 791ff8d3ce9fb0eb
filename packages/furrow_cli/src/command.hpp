#pragma once

#include <CLI/CLI.hpp>

namespace furrow::cli {

// Each adds one verb to the command line. A verb sets `exit_code` when it has run: 0 well, 1 ran
// but failed or found faults. Bad usage and configuration throw, and main() makes them 2.
void add_run_command(CLI::App& app, int& exit_code);
void add_calibrate_command(CLI::App& app, int& exit_code);
void add_graph_command(CLI::App& app, int& exit_code);
void add_params_command(CLI::App& app, int& exit_code);
void add_dataset_command(CLI::App& app, int& exit_code);
void add_field_command(CLI::App& app, int& exit_code);
void add_field_import_command(CLI::App& app, int& exit_code);
void add_eval_command(CLI::App& app, int& exit_code);
void add_eval_tracking_command(CLI::App& app, int& exit_code);
void add_eval_trial_command(CLI::App& app, int& exit_code);
void add_bench_command(CLI::App& app, int& exit_code);
void add_bench_program_commands(CLI::App& app, int& exit_code);
void add_up_command(CLI::App& app, int& exit_code);
void add_topic_command(CLI::App& app, int& exit_code);
void add_record_command(CLI::App& app, int& exit_code);
void add_play_command(CLI::App& app, int& exit_code);
void add_bag_command(CLI::App& app, int& exit_code);
void add_bench_graph_command(CLI::App& app, int& exit_code);
void add_bench_recording_command(CLI::App& app, int& exit_code);

void add_detect_command(CLI::App& app, int& exit_code);
void add_eval_vision_command(CLI::App& app, int& exit_code);
void add_bench_vision_command(CLI::App& app, int& exit_code);

}  // namespace furrow::cli
