#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>

#include "commands.hpp"
#include "console.hpp"
#include "control_input.hpp"
#include "furrow_core/text.hpp"
#include "furrow_launch/signals.hpp"
#include "furrow_recording/dds_player.hpp"
#include "transport_options.hpp"

namespace furrow::cli {
namespace {

struct PlayOptions {
  std::vector<std::string> files;
  recording::PlayerOptions player;
  double start_s = 0.0;
  double duration_s = 0.0;
  std::vector<std::string> remaps;
  double wait_s = 2.0;
  launch::TransportOptions transport;
};

/// Tells what is not played; true when all that was asked for is.
bool tell_unplayed(const recording::Player& player) {
  const recording::RecordingInfo& info = player.recording();
  if (!info.damage.empty())
    std::cerr << "furrow: the recording is not whole: " << info.damage << '\n';
  for (const std::string& fault : info.faults) std::cerr << "furrow: left out: " << fault << '\n';
  for (const auto& topic : player.unplayable()) {
    std::cerr << "furrow: " << topic.name << " is not played (" << topic.messages
              << " messages): " << topic.reason << '\n';
  }
  for (const std::string& pattern : player.unmatched_patterns()) {
    std::cerr << "furrow: --topics: no topic matches '" << pattern << "'\n";
  }
  return info.whole() && player.unplayable().empty() && player.unmatched_patterns().empty();
}

recording::Player open(PlayOptions options) {
  for (const std::string& remap : options.remaps) {
    const auto equals = remap.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == remap.size()) {
      throw ConfigError("--remap: '" + remap + "' is not RECORDED=PLAYED");
    }
    options.player.remap[remap.substr(0, equals)] = remap.substr(equals + 1);
  }
  options.player.start_offset = Duration::seconds(options.start_s);
  if (options.duration_s > 0.0) options.player.duration = Duration::seconds(options.duration_s);
  const std::vector<std::filesystem::path> files(options.files.begin(), options.files.end());
  auto player = recording::Player::open(files, options.player);
  if (!player) throw ConfigError(player.error().message);
  if (player->topics().empty()) {
    tell_unplayed(*player);
    throw ConfigError("no topic of the recording can be played");
  }
  return std::move(player).value();
}

/// Obeys lines from the keyboard; false for "quit".
class Controls {
 public:
  Controls(recording::DdsPlayer& player, Time begin) : player_(player), begin_(begin) {}

  bool obey(const std::string& line) {
    std::istringstream words(line);
    std::string verb;
    words >> verb;
    if (verb == "q" || verb == "quit") return false;
    if (verb == "p" || verb == "pause") {
      player_.pause();
    } else if (verb == "r" || verb == "resume") {
      player_.resume();
    } else if (verb == "s" || verb == "step") {
      std::uint64_t count = 1;
      words >> count;
      player_.step(count);
    } else if (double value = 0.0; (verb == "seek" || verb == "rate") && words >> value) {
      if (!change(verb, value)) return true;
    } else if (!verb.empty()) {
      std::cerr << "furrow: unknown '" << line
                << "'; there are pause, resume, step N, seek SECONDS, rate FACTOR, quit\n";
      return true;
    }
    const auto status = player_.status();
    std::cerr << (status.paused ? "paused at " : "playing at ")
              << fixed((status.position - begin_).to_seconds(), 3) << " s, " << status.messages
              << " messages\n";
    return true;
  }

 private:
  bool change(const std::string& verb, double value) {
    constexpr double kMaxSeconds = 1e9;
    Status done;
    if (verb == "rate") {
      done = player_.set_rate(value);
    } else if (value >= 0.0 && value < kMaxSeconds) {
      player_.seek(begin_ + Duration::seconds(value));
    } else {
      done = Error{ErrorCode::kOutOfRange, "seek takes seconds from the begin"};
    }
    if (!done) std::cerr << "furrow: " << done.error().message << '\n';
    return done.ok();
  }

  recording::DdsPlayer& player_;
  Time begin_;
};

int report(const recording::DdsPlayerStatus& status) {
  std::cout << status.messages << " messages, " << status.dropped << " lost, timing error p99 "
            << fixed(status.lateness_p99_s * 1e3, 3) << " ms\n";
  if (status.faults > 0) {
    std::cerr << "furrow: " << status.faults
              << " damaged parts left out, the last: " << status.last_fault << '\n';
  }
  return status.faults > 0 || status.dropped > 0 ? 1 : 0;
}

int play(const PlayOptions& options) {
  recording::Player opened = open(options);
  const bool complete = tell_unplayed(opened);
  const Time begin = opened.begin();
  const double length_s = (opened.end() - begin).to_seconds();
  std::atomic<bool> stopped = false;
  launch::SignalPipe signals({SIGINT, SIGTERM});
  const launch::SignalWatch watch(signals, [&stopped](int) { stopped = true; });
  dds::DdsTransport transport(launch::transport_parameters(options.transport, "furrow_play"));
  recording::DdsPlayer player(transport, std::move(opened),
                              {.wait_for_readers = Duration::seconds(options.wait_s)});
  Controls controls(player, begin);
  const ControlInput control([&](const std::string& line) {
    if (!controls.obey(line)) stopped = true;
  });
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  while (!stopped && !player.wait(Duration::milliseconds(100))) {
    if (!terminal) continue;
    const auto status = player.status();
    std::cerr << '\r' << (status.paused ? "paused" : "playing") << ' '
              << fixed((status.position - begin).to_seconds(), 1) << " of " << fixed(length_s, 1)
              << " s\033[K" << std::flush;
  }
  if (terminal) std::cerr << '\n';
  player.stop();
  constexpr Duration kPatience = Duration::milliseconds(5000);
  const bool delivered = stopped || transport.flush(kPatience);
  if (!delivered) std::cerr << "furrow: not everything was acknowledged\n";
  const int code = report(player.status());
  return delivered && complete ? code : 1;
}

}  // namespace

void add_play_command(Command root) {
  auto options = std::make_shared<PlayOptions>();
  Command command = root.subcommand(
      "play", "Plays recordings to a running system, with the QoS that was recorded.");
  command
      .option("recordings", options->files,
              "files or rosbag2 folders, of one recording or of one clock")
      .required();
  command.option("--rate", options->player.rate, "recorded seconds per second")
      .range(0.001, 1000.0);
  command.option("--start", options->start_s, "where to start, s from the first message")
      .range(0.0, 1e9);
  command.option("--duration", options->duration_s, "recorded time to play, s; 0: all")
      .range(0.0, 1e9);
  command.flag("--loop", options->player.loop, "start again at the end");
  command.flag("--pause", options->player.start_paused,
               "start paused; \"resume\" or \"step N\" on the keyboard continues");
  command.option("--topics", options->player.topics.include,
                 "names, or patterns with * and ?, to play; default: all");
  command.option("--exclude", options->player.topics.exclude, "names or patterns not to play");
  command.option("--remap", options->remaps, "RECORDED=PLAYED: publish a topic by another name");
  command
      .option("--clock", options->player.clock_hz,
              "messages on /clock per recorded second; 0: none")
      .range(0.0, 1e6);
  command.option("--wait", options->wait_s, "longest wait for a subscriber, s").range(0.0, 3600.0);
  add_transport_options(command, options->transport);
  command.on_run([options] { return play(*options); });
}

}  // namespace furrow::cli
