#include "furrow_benchmarks/recording_benchmark.hpp"

#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "furrow_benchmarks/latency_graph.hpp"
#include "furrow_core/statistics.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/topics.hpp"
#include "furrow_recording/dds_player.hpp"
#include "furrow_recording/mcap_reader.hpp"
#include "furrow_recording/recorder.hpp"

namespace furrow::benchmarks {
namespace {

constexpr std::size_t kImageBytes = 3'700'000;
constexpr std::size_t kOdometryBytes = 700;
constexpr char kImages[] = "bench/image";
constexpr char kOdometry[] = "bench/odometry";

/// Removes the files of a recording before and after its use.
class ScratchRecording {
 public:
  ScratchRecording(const std::filesystem::path& folder, const std::string& name)
      : stem_((folder / ("furrow_bench_" + name)).string()) {
    remove();
  }
  ~ScratchRecording() { remove(); }
  ScratchRecording(const ScratchRecording&) = delete;
  ScratchRecording& operator=(const ScratchRecording&) = delete;
  [[nodiscard]] const std::string& stem() const { return stem_; }
  [[nodiscard]] std::filesystem::path file() const { return stem_ + "_0.mcap"; }

 private:
  void remove() const {
    std::error_code ignored;
    std::filesystem::remove(file(), ignored);
  }
  std::string stem_;
};

void require(const Status& status) {
  if (!status) throw std::runtime_error(status.error().message);
}

std::uint64_t messages_in(const std::filesystem::path& file) {
  auto source = mcap::open_file(file);
  if (!source) throw std::runtime_error(source.error().message);
  const auto reader = mcap::Reader::open(std::move(*source));
  if (!reader) throw std::runtime_error(reader.error().message);
  return reader->summary().statistics->message_count;
}

RecordedGraphTiming measure_graph(const RecordingBenchmark& benchmark) {
  LatencyGraph graph;
  graph.load = {
      .bytes = {kImageBytes}, .period = Duration::milliseconds(50), .messages = benchmark.messages};
  RecordedGraphTiming timing;
  timing.messages = static_cast<std::uint64_t>(benchmark.messages);
  {
    Latencies alone;
    run_latency_graph(graph, alone);
    timing.alone_p50_us = quantile(alone.times_us(kImageBytes), 0.5);
    timing.alone_p99_us = quantile(alone.times_us(kImageBytes), 0.99);
  }
  const ScratchRecording scratch(benchmark.folder, "graph");
  graph.record = scratch.stem();
  Latencies recorded;
  run_latency_graph(graph, recorded);
  timing.recorded_p50_us = quantile(recorded.times_us(kImageBytes), 0.5);
  timing.recorded_p99_us = quantile(recorded.times_us(kImageBytes), 0.99);
  timing.lost = timing.messages - messages_in(scratch.file());
  return timing;
}

/// Images at 5 Hz and odometry at 100 Hz, as a robot's recording has them.
std::uint64_t make_recording(const std::string& stem, double seconds) {
  recording::RecorderParameters parameters;
  parameters.compression = "lz4";
  parameters.min_free_mb = 0.0;
  recording::Recorder recorder(parameters, stem);
  const auto add = [&recorder](const char* name) {
    return recorder.add_topic(recording::describe_topic(
        name, msgs::topics::CameraImage::topic().type->ros_name, {msgs::reliable_stream_qos(100)},
        recording::SchemaStyle::kRos2msg));
  };
  const std::size_t images = add(kImages);
  const std::size_t odometry = add(kOdometry);
  std::vector<std::byte> image = image_payload(kImageBytes);
  std::vector<std::byte> small = image_payload(kOdometryBytes);
  std::uint64_t count = 0;
  const auto put = [&](std::size_t topic, std::vector<std::byte>& payload, Time time) {
    stamp_payload(payload, static_cast<std::uint32_t>(count), time);
    ++count;
    require(
        recorder.write(topic, time, time, std::make_shared<const std::vector<std::byte>>(payload)));
  };
  constexpr int kPerSecond = 100;
  constexpr int kPerImage = 20;
  for (int i = 0; i < static_cast<int>(seconds * kPerSecond); ++i) {
    const Time time = Time() + Duration::milliseconds(1000 + 10 * i);
    if (i % kPerImage == 0) put(images, image, time);
    put(odometry, small, time);
  }
  require(recorder.stop());
  return count;
}

/// When messages were sent, as their reader sees it, against the times at which they stand in the
/// file, as deviations from the median.
class TimingErrors {
 public:
  void add(const dds::RawMessage& message) {
    std::int64_t sec = 0;
    std::int64_t nsec = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      sec |= std::int64_t{std::to_integer<std::uint8_t>(message.payload.at(4 + i))} << (8 * i);
      nsec |= std::int64_t{std::to_integer<std::uint8_t>(message.payload.at(8 + i))} << (8 * i);
    }
    const Time recorded = Time::from_nanoseconds(sec * 1'000'000'000 + nsec);
    const std::lock_guard lock(mutex_);
    offsets_s_.push_back((message.source_time - recorded).to_seconds());
  }
  [[nodiscard]] std::vector<double> errors_s() const {
    const std::lock_guard lock(mutex_);
    const double median_s = quantile(offsets_s_, 0.5);
    std::vector<double> errors;
    for (const double offset_s : offsets_s_) errors.push_back(std::abs(offset_s - median_s));
    return errors;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<double> offsets_s_;
};

PlaybackTiming measure_playback(const RecordingBenchmark& benchmark) {
  const ScratchRecording scratch(benchmark.folder, "play");
  PlaybackTiming timing;
  timing.messages = make_recording(scratch.stem(), benchmark.play_s);
  auto player = recording::Player::open(std::vector{scratch.file()}, {});
  if (!player) throw std::runtime_error(player.error().message);
  dds::DdsTransport from(launch::transport_parameters(benchmark.transport, "bench_player"));
  dds::DdsTransport to(launch::transport_parameters(benchmark.transport, "bench_reader"));
  TimingErrors errors;
  const std::string type(msgs::topics::CameraImage::topic().type->dds_name);
  std::vector<std::unique_ptr<dds::RawReader>> readers;
  for (const char* topic : {kImages, kOdometry}) {
    readers.push_back(
        to.make_raw_reader(topic, type, msgs::reliable_stream_qos(100),
                           [&errors](dds::RawMessage message) { errors.add(message); }));
  }
  {
    recording::DdsPlayer played(from, std::move(*player),
                                {.wait_for_readers = Duration::seconds(5.0)});
    if (!played.wait(Duration::seconds(benchmark.play_s + 30.0))) {
      throw std::runtime_error("the playback does not end");
    }
    (void)from.flush(Duration::milliseconds(3000));
    timing.published_p99_ms = played.status().lateness_p99_s * 1e3;
  }
  const std::vector<double> seconds = errors.errors_s();
  timing.lost = timing.messages - std::min<std::uint64_t>(timing.messages, seconds.size());
  timing.p50_ms = quantile(seconds, 0.5) * 1e3;
  timing.p99_ms = quantile(seconds, 0.99) * 1e3;
  return timing;
}

}  // namespace

RecordingBenchmarkResult run_recording_benchmark(const RecordingBenchmark& benchmark) {
  RecordingBenchmarkResult result;
  auto writes = recording::benchmark_writing(benchmark.folder, benchmark.write);
  if (!writes) throw std::runtime_error(writes.error().message);
  result.writes = std::move(*writes);
  result.graph = measure_graph(benchmark);
  result.playback = measure_playback(benchmark);
  return result;
}

}  // namespace furrow::benchmarks
