#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>

#include "commands.hpp"
#include "console.hpp"
#include "control_input.hpp"
#include "furrow_core/text.hpp"
#include "furrow_launch/signals.hpp"
#include "furrow_recording/dds_recorder.hpp"
#include "parameter_options.hpp"
#include "transport_options.hpp"

namespace furrow::cli {
namespace {

using Clock = std::chrono::steady_clock;
using recording::RecorderState;

struct RecordOptions {
  std::vector<std::string> patterns;
  std::string out;
  double duration_s = 0.0;
  launch::TransportOptions transport;
  recording::RecorderParameters recorder;
};

std::string stem_of(const std::string& out) {
  if (out.empty()) {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    char text[64];
    std::strftime(text, sizeof text, "recording_%Y%m%d_%H%M%S", &local);
    return text;
  }
  const std::filesystem::path path(out);
  if (path.filename().empty()) throw ConfigError("--out: " + out + " names no file");
  return path.extension() == ".mcap" ? std::filesystem::path(path).replace_extension().string()
                                     : out;
}

const char* state_name(RecorderState state) {
  switch (state) {
    case RecorderState::kArmed:
      return "armed";
    case RecorderState::kRecording:
      return "recording";
    case RecorderState::kPaused:
      return "paused";
    case RecorderState::kStopped:
      break;
  }
  return "stopped";
}

std::string totals(const recording::RecorderStatus& status) {
  return std::to_string(status.messages) + " messages, " +
         fixed(static_cast<double>(status.bytes) * 1e-6, 1) + " MB, " +
         std::to_string(status.dropped) + " lost";
}

/// What stops the recording or changes its state, from other threads.
class Requests {
 public:
  void stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    wake_.notify_all();
  }
  /// True when it is to stop.
  bool wait(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return wake_.wait_for(lock, time, [this] { return stopped_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopped_ = false;
};

void obey(const std::string& line, recording::DdsRecorder& recorder, Requests& requests) {
  if (line == "p" || line == "pause") {
    recorder.pause();
  } else if (line == "r" || line == "resume") {
    recorder.resume();
  } else if (line == "t" || line == "trigger") {
    recorder.trigger();
  } else if (line == "q" || line == "quit") {
    requests.stop();
    return;
  } else if (!line.empty()) {
    std::cerr << "furrow: unknown '" << line << "'; there are pause, resume, trigger, quit\n";
    return;
  }
  const auto status = recorder.status();
  std::cerr << state_name(status.state) << ": " << totals(status) << '\n';
}

int report(const recording::RecorderStatus& status, const std::vector<std::string>& skipped) {
  std::vector<std::vector<std::string>> rows = {{"topic", "messages", "MB", "lost"}};
  // A latched topic has a channel for each publisher.
  std::map<std::string, recording::RecordedTopic> by_name;
  for (const recording::RecordedTopic& channel : status.topics) {
    recording::RecordedTopic& topic = by_name[channel.name];
    topic.name = channel.name;
    topic.messages += channel.messages;
    topic.bytes += channel.bytes;
    topic.dropped += channel.dropped;
  }
  for (const auto& [name, topic] : by_name) {
    rows.push_back({topic.name, std::to_string(topic.messages),
                    fixed(static_cast<double>(topic.bytes) * 1e-6, 3),
                    std::to_string(topic.dropped)});
  }
  std::cout << text_table(rows);
  for (const std::string& topic : skipped) std::cout << "not recorded: " << topic << '\n';
  for (const auto& file : status.files) std::cout << file.string() << '\n';
  std::cout << totals(status);
  if (status.paused > 0) std::cout << ", " << status.paused << " let go while paused";
  if (status.expired > 0) std::cout << ", " << status.expired << " older than the window";
  std::cout << '\n';
  if (!status.fault.empty()) {
    std::cerr << "furrow: " << status.fault << '\n';
    return 1;
  }
  if (status.messages == 0) {
    std::cerr << "furrow: nothing was recorded\n";
    return 1;
  }
  return status.dropped > 0 ? 1 : 0;
}

int record(RecordOptions options) {
  if (!options.patterns.empty()) options.recorder.include = options.patterns;
  const std::string stem = stem_of(options.out);
  Requests requests;
  launch::SignalPipe signals({SIGINT, SIGTERM});
  const launch::SignalWatch watch(signals, [&requests](int) { requests.stop(); });
  dds::DdsTransport transport(launch::transport_parameters(options.transport, "furrow_record"));
  recording::DdsRecorder recorder(transport, options.recorder, stem);
  std::cerr << state_name(recorder.status().state) << " to " << stem
            << "_N.mcap; pause, resume, trigger and quit are taken from the keyboard\n";
  const ControlInput control([&](const std::string& line) { obey(line, recorder, requests); });

  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  const auto start = Clock::now();
  constexpr std::chrono::milliseconds kLook{200};
  while (!requests.wait(kLook)) {
    const auto status = recorder.status();
    const double passed_s = std::chrono::duration<double>(Clock::now() - start).count();
    if (terminal) {
      std::cerr << '\r' << state_name(status.state) << ' ' << fixed(passed_s, 0)
                << " s: " << totals(status) << "\033[K" << std::flush;
    }
    if (status.state == RecorderState::kStopped) break;
    if (options.duration_s > 0.0 && passed_s >= options.duration_s) break;
  }
  if (terminal) std::cerr << '\n';
  const Status stopped = recorder.stop();
  const int code = report(recorder.status(), recorder.skipped());
  return stopped ? code : 1;
}

}  // namespace

void add_record_command(Command root) {
  auto options = std::make_shared<RecordOptions>();
  Command command =
      root.subcommand("record", "Records topics of a running system, of any type, to MCAP files.");
  command.option("topics", options->patterns, "names, or patterns with * and ?; default: all");
  command.option("--out", options->out,
                 "path of the files, without _0.mcap, _1.mcap, ...; default: date and time");
  command.option("--duration", options->duration_s, "time to record, s; 0: until stopped")
      .range(0.0, 1e6);
  add_transport_options(command, options->transport);
  ParameterOptions recorder(command, {"include"});
  options->recorder.visit(recorder);
  command.on_run([options] { return record(*options); });
}

}  // namespace furrow::cli
