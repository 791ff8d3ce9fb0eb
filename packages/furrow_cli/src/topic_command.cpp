#include <algorithm>
#include <chrono>
#include <csignal>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "commands.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/text.hpp"
#include "furrow_launch/signals.hpp"
#include "furrow_msgs/idl_schema.hpp"
#include "furrow_msgs/type_names.hpp"
#include "rate_meter.hpp"
#include "topic_subscription.hpp"
#include "transport_options.hpp"

namespace furrow::cli {
namespace {

struct TopicOptions {
  std::string topic;
  launch::TransportOptions transport;
  double wait_s = 3.0;
  std::int64_t count = 0;
  double window_s = 2.0;
};

Time steady_time() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return Time::from_nanoseconds(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

int list(const TopicOptions& options) {
  const auto parameters = launch::transport_parameters(options.transport, "furrow_topic");
  const dds::DdsTransport transport(parameters);
  // Endpoints come one after another: wait until nothing new has come for a while.
  constexpr Duration kQuiet = Duration::milliseconds(500);
  std::uint64_t version = 0;
  Time quiet_since = steady_time();
  (void)wait_for_discovery(
      transport, options.wait_s, [] { return false; },
      [&](const dds::DiscoverySnapshot& snapshot) {
        if (snapshot.version != version) {
          version = snapshot.version;
          quiet_since = steady_time();
        }
        return !snapshot.topics.empty() && steady_time() - quiet_since > kQuiet;
      });
  std::vector<std::vector<std::string>> rows = {{"topic", "type", "writers", "readers"}};
  for (const dds::TopicInfo& topic : transport.discovery().topics) {
    std::string types;
    for (const std::string& type : topic.type_names) {
      types += (types.empty() ? "" : ", ") + msgs::ros_type_name(type);
    }
    rows.push_back({topic.name, types, std::to_string(topic.writers.size()),
                    std::to_string(topic.readers.size())});
  }
  if (rows.size() == 1) {
    std::cerr << "furrow: no topics in domain " << parameters.domain_id << '\n';
    return 1;
  }
  std::cout << text_table(rows);
  return 0;
}

/// Reads the topic and calls `take` with each message and the DDS name of its type, until it
/// returns false, the count is reached or a signal comes.
int follow(const TopicOptions& options,
           const std::function<bool(const dds::RawMessage&, const std::string&)>& take) {
  const std::string name = topic_name(options.topic);
  launch::SignalPipe signals({SIGINT, SIGTERM});
  const auto parameters = launch::transport_parameters(options.transport, "furrow_topic");
  dds::DdsTransport transport(parameters);
  bool interrupted = false;
  const auto topic = wait_for_topic(transport, name, options.wait_s, [&] {
    return interrupted = interrupted || signals.take() != 0;
  });
  if (interrupted) return 0;
  if (!topic) {
    std::cerr << "furrow: nothing publishes '" << name << "' in domain " << parameters.domain_id
              << " (waited " << fixed(options.wait_s, 1) << " s)\n";
    return 1;
  }
  TopicSubscription subscription(transport, name, *topic);
  const launch::SignalWatch watch(signals, [&](int) { subscription.stop(); });
  for (std::int64_t taken = 0; options.count == 0 || taken < options.count; ++taken) {
    const auto message = subscription.next(options.wait_s);
    if (subscription.stopped()) break;
    if (!message) {
      std::cerr << "furrow: no message within " << fixed(options.wait_s, 1) << " s\n";
      return 1;
    }
    if (!take(*message, topic->dds_type)) break;
  }
  return 0;
}

/// Prints messages of one type as text.
class MessagePrinter {
 public:
  explicit MessagePrinter(const std::string& dds_type) : dds_type_(dds_type) {
    const auto types = msgs::all_message_types();
    const auto type = std::ranges::find_if(
        types, [&](const msgs::MessageType* known) { return known->dds_name == dds_type; });
    if (type == std::ranges::end(types)) return;
    auto parsed = msgs::IdlSchema::parse((*type)->idl);
    if (!parsed.ok()) throw std::runtime_error(parsed.error().message);
    schema_ = std::move(parsed).value();
    struct_name_ = (*type)->ros_name;
    for (auto at = struct_name_.find('/'); at != std::string::npos; at = struct_name_.find('/')) {
      struct_name_.replace(at, 1, "::");
    }
  }

  void print(const dds::RawMessage& message) const {
    if (!schema_) {
      std::cout << msgs::ros_type_name(dds_type_) << ", " << message.payload.size()
                << " bytes\n---\n"
                << std::flush;
      return;
    }
    const auto text = msgs::print_cdr(*schema_, struct_name_, message.payload);
    if (!text.ok()) throw std::runtime_error(text.error().message);
    std::cout << *text << "---\n" << std::flush;
  }

 private:
  std::string dds_type_;
  std::optional<msgs::IdlSchema> schema_;  // nothing: a type that Furrow does not know
  std::string struct_name_;
};

int echo(const TopicOptions& options) {
  std::optional<MessagePrinter> printer;
  return follow(options, [&](const dds::RawMessage& message, const std::string& dds_type) {
    if (!printer) printer.emplace(dds_type);
    printer->print(message);
    return true;
  });
}

enum class Measure { kRate, kBandwidth };

std::string text_of(const std::optional<RateMeter::Rate>& rate, Measure measure) {
  if (!rate) return "no rate: one message in the window";
  if (measure == Measure::kBandwidth) {
    return fixed(rate->bytes_per_s / 1e6, 3) + " MB/s, mean message " +
           fixed(rate->mean_bytes / 1e3, 1) + " kB";
  }
  return fixed(rate->hz, 2) + " Hz over " + fixed(rate->span_s, 1) + " s";
}

/// Prints once a second; with --count after each message.
int measure(const TopicOptions& options, Measure what) {
  RateMeter meter(Duration::seconds(options.window_s));
  Time last_print = steady_time();
  return follow(options, [&](const dds::RawMessage& message, const std::string&) {
    const Time now = steady_time();
    meter.add(now, message.payload.size());
    if (const auto period = meter.period_beyond_window()) {
      throw ConfigError("--window: " + fixed(options.window_s, 3) +
                        " s never holds two messages of '" + options.topic + "': its period is " +
                        fixed(period->to_seconds(), 3) + " s; give a longer window");
    }
    const bool due = options.count > 0 || now - last_print >= Duration::seconds(1.0);
    const auto rate = meter.rate();
    if (!due || (options.count == 0 && !rate)) return true;
    last_print = now;
    std::cout << text_of(rate, what) << '\n' << std::flush;
    return true;
  });
}

void add_topic_options(Command command, TopicOptions& options) {
  command.option("topic", options.topic, "name, such as planner/plan or /planner/plan").required();
  command.option("--wait", options.wait_s, "longest wait for a writer or a message, s")
      .range(0.1, 3600.0);
  command.option("--count", options.count, "messages to take; 0: until stopped").at_least(0);
  add_transport_options(command, options.transport);
}

void add_measure_command(Command group, const std::string& name, const std::string& description,
                         Measure what) {
  auto options = std::make_shared<TopicOptions>();
  Command command = group.subcommand(name, description);
  add_topic_options(command, *options);
  command.option("--window", options->window_s, "span of time to measure over, s")
      .range(0.001, 3600.0);
  command.on_run([options, what] { return measure(*options, what); });
}

}  // namespace

void add_topic_commands(Command root) {
  Command group = root.group("topic", "Looks at the topics of a running system.");
  auto list_options = std::make_shared<TopicOptions>();
  Command list_command = group.subcommand("list", "Lists the topics with their types.");
  list_command.option("--wait", list_options->wait_s, "longest wait for writers, s")
      .range(0.1, 3600.0);
  add_transport_options(list_command, list_options->transport);
  list_command.on_run([list_options] { return list(*list_options); });

  auto echo_options = std::make_shared<TopicOptions>();
  Command echo_command = group.subcommand("echo", "Prints the messages of a topic.");
  add_topic_options(echo_command, *echo_options);
  echo_command.on_run([echo_options] { return echo(*echo_options); });

  add_measure_command(group, "hz", "Measures the rate of a topic.", Measure::kRate);
  add_measure_command(group, "bw", "Measures the bandwidth of a topic.", Measure::kBandwidth);
}

}  // namespace furrow::cli
