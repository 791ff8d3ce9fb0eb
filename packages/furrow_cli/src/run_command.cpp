#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "console.hpp"
#include "furrow_core/text.hpp"
#include "furrow_launch/run_report.hpp"
#include "furrow_launch/run_session.hpp"
#include "furrow_launch/run_summary.hpp"
#include "output_options.hpp"
#include "run_log.hpp"
#include "run_options.hpp"

namespace furrow::cli {
namespace {

struct RunCommandOptions {
  launch::RunOptions run;
  std::string process;
  bool no_dds = false;
  bool force = false;
  bool supervised = false;  ///< the supervisor has claimed the folder of the report
};

launch::RunOutcome run_session(launch::RunSession& session, const launch::RunOptions& options,
                               launch::SignalPipe& signals, RunLog& log) {
  ProgressBar bar("weeding");
  const launch::RunSession::Callbacks callbacks = {
      .progress =
          [&](const furrow_msgs::msg::RunStatus& status) {
            if (!session.shows_progress()) return;
            bar.show(status.progress(), fixed(status.distance_m(), 1) + " m, " +
                                            fixed(status.speed_mps(), 2) + " m/s");
          },
      .warn = [&log](const std::string& text) { log.write(log::Level::kWarn, text); },
      .log = &log.log()};
  log.write(log::Level::kInfo,
            "run of graph '" + options.graph + "' starts, seed " + std::to_string(options.seed));
  launch::RunOutcome outcome = session.run(signals, callbacks);
  bar.finish();
  log.run_started();
  return outcome;
}

void print(const launch::RunReport& report, const std::filesystem::path& folder) {
  std::cout << '\n'
            << report.summary.field << " (" << report.summary.source << ")\n"
            << launch::outcome_text(report.summary, report.dropped_messages);
  if (!report.unhealthy.empty()) std::cout << "\nnot well at the end:\n";
  for (const std::string& line : report.unhealthy) std::cout << "  " << line << '\n';
  std::cout << "\nreport: " << (folder / "report.html").string() << '\n';
}

int run(const RunCommandOptions& options) {
  launch::RunSession session(options.run, options.process, !options.no_dds);
  std::optional<OutputFolder> claimed;
  if (session.reports() && !options.supervised) {
    claimed = claim_folder(options.run.out, launch::report_files(), options.force);
  }
  const std::filesystem::path folder =
      claimed ? claimed->path() : std::filesystem::path(options.run.out);

  const auto start = options.supervised ? log::FileStart::kAppend : log::FileStart::kReplace;
  RunLog log(options.run, folder, session.process_name(), start);
  launch::SignalPipe signals({SIGINT, SIGTERM});
  const launch::RunOutcome outcome = run_session(session, options.run, signals, log);
  // The report is worth waiting for: one signal does not lose it, a second one ends the process.
  const launch::SignalWatch impatience(signals, [](int call) {
    if (call > 1) std::_Exit(1);
  });
  const bool has_report = session.reports() && outcome.record != nullptr;
  const bool well = !outcome.result.failed && outcome.result.reason == "finished";
  if (well && !outcome.interrupted) {
    log.write(outcome.result.end, log::Level::kInfo, "the run is finished");
  } else {
    log.write(outcome.result.end, log::Level::kFatal,
              "the run ended early: " +
                  (outcome.interrupted ? std::string("interrupted") : outcome.result.reason) +
                  (session.reports() && !has_report ? "; there is no report" : ""));
  }
  if (has_report && !outcome.result.failed) {
    const auto report = launch::write_run_report(outcome, session.prepared(), options.run, folder);
    if (!report.ok()) {
      log.write(log::Level::kFatal, report.error().message);
      return 1;
    }
    print(*report, folder);
  }
  return well && !outcome.interrupted ? 0 : 1;
}

}  // namespace

void add_run_command(Command root) {
  auto options = std::make_shared<RunCommandOptions>();
  Command command = root.subcommand("run", "Runs a graph and writes its report.");
  add_run_options(command, options->run);
  command.option("--process", options->process, "which process of the deployment to run");
  command.flag("--no-dds", options->no_dds, "stay out of the DDS domain");
  command.flag("--no-wire", options->no_dds, "the former name of --no-dds").hide();
  add_force_option(command, options->force);
  command.flag("--supervised", options->supervised, "used by `furrow up`").hide();
  command.on_run([options] { return run(*options); });
}

}  // namespace furrow::cli
