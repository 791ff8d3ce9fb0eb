#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <iostream>
#include <mutex>
#include <optional>
#include <thread>

#include "command.hpp"
#include "console.hpp"
#include "furrow_dds/dds_transport.hpp"
#include "furrow_msgs/idl_schema.hpp"
#include "furrow_msgs/topics.hpp"
#include "furrow_msgs/type_names.hpp"
#include "signals.hpp"

namespace furrow::cli {
namespace {

using Clock = std::chrono::steady_clock;

struct TopicOptions {
  std::string topic;
  std::int64_t domain_id = 0;
  double wait_s = 3.0;
  std::int64_t count = 0;
  double window_s = 2.0;
};

dds::DdsTransport join(const TopicOptions& options) {
  dds::DdsParameters parameters;
  parameters.domain_id = options.domain_id;
  parameters.process_name = "furrow_topic";
  return dds::DdsTransport(parameters);
}

/// Polls the discovery until `found` holds; discovery has no end that one could wait for.
template <class Found>
bool wait_for(const dds::DdsTransport& transport, double seconds, Found found) {
  const auto deadline = Clock::now() + std::chrono::duration<double>(seconds);
  while (!found(transport.discovery())) {
    if (Clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

const dds::TopicInfo* find_topic(const dds::DiscoverySnapshot& snapshot, const std::string& name) {
  const auto it = std::ranges::find(snapshot.topics, name, &dds::TopicInfo::name);
  return it == snapshot.topics.end() || it->writers.empty() ? nullptr : &*it;
}

int list(const TopicOptions& options) {
  const dds::DdsTransport transport = join(options);
  // Endpoints come one after another: wait until nothing new has come for a while.
  std::uint64_t version = 0;
  auto quiet_since = Clock::now();
  wait_for(transport, options.wait_s, [&](const dds::DiscoverySnapshot& snapshot) {
    if (snapshot.version != version) {
      version = snapshot.version;
      quiet_since = Clock::now();
    }
    return !snapshot.topics.empty() && Clock::now() - quiet_since > std::chrono::milliseconds(500);
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
    std::cerr << "furrow: no topics in domain " << options.domain_id << '\n';
    return 1;
  }
  std::cout << text_table(rows);
  return 0;
}

/// Messages of one topic, handed from the transport's thread to the caller's.
class Subscription {
 public:
  /// Waits for a writer of the topic; nothing when none comes.
  static std::optional<std::string> wait_for_type(const dds::DdsTransport& transport,
                                                  const TopicOptions& options, msgs::Qos& qos) {
    std::optional<std::string> type;
    wait_for(transport, options.wait_s, [&](const dds::DiscoverySnapshot& snapshot) {
      const dds::TopicInfo* topic = find_topic(snapshot, options.topic);
      if (topic == nullptr) return false;
      type = topic->type_names.front();
      qos = topic->writers.front().qos;
      return true;
    });
    qos.depth = 10;
    qos.deadline = Duration();
    qos.liveliness_lease = Duration();
    return type;
  }

  Subscription(dds::DdsTransport& transport, const std::string& topic, const std::string& type,
               const msgs::Qos& qos)
      : reader_(transport.make_raw_reader(
            topic, type, qos, [this](dds::RawMessage message) { push(std::move(message)); })) {}

  /// The next message; nothing when it does not come in time or stop() was called.
  std::optional<dds::RawMessage> next(double timeout_s) {
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, std::chrono::duration<double>(timeout_s),
                   [this] { return stopped_ || !messages_.empty(); });
    if (stopped_ || messages_.empty()) return std::nullopt;
    dds::RawMessage message = std::move(messages_.front());
    messages_.pop_front();
    return message;
  }
  void stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    wake_.notify_all();
  }
  [[nodiscard]] bool stopped() {
    const std::lock_guard lock(mutex_);
    return stopped_;
  }

 private:
  static constexpr std::size_t kMaxWaiting = 1000;

  void push(dds::RawMessage message) {
    const std::lock_guard lock(mutex_);
    if (messages_.size() == kMaxWaiting) messages_.pop_front();
    messages_.push_back(std::move(message));
    wake_.notify_one();
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<dds::RawMessage> messages_;
  bool stopped_ = false;
  std::unique_ptr<dds::RawReader> reader_;  // last: it calls push()
};

const msgs::MessageType* known_type(const std::string& dds_name) {
  for (const msgs::MessageType* type : msgs::all_message_types()) {
    if (type->dds_name == dds_name) return type;
  }
  return nullptr;
}

std::string scoped_name(const msgs::MessageType& type) {
  std::string name(type.ros_name);
  for (auto at = name.find('/'); at != std::string::npos; at = name.find('/')) {
    name.replace(at, 1, "::");
  }
  return name;
}

int print_message(const dds::RawMessage& message, const msgs::IdlSchema& schema,
                  const std::string& struct_name) {
  const auto text = msgs::print_cdr(schema, struct_name, message.payload);
  if (!text.ok()) {
    std::cerr << "furrow: " << text.error().message << '\n';
    return 1;
  }
  std::cout << *text << "---\n" << std::flush;
  return 0;
}

/// Reads the topic and calls `take` with each message until it returns false, the count is reached
/// or a signal comes.
template <class Take>
int follow(const TopicOptions& options, Take take) {
  std::atomic<Subscription*> running = nullptr;
  std::atomic<bool> interrupted = false;
  SignalWatch signals([&] {
    interrupted = true;
    if (Subscription* subscription = running) subscription->stop();
  });
  dds::DdsTransport transport = join(options);
  msgs::Qos qos;
  const auto type = Subscription::wait_for_type(transport, options, qos);
  if (!type) {
    std::cerr << "furrow: nobody publishes '" << options.topic << "' in domain "
              << options.domain_id << '\n';
    return 1;
  }
  Subscription subscription(transport, options.topic, *type, qos);
  running = &subscription;
  std::int64_t taken = 0;
  while (!interrupted && !subscription.stopped()) {
    const auto message = subscription.next(options.wait_s);
    if (!message) {
      if (interrupted) break;
      std::cerr << "furrow: no message within " << number(options.wait_s, 1) << " s\n";
      running = nullptr;
      return 1;
    }
    if (!take(*message, *type)) break;
    if (options.count > 0 && ++taken == options.count) break;
  }
  running = nullptr;
  return 0;
}

int echo(const TopicOptions& options) {
  int result = 0;
  std::optional<msgs::IdlSchema> schema;
  std::string struct_name;
  const int followed =
      follow(options, [&](const dds::RawMessage& message, const std::string& name) {
        if (!schema) {
          const msgs::MessageType* type = known_type(name);
          if (type == nullptr) {
            std::cout << msgs::ros_type_name(name) << ", " << message.payload.size()
                      << " bytes\n---\n";
            return true;
          }
          auto parsed = msgs::IdlSchema::parse(type->idl);
          if (!parsed.ok()) throw std::runtime_error(parsed.error().message);
          schema = std::move(parsed).value();
          struct_name = scoped_name(*type);
        }
        result = print_message(message, *schema, struct_name);
        return result == 0;
      });
  return std::max(result, followed);
}

/// Rate and bandwidth over a sliding window.
int measure(const TopicOptions& options, bool bandwidth) {
  std::deque<std::pair<Clock::time_point, std::size_t>> window;
  auto last_print = Clock::now();
  return follow(options, [&](const dds::RawMessage& message, const std::string&) {
    const auto now = Clock::now();
    window.emplace_back(now, message.payload.size());
    while (now - window.front().first > std::chrono::duration<double>(options.window_s)) {
      window.pop_front();
    }
    const bool last = options.count > 0;
    if ((!last && now - last_print < std::chrono::seconds(1)) || window.size() < 2) return true;
    last_print = now;
    const double span_s = std::chrono::duration<double>(now - window.front().first).count();
    double bytes = 0.0;
    for (std::size_t i = 1; i < window.size(); ++i) bytes += static_cast<double>(window[i].second);
    if (bandwidth) {
      std::cout << number(bytes / span_s / 1e6, 3) << " MB/s, mean message "
                << number(bytes / static_cast<double>(window.size() - 1) / 1e3, 1) << " kB\n";
    } else {
      std::cout << number(static_cast<double>(window.size() - 1) / span_s, 2) << " Hz over "
                << number(span_s, 1) << " s\n";
    }
    std::cout << std::flush;
    return true;
  });
}

void add_topic_options(CLI::App* command, TopicOptions& options, bool named) {
  if (named) command->add_option("topic", options.topic, "name, e.g. planner/plan")->required();
  command->add_option("--domain", options.domain_id, "DDS domain")
      ->check(CLI::Range(0, 232))
      ->capture_default_str();
  command->add_option("--wait", options.wait_s, "seconds to wait for writers and messages")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  if (named) command->add_option("--count", options.count, "messages to take; 0: until stopped");
}

}  // namespace

void add_topic_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("topic", "Looks at the topics of a running system.");
  command->require_subcommand(1);
  auto options = std::make_shared<TopicOptions>();
  CLI::App* list_command = command->add_subcommand("list", "Topics with their types.");
  add_topic_options(list_command, *options, false);
  list_command->callback([options, &exit_code] { exit_code = list(*options); });
  CLI::App* echo_command = command->add_subcommand("echo", "Prints messages.");
  add_topic_options(echo_command, *options, true);
  echo_command->callback([options, &exit_code] { exit_code = echo(*options); });
  CLI::App* hz_command = command->add_subcommand("hz", "Measures the rate.");
  add_topic_options(hz_command, *options, true);
  hz_command->add_option("--window", options->window_s, "seconds")->capture_default_str();
  hz_command->callback([options, &exit_code] { exit_code = measure(*options, false); });
  CLI::App* bw_command = command->add_subcommand("bw", "Measures the bandwidth.");
  add_topic_options(bw_command, *options, true);
  bw_command->add_option("--window", options->window_s, "seconds")->capture_default_str();
  bw_command->callback([options, &exit_code] { exit_code = measure(*options, true); });
}

}  // namespace furrow::cli
