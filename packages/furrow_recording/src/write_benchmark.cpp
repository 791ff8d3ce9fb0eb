#include "furrow_recording/write_benchmark.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <string>
#include <thread>

#include "furrow_core/random.hpp"
#include "furrow_recording/recorder_thread.hpp"
#include "units.hpp"

namespace furrow::recording {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Result<double> dd_mbps(const std::filesystem::path& folder, std::uint64_t megabytes) {
  const auto file = folder / "furrow_dd.bin";
  const std::uint64_t blocks = megabytes * 1'000'000 / (1u << 20);
  std::array<std::string, 6> arguments = {"dd",
                                          "if=/dev/zero",
                                          "of=" + file.string(),
                                          "bs=1M",
                                          "count=" + std::to_string(blocks),
                                          "conv=fdatasync"};
  std::array<char*, 8> argv{};
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    argv[i] = arguments[i].data();
  }
  std::string quiet = "status=none";
  argv[6] = quiet.data();
  const auto start = Clock::now();
  pid_t pid = 0;
  int status = 0;
  if (posix_spawnp(&pid, "dd", nullptr, nullptr, argv.data(), environ) != 0 ||
      waitpid(pid, &status, 0) != pid) {
    return Error{ErrorCode::kUnavailable, "cannot run dd"};
  }
  const double passed_s = seconds_since(start);
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    return Error{ErrorCode::kIo, "dd failed in " + folder.string()};
  }
  return static_cast<double>(blocks * (1u << 20)) / kBytesPerMb / passed_s;
}

Result<WriteBenchmarkRun> record(const std::filesystem::path& folder,
                                 const WriteBenchmarkOptions& options, const Payload& payload) {
  RecorderParameters parameters;
  parameters.compression = "none";
  parameters.min_free_mb = 0.0;
  const auto stem = folder / "furrow_recorder";
  auto file = stem;
  file += "_0.mcap";
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  const std::uint64_t messages = options.megabytes * 1'000'000 / options.message_bytes;
  WriteBenchmarkRun run;
  const auto start = Clock::now();
  {
    RecorderThread recorder(parameters, stem);
    TopicDescription topic;
    topic.name = "camera/image";
    topic.type_name = "sensor_msgs/msg/Image";
    topic.offered_qos = {msgs::reliable_stream_qos()};
    const auto number = recorder.add_topic(topic);
    for (std::uint64_t i = 0; i < messages; ++i) {
      const Time time = Time() + Duration::milliseconds(static_cast<std::int64_t>(i));
      // As fast as the disk takes them: a full queue is waited for.
      while (!recorder.record(number, time, time, payload)) {
        std::this_thread::sleep_for(std::chrono::microseconds(200));
      }
    }
    if (Status status = recorder.stop(); !status) {
      return status.error();
    }
    run.dropped = messages - recorder.status().messages;
  }
  run.recorder_mbps =
      static_cast<double>(messages * options.message_bytes) / kBytesPerMb / seconds_since(start);
  std::filesystem::remove(file, ignored);
  return run;
}

}  // namespace

Result<std::vector<WriteBenchmarkRun>> benchmark_writing(const std::filesystem::path& folder,
                                                         const WriteBenchmarkOptions& options) {
  Random random(1, "payload");
  std::vector<std::byte> bytes(static_cast<std::size_t>(options.message_bytes));
  for (auto& byte : bytes) {
    byte = static_cast<std::byte>(random.next());
  }
  const auto payload = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
  std::vector<WriteBenchmarkRun> runs;
  for (int i = 0; i < options.runs; ++i) {
    // Each goes first in turns: the disk still works on what came before.
    Result<double> dd = 0.0;
    if (i % 2 == 0) {
      dd = dd_mbps(folder, options.megabytes);
    }
    auto run = record(folder, options, payload);
    if (i % 2 != 0) {
      dd = dd_mbps(folder, options.megabytes);
    }
    if (!dd || !run) {
      return dd ? run.error() : dd.error();
    }
    run->dd_mbps = *dd;
    runs.push_back(*run);
  }
  return runs;
}

}  // namespace furrow::recording
