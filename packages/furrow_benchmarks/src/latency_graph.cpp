#include "furrow_benchmarks/latency_graph.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "furrow_graph/stamp.hpp"
#include "furrow_launch/installation.hpp"
#include "furrow_msgs/builtin_interfaces.h"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/sensor_msgs.h"
#include "furrow_msgs/topics.hpp"

namespace furrow::benchmarks {
namespace {

namespace topics = msgs::topics;
using sensor_msgs::msg::Image;
constexpr std::size_t kPool = 8;  // of each size
constexpr std::uint32_t kWarmUp = 10;
// In the CDR form of an image with an empty frame_id: behind the encapsulation header come sec,
// nanosec, the length and end of frame_id (8 bytes), height.
constexpr std::size_t kSecAt = 4;
constexpr std::size_t kNanosecAt = 8;
constexpr std::size_t kHeightAt = 20;

struct Shared {
  LatencyGraph graph;
  Latencies& latencies;
  std::vector<const std::uint8_t*> addresses;  ///< of the pixels, by number
};

std::shared_ptr<Image> make_image(std::size_t bytes) {
  auto image = std::make_shared<Image>();
  image->encoding("mono8");
  image->step(static_cast<std::uint32_t>(bytes));
  image->width(static_cast<std::uint32_t>(bytes));
  image->data().resize(bytes, 1);
  return image;
}

/// Publishes images from a pool, none of which changes while a reader holds it.
class Source final : public graph::Component {
 public:
  Source(graph::Context& context, std::shared_ptr<Shared> shared)
      : context_(context), shared_(std::move(shared)), out_(context.output<topics::CameraImage>()) {
    const LatencyLoad& load = shared_->graph.load;
    for (std::uint32_t i = 0; i < kPool * load.bytes.size(); ++i) {
      pool_.push_back(make_image(load.bytes_of(i)));
    }
    const Duration half = Duration::nanoseconds(load.period.count_ns() / 2);
    context.every(half, [this](Time) { step(); });
  }

 private:
  void step() {
    const LatencyGraph& graph = shared_->graph;
    if (turn_++ % 2 == 1) {
      if (graph.between) graph.between(number_ - 1);
      return;
    }
    if (number_ == graph.load.total()) {
      context_.request_stop("finished");
      return;
    }
    auto& image = pool_[number_ % pool_.size()];
    if (image.use_count() > 1) image = make_image(graph.load.bytes_of(number_));
    image->height(number_);
    shared_->addresses[number_] = image->data().data();
    ++number_;
    image->header().stamp(graph::to_msg(steady_now()));
    out_.publish(std::shared_ptr<const Image>(image));
  }

  graph::Context& context_;
  std::shared_ptr<Shared> shared_;
  graph::Output<topics::CameraImage> out_;
  std::vector<std::shared_ptr<Image>> pool_;  ///< of each size in turn, as they are published
  std::uint32_t number_ = 0;
  std::uint64_t turn_ = 0;
};

graph::ComponentClass source_class(const std::shared_ptr<Shared>& shared) {
  graph::ComponentClass type;
  type.name = "latency_source";
  type.description.doc("Publishes images.").output<topics::CameraImage>();
  type.make = [shared](graph::Context& context) {
    return std::make_unique<Source>(context, shared);
  };
  return type;
}

void compute_for(Duration duration) {
  const Time end = steady_now() + duration;
  while (steady_now() < end) {
  }
}

graph::ComponentClass sink_class(const std::shared_ptr<Shared>& shared) {
  graph::ComponentClass type;
  type.name = "latency_sink";
  type.description.doc("Measures how old they are.")
      .input<topics::CameraImage>(graph::Need::kOptional);
  type.make = [shared](graph::Context& context) {
    context.input<topics::CameraImage>([shared](const auto& image) {
      const std::uint32_t number = image->height();
      shared->latencies.add(number, graph::from_msg(image->header().stamp()), image->data().size());
      if (shared->graph.source) {
        shared->latencies.note_address(image->data().data() == shared->addresses.at(number));
      }
      compute_for(shared->graph.sink_time);
    });
    return std::make_unique<graph::Component>();
  };
  return type;
}

void add(graph::GraphSpec& spec, const std::string& name,
         std::vector<GivenParameter> parameters = {}) {
  graph::ComponentSpec component;
  component.name = name;
  component.group = name;
  component.class_name = name;
  component.parameters = std::move(parameters);
  spec.components.push_back(std::move(component));
}

void put(std::vector<std::byte>& payload, std::size_t at, std::uint32_t value) {
  std::memcpy(payload.data() + at, &value, sizeof value);
}
std::uint32_t get(const std::vector<std::byte>& payload, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, payload.data() + at, sizeof value);
  return value;
}

}  // namespace

void Latencies::add(std::uint32_t number, Time stamp, std::size_t bytes) {
  const double us = (steady_now() - stamp).to_seconds() * 1e6;
  const std::lock_guard lock(mutex_);
  entries_.push_back({number, bytes, us});
}

void Latencies::note_address(bool same) {
  const std::lock_guard lock(mutex_);
  same_address_ = same_address_ && same;
}

std::vector<double> Latencies::times_us(std::size_t bytes) const {
  const std::lock_guard lock(mutex_);
  std::vector<double> times;
  for (const Entry& entry : entries_) {
    if (entry.bytes == bytes && entry.number >= kWarmUp) times.push_back(entry.us);
  }
  return times;
}

std::size_t Latencies::received(std::size_t bytes) const {
  const std::lock_guard lock(mutex_);
  std::set<std::uint32_t> numbers;
  for (const Entry& entry : entries_) {
    if (entry.bytes == bytes) numbers.insert(entry.number);
  }
  return numbers.size();
}

bool Latencies::never_copied() const {
  const std::lock_guard lock(mutex_);
  return same_address_ && !entries_.empty();
}

Time steady_now() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return Time::from_nanoseconds(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

std::vector<std::byte> image_payload(std::size_t bytes) {
  const auto image = make_image(bytes);
  const msgs::MessageType& type = *topics::CameraImage::topic().type;
  std::vector<std::byte> payload(type.serialized_size(image.get()));
  const auto size = type.serialize(image.get(), payload);
  if (!size) throw std::runtime_error(size.error().message);
  payload.resize(*size);
  return payload;
}

void stamp_payload(std::vector<std::byte>& payload, std::uint32_t number, Time stamp) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  put(payload, kSecAt, static_cast<std::uint32_t>(stamp.count_ns() / kSecond_ns));
  put(payload, kNanosecAt, static_cast<std::uint32_t>(stamp.count_ns() % kSecond_ns));
  put(payload, kHeightAt, number);
}

void add_payload(Latencies& latencies, const std::vector<std::byte>& payload) {
  if (payload.size() < kHeightAt + 4) return;
  const Time stamp = Time() + Duration::seconds(get(payload, kSecAt)) +
                     Duration::nanoseconds(get(payload, kNanosecAt));
  // The pixels are what an image without any has not; three bytes of padding may follow.
  static const std::size_t kEmpty = image_payload(0).size();
  latencies.add(get(payload, kHeightAt), stamp, payload.size() - kEmpty);
}

void run_latency_graph(const LatencyGraph& graph, Latencies& latencies,
                       const std::function<void(graph::Runtime&)>& started) {
  auto shared = std::make_shared<Shared>(Shared{.graph = graph, .latencies = latencies});
  shared->addresses.resize(graph.load.total());
  graph::Registry registry = launch::make_registry();
  registry.add(source_class(shared));
  registry.add(sink_class(shared));
  graph::GraphSpec spec;
  spec.name = "latency";
  if (graph.source) add(spec, "latency_source");
  if (graph.sink) add(spec, "latency_sink");
  if (!graph.record.empty()) {
    const SourceLocation where;
    add(spec, "recorder",
        {{"file", graph.record, where},
         {"include", std::vector<std::string>{"camera/image"}, where},
         {"compression", std::string("none"), where}});
  }
  graph::Runtime runtime(spec, registry, {.transport = graph.transport});
  std::optional<launch::SignalWatch> watch;
  if (graph.stop_signals != nullptr) {
    watch.emplace(*graph.stop_signals, [&runtime](int) { runtime.request_stop("stopped"); });
  }
  if (started) started(runtime);
  const graph::RunResult result = runtime.run();
  if (result.failed) throw std::runtime_error(result.reason);
}

}  // namespace furrow::benchmarks
