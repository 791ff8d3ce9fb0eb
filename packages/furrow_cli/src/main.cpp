#include <exception>
#include <iostream>

#include "command.hpp"
#include "furrow_core/error.hpp"

int main(int argc, char** argv) {
  CLI::App app("Furrow: sees plants, decides which weeds matter, and treats them.", "furrow");
  app.set_version_flag("--version", std::string("furrow ") + FURROW_VERSION);
  app.require_subcommand(1);
  int exit_code = 0;
  furrow::cli::add_run_command(app, exit_code);
  furrow::cli::add_up_command(app, exit_code);
  furrow::cli::add_calibrate_command(app, exit_code);
  furrow::cli::add_graph_command(app, exit_code);
  furrow::cli::add_params_command(app, exit_code);
  furrow::cli::add_dataset_command(app, exit_code);
  furrow::cli::add_field_command(app, exit_code);
  furrow::cli::add_field_import_command(app, exit_code);
  furrow::cli::add_eval_command(app, exit_code);
  furrow::cli::add_eval_tracking_command(app, exit_code);
  furrow::cli::add_eval_trial_command(app, exit_code);
  furrow::cli::add_bench_command(app, exit_code);
  furrow::cli::add_bench_program_commands(app, exit_code);
  furrow::cli::add_topic_command(app, exit_code);
  furrow::cli::add_record_command(app, exit_code);
  furrow::cli::add_play_command(app, exit_code);
  furrow::cli::add_bag_command(app, exit_code);
  furrow::cli::add_bench_graph_command(app, exit_code);
  furrow::cli::add_bench_recording_command(app, exit_code);
  furrow::cli::add_detect_command(app, exit_code);
  furrow::cli::add_eval_vision_command(app, exit_code);
  furrow::cli::add_bench_vision_command(app, exit_code);
  constexpr int kBadUsage = 2;
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked_for_help) {
    return app.exit(asked_for_help);
  } catch (const CLI::ParseError& bad_usage) {
    app.exit(bad_usage);
    return kBadUsage;
  } catch (const furrow::ConfigError& bad_configuration) {
    std::cerr << "furrow: " << bad_configuration.what() << '\n';
    return kBadUsage;
  } catch (const std::exception& failure) {
    std::cerr << "furrow: " << failure.what() << '\n';
    return 1;
  }
  return exit_code;
}
