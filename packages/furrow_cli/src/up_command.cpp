#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "furrow_launch/run_report.hpp"
#include "furrow_supervisor/supervised_deployment.hpp"
#include "output_options.hpp"
#include "run_options.hpp"

namespace furrow::cli {
namespace {

struct UpOptions {
  launch::RunOptions run;
  std::string host;
  bool resume = false;
  bool force = false;
};

int up(const UpOptions& options) {
  const supervisor::SupervisedDeployment deployment(options.run, options.host);
  std::optional<OutputFolder> claimed;
  if (deployment.reports()) {
    claimed = claim_folder(options.run.out, launch::report_files(), options.force);
  }
  return deployment.run({.program = std::filesystem::read_symlink("/proc/self/exe"),
                         .out = claimed ? claimed->path() : std::filesystem::path(options.run.out),
                         .resume = options.resume,
                         .show = [](const std::string& line) {
                           std::cerr << line + "\n" << std::flush;
                         }});
}

}  // namespace

void add_up_command(Command root) {
  auto options = std::make_shared<UpOptions>();
  options->run.deploy = "distributed";
  Command command = root.subcommand(
      "up", "Runs all processes of a deployment on this host, and restarts those that die.");
  add_run_options(command, options->run);
  command.option("--host", options->host, "which host of the deployment this is");
  command.flag("--resume", options->resume,
               "let tools leave a safe state that a lost process or host caused, once it is back; "
               "otherwise a message on tool/reset must");
  add_force_option(command, options->force);
  command.on_run([options] { return up(*options); });
}

}  // namespace furrow::cli
