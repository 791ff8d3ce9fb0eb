#include "furrow_benchmarks/graph_benchmark.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "furrow_benchmarks/latency_graph.hpp"
#include "furrow_core/file.hpp"
#include "furrow_core/scratch_folder.hpp"
#include "furrow_core/statistics.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_launch/signals.hpp"
#include "furrow_msgs/builtin_interfaces.h"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_recording/mcap_reader.hpp"
#include "furrow_supervisor/child_process.hpp"

namespace furrow::benchmarks {
namespace {

using std::chrono::milliseconds;
constexpr char kRawTopic[] = "bench/raw";
/// A reader finds its writer a little later than the writer finds it; what is sent between is lost.
constexpr milliseconds kSettle{1500};

/// All sizes at one rate: after a longer pause a processor takes longer to wake.
LatencyLoad load_of(const GraphBenchmark& benchmark, int rounds = 1) {
  constexpr int kMessages = 500;
  const int messages = std::max(60, static_cast<int>(benchmark.scale * kMessages));
  return {.bytes = benchmark.bytes,
          .period = Duration::milliseconds(20),
          .messages = std::max(20, messages / rounds)};
}

LatencyGraph graph_of(const GraphBenchmark& benchmark, const LatencyLoad& load) {
  return {.load = load, .sink_time = Duration::seconds(benchmark.reader_us * 1e-6)};
}

/// What one path measured, by the size of the messages.
struct Measured {
  std::vector<double> times_us;
  std::size_t sent = 0;
  std::size_t received = 0;
};
using BySize = std::map<std::size_t, Measured>;

void add(BySize& all, const LatencyLoad& load, const Latencies& latencies) {
  for (const std::size_t bytes : load.bytes) {
    const std::vector<double> times_us = latencies.times_us(bytes);
    Measured& measured = all[bytes];
    measured.times_us.insert(measured.times_us.end(), times_us.begin(), times_us.end());
    measured.sent += static_cast<std::size_t>(load.messages);
    measured.received += latencies.received(bytes);
  }
}

void add_rows(const std::string& path, const BySize& all, GraphBenchmarkResult& result) {
  for (const auto& [bytes, measured] : all) {
    result.rows.push_back({.path = path,
                           .bytes = bytes,
                           .p50_us = quantile(measured.times_us, 0.5),
                           .p99_us = quantile(measured.times_us, 0.99),
                           .messages = measured.sent,
                           .lost = measured.sent - std::min(measured.sent, measured.received)});
  }
}

dds::DdsParameters dds_parameters_of(const GraphBenchmark& benchmark, const std::string& name) {
  dds::DdsParameters parameters = launch::transport_parameters(benchmark.transport, name);
  // Room for the largest on its way more than once.
  parameters.shm_segment_mb = std::max<std::int64_t>(parameters.shm_segment_mb, 64);
  return parameters;
}

std::int64_t domain_of(const GraphBenchmark& benchmark) {
  return dds_parameters_of(benchmark, "bench_graph").domain_id;
}

template <class Holds>
void wait_until(Holds holds, const std::string& what,
                std::chrono::seconds patience = std::chrono::seconds(15)) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) throw std::runtime_error(what);
    std::this_thread::sleep_for(milliseconds(10));
  }
}

std::size_t peers(const dds::DdsTransport& transport, const std::string& topic) {
  std::size_t count = 0;
  for (const dds::EndpointStatus& endpoint : transport.status()) {
    if (endpoint.topic == topic && endpoint.writer) count += endpoint.peers > 0 ? 1 : 0;
  }
  return count;
}

std::string own_program() {
  return std::filesystem::read_symlink("/proc/self/exe").string();
}

supervisor::ChildProcess start(std::vector<std::string> command) {
  // What it prints is not ours to print.
  command.insert(command.begin(),
                 {"/bin/sh", "-c", "exec \"$0\" \"$@\" </dev/null >/dev/null 2>&1"});
  auto child = supervisor::ChildProcess::start(command);
  if (!child) throw std::runtime_error(child.error().message);
  return std::move(child).value();
}

void wait_for_end(supervisor::ChildProcess& child, std::chrono::seconds patience,
                  const std::string& what) {
  int status = 0;
  wait_until([&] { return child.ended(status); }, what + " does not end", patience);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error(what + " failed");
}

std::vector<std::string> transport_arguments(const GraphBenchmark& benchmark) {
  std::vector<std::string> arguments = {"--dds=shm_segment_mb=64"};
  for (const std::string& setting : benchmark.transport.settings) {
    arguments.push_back("--dds=" + setting);
  }
  return arguments;
}

supervisor::ChildProcess start_tool(const GraphBenchmark& benchmark,
                                    std::vector<std::string> command) {
  command.insert(command.begin(), own_program());
  for (std::string& argument : transport_arguments(benchmark))
    command.push_back(std::move(argument));
  command.push_back("--domain=" + std::to_string(domain_of(benchmark)));
  return start(std::move(command));
}

void measure_alone(const GraphBenchmark& benchmark, const LatencyLoad& load, BySize& measured,
                   GraphBenchmarkResult& result) {
  Latencies latencies;
  run_latency_graph(graph_of(benchmark, load), latencies);
  result.payload_copied = result.payload_copied || !latencies.never_copied();
  add(measured, load, latencies);
}

/// While a recorder of another process reads everything.
void measure_observed(const GraphBenchmark& benchmark, const LatencyLoad& load,
                      const std::string& file, BySize& measured) {
  dds::DdsTransport transport(dds_parameters_of(benchmark, "bench_graph"));
  supervisor::ChildProcess recorder = start_tool(
      benchmark,
      {"record", "camera/image", "--compression=lz4", "--min-free-mb=0", "--out=" + file});
  Latencies latencies;
  LatencyGraph graph = graph_of(benchmark, load);
  graph.transport = &transport;
  run_latency_graph(graph, latencies, [&transport](graph::Runtime&) {
    wait_until([&] { return peers(transport, "camera/image") == 1; }, "the recorder does not come");
    std::this_thread::sleep_for(kSettle);
  });
  recorder.send(SIGTERM);
  wait_for_end(recorder, std::chrono::seconds(20), "furrow record");
  std::error_code ignored;
  std::filesystem::remove(file + "_0.mcap", ignored);
  add(measured, load, latencies);
}

/// In turns, because the speed of a machine that others use too changes within minutes.
void measure_in_process(const GraphBenchmark& benchmark, const ScratchFolder& scratch,
                        GraphBenchmarkResult& result) {
  constexpr int kRounds = 5;
  const LatencyLoad load = load_of(benchmark, kRounds);
  BySize alone;
  BySize observed;
  for (int i = 0; i < kRounds; ++i) {
    measure_alone(benchmark, load, alone, result);
    measure_observed(benchmark, load, (scratch.path() / "observed").string(), observed);
  }
  add_rows("in_process", alone, result);
  add_rows("in_process_observed", observed, result);
}

/// Fast DDS from one participant to another of the same process, between which it uses no
/// transport. The reader makes an image of the bytes, as Furrow's readers get one, or does not.
void measure_fastdds_in_process(const GraphBenchmark& benchmark, bool as_image,
                                GraphBenchmarkResult& result) {
  const msgs::Topic& topic = msgs::topics::CameraImage::topic();
  const msgs::MessageType& type = *topic.type;
  BySize measured;
  for (const std::size_t bytes : benchmark.bytes) {
    LatencyLoad load = load_of(benchmark);
    load.bytes = {bytes};
    dds::DdsTransport from(dds_parameters_of(benchmark, "bench_graph"));
    dds::DdsTransport to(dds_parameters_of(benchmark, "bench_graph_reader"));
    std::vector<std::byte> payload = image_payload(bytes);
    const std::shared_ptr<void> image = type.create();
    if (!type.deserialize(payload, image.get()).ok()) throw std::runtime_error("malformed image");
    Latencies latencies;
    const auto reader = to.make_raw_reader(
        kRawTopic, std::string(type.dds_name), topic.qos, [&](dds::RawMessage message) {
          if (as_image && !type.deserialize(message.payload, type.create().get()).ok()) return;
          add_payload(latencies, message.payload);
        });
    const auto writer = from.make_raw_writer(kRawTopic, std::string(type.dds_name), topic.qos);
    wait_until([&] { return writer->has_readers() && reader->writers() == 1; },
               "the reader does not come");
    std::this_thread::sleep_for(kSettle);
    const auto begin = std::chrono::steady_clock::now();
    const auto period = std::chrono::nanoseconds(load.period.count_ns());
    for (int i = 0; i < load.messages; ++i) {
      std::this_thread::sleep_until(begin + i * period);
      const Time stamp = steady_now();
      if (as_image && !type.serialize(image.get(), payload)) throw std::runtime_error("no room");
      stamp_payload(payload, static_cast<std::uint32_t>(i), stamp);
      (void)writer->write_now(payload);
    }
    (void)from.flush(Duration::milliseconds(2000));
    std::this_thread::sleep_for(milliseconds(100));
    add(measured, load, latencies);
  }
  add_rows(as_image ? "fastdds_in_process" : "fastdds_in_process_bytes", measured, result);
}

/// Furrow and plain Fast DDS take turns, so that both have the same conditions.
void measure_two_processes(const GraphBenchmark& benchmark, const ScratchFolder& scratch,
                           GraphBenchmarkResult& result) {
  const msgs::Topic& topic = msgs::topics::CameraImage::topic();
  const std::string file = (scratch.path() / "peer.json").string();
  const LatencyLoad load = load_of(benchmark);
  {
    supervisor::ChildProcess peer =
        start_tool(benchmark, {"bench", "graph-peer", "--json=" + file,
                               "--reader-us=" + std::to_string(benchmark.reader_us)});
    dds::DdsTransport transport(dds_parameters_of(benchmark, "bench_graph"));
    const auto raw =
        transport.make_raw_writer(kRawTopic, std::string(topic.type->dds_name), topic.qos);
    std::vector<std::vector<std::byte>> payloads;
    for (const std::size_t bytes : load.bytes) payloads.push_back(image_payload(bytes));
    Latencies none;
    LatencyGraph graph;
    graph.sink = false;
    graph.load = load;
    graph.transport = &transport;
    graph.between = [&](std::uint32_t number) {
      std::vector<std::byte>& payload = payloads[number % payloads.size()];
      stamp_payload(payload, number, steady_now());
      (void)raw->write_now(payload);
    };
    run_latency_graph(graph, none, [&](graph::Runtime&) {
      wait_until([&] { return raw->has_readers() && peers(transport, "camera/image") == 1; },
                 "the other process does not come");
      std::this_thread::sleep_for(kSettle);
    });
    (void)transport.flush(Duration::milliseconds(2000));
    std::this_thread::sleep_for(milliseconds(300));
    peer.send(SIGTERM);
    wait_for_end(peer, std::chrono::seconds(20), "the other process");
  }
  const auto text = read_file(file);
  if (!text) throw std::runtime_error(text.error().message);
  const auto json = nlohmann::json::parse(*text);
  for (const char* path : {"two_processes", "fastdds_two_processes"}) {
    BySize measured;
    for (const std::size_t bytes : load.bytes) {
      const auto& of_size = json.at(path).at(std::to_string(bytes));
      measured[bytes] = {.times_us = of_size.at("us").get<std::vector<double>>(),
                         .sent = static_cast<std::size_t>(load.messages),
                         .received = of_size.at("received").get<std::size_t>()};
    }
    add_rows(path, measured, result);
  }
}

/// From the stamp of a frame to its plan at a reader that lives as the axis drivers do: in the same
/// process, or in one of its own.
GraphBenchmarkRow read_plans(const std::string& path, const std::string& file) {
  auto source = mcap::open_file(file);
  if (!source) throw std::runtime_error(source.error().message);
  const auto reader = mcap::Reader::open(std::move(*source));
  if (!reader) throw std::runtime_error(reader.error().message);
  const msgs::MessageType& type = *msgs::topics::Plan::topic().type;
  std::vector<double> times_us;
  mcap::MessageCursor cursor = reader->messages();
  while (true) {
    const auto next = cursor.next();
    if (!next) throw std::runtime_error(next.error().message);
    if (!next->has_value()) break;
    furrow_msgs::msg::Plan plan;
    if (!type.deserialize((*next)->data, &plan).ok()) continue;
    const Time stamp = graph::from_msg(plan.header().stamp());
    times_us.push_back(((*next)->log_time - stamp).to_seconds() * 1e6);
  }
  return {.path = path,
          .p50_us = quantile(times_us, 0.5),
          .p99_us = quantile(times_us, 0.99),
          .messages = times_us.size()};
}

void measure_end_to_end(const GraphBenchmark& benchmark, const ScratchFolder& scratch,
                        GraphBenchmarkResult& result) {
  for (const std::string name : {"composed", "distributed"}) {
    const std::string stem = (scratch.path() / name).string();
    std::vector<std::string> command = {own_program(),
                                        name == "composed" ? "run" : "up",
                                        "--deploy=" + name,
                                        "--clock=real",
                                        "--length=" + std::to_string(benchmark.length_m),
                                        "--seed=" + std::to_string(benchmark.seed),
                                        "--out=" + (scratch.path() / (name + "_report")).string(),
                                        "--record=" + stem,
                                        "--set=recorder.include=[planner/plan]",
                                        "--set=recorder.min_free_mb=0"};
    for (std::string& argument : transport_arguments(benchmark))
      command.push_back(std::move(argument));
    command.push_back("--domain=" + std::to_string(domain_of(benchmark)));
    supervisor::ChildProcess run = start(std::move(command));
    const auto patience = std::chrono::seconds(60 + static_cast<int>(4.0 * benchmark.length_m));
    wait_for_end(run, patience, "furrow run " + name);
    result.rows.push_back(read_plans("end_to_end_" + name, stem + "_0.mcap"));
  }
}

nlohmann::ordered_json to_json(const Latencies& latencies) {
  nlohmann::ordered_json json;
  for (const std::size_t bytes : GraphBenchmark().bytes) {
    json[std::to_string(bytes)] = {{"us", latencies.times_us(bytes)},
                                   {"received", latencies.received(bytes)}};
  }
  return json;
}

}  // namespace

GraphBenchmarkResult run_graph_benchmark(const GraphBenchmark& benchmark) {
  const ScratchFolder scratch;
  GraphBenchmarkResult result;
  measure_in_process(benchmark, scratch, result);
  measure_fastdds_in_process(benchmark, true, result);
  measure_fastdds_in_process(benchmark, false, result);
  measure_two_processes(benchmark, scratch, result);
  if (benchmark.length_m > 0.0) measure_end_to_end(benchmark, scratch, result);
  return result;
}

void run_graph_benchmark_peer(const GraphBenchmark& benchmark, const std::string& file) {
  launch::SignalPipe signals({SIGINT, SIGTERM});
  Latencies furrow;
  Latencies raw;
  dds::DdsTransport transport(dds_parameters_of(benchmark, "bench_graph_peer"));
  const msgs::Topic& topic = msgs::topics::CameraImage::topic();
  const auto reader = transport.make_raw_reader(
      kRawTopic, std::string(topic.type->dds_name), topic.qos,
      [&raw](dds::RawMessage message) { add_payload(raw, message.payload); });
  LatencyGraph graph = graph_of(benchmark, {});
  graph.source = false;
  graph.transport = &transport;
  graph.stop_signals = &signals;
  run_latency_graph(graph, furrow);
  const nlohmann::ordered_json json = {{"two_processes", to_json(furrow)},
                                       {"fastdds_two_processes", to_json(raw)}};
  if (const Status written = write_file_atomically(file, json.dump()); !written) {
    throw std::runtime_error(written.error().message);
  }
}

}  // namespace furrow::benchmarks
