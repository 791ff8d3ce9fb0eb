#include "targets.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "db3_recording.hpp"
#include "furrow_recording/cdr_table.hpp"
#include "furrow_recording/mcap_verify.hpp"
#include "furrow_recording/recording_copy.hpp"
#include "furrow_recording/recording_summary.hpp"
#include "furrow_recording/topic_description.hpp"
#include "ros1_translation.hpp"
#include "rosbag2_metadata.hpp"

namespace furrow::recording::fuzz {
namespace {

using Bytes = std::vector<std::byte>;

/// Small, so that a run takes milliseconds.
constexpr std::size_t kFuzzLimit = 1u << 20;

OpenOptions fuzz_options(bool scan) {
  OpenOptions options;
  options.limits.record_bytes = kFuzzLimit;
  options.limits.open_bytes = 1u << 16;
  options.scan = scan;
  return options;
}

/// A condition that holds for every input.
void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

void use(const RecordingReader& reader) {
  (void)summarize_topics(reader.info());
  std::uint64_t messages = 0;
  std::uint64_t errors = 0;
  mcap::ReadOptions all;
  const auto stream = reader.messages(all);
  for (auto next = stream->next(); !next || *next; next = stream->next()) {
    messages += next ? 1 : 0;
    errors += next ? 0 : 1;
    require(!next || reader.info().summary.channels.contains((*next)->channel_id));
    if (!next && next.error().code == ErrorCode::kIo) {
      break;
    }
    require(errors < 1'000'000);
  }
  Bytes copied;
  auto writer = mcap::Writer::open(mcap::memory_sink(copied));
  Selection selection;
  selection.max_hz = 5.0;
  const auto report = copy_recording(reader, **writer, selection);
  require((*writer)->close().ok());
  // Whatever was read, what is written is sound.
  const auto verified = mcap::verify(*mcap::memory_source(copied));
  require(verified.ok() && verified->faults.empty());
  require(!report || report->messages <= messages + report->latched);
}

void open_and_use(std::span<const std::byte> bytes) {
  for (const bool scan : {false, true}) {
    const auto reader = open_recording(mcap::memory_source(bytes), fuzz_options(scan));
    if (reader) {
      use(**reader);
    }
  }
}

}  // namespace

void read_mcap(std::span<const std::uint8_t> input) {
  const auto bytes = std::as_bytes(input);
  open_and_use(bytes);
  const auto options = fuzz_options(false);
  (void)mcap::verify(*mcap::memory_source(bytes), options.limits);
}

void read_bag(std::span<const std::uint8_t> input) {
  open_and_use(std::as_bytes(input));
}

void read_db3(std::span<const std::uint8_t> input) {
  const auto bytes = std::as_bytes(input);
  for (const bool scan : {false, true}) {
    const auto reader = open_db3({bytes.begin(), bytes.end()}, fuzz_options(scan));
    if (reader) {
      use(**reader);
    }
  }
}

void read_message(std::span<const std::uint8_t> input) {
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  const std::size_t line = std::min(text.find('\n'), text.size());
  const std::string_view kind = text.substr(0, line);
  const std::size_t zero = std::min(text.find('\0', line), text.size());
  const std::string_view definition =
      text.substr(std::min(line + 1, zero), zero - std::min(line + 1, zero));
  const auto message = std::as_bytes(input.subspan(std::min(zero + 1, input.size())));
  if (kind == "ros1") {
    const auto& known = known_ros2_structs();
    for (const char* type : {"p/T", "sensor_msgs/CameraInfo", "rosgraph_msgs/Log"}) {
      const auto translator = Ros1Translator::make(type, definition, known);
      Bytes cdr;
      if (!translator || !translator->translate(message, kFuzzLimit, cdr)) {
        continue;
      }
      // What was translated is read by the layout and by the text of the ROS 2 form alike.
      const auto schema = parse_message_definition(ros2_definition_text(translator->schema()),
                                                   translator->type_name(), RosVersion::kRos2);
      require(schema.ok());
      const auto table = CdrTable::make(*schema);
      require(!table || table->row(cdr).ok());
    }
    return;
  }
  auto schema = parse_schema_text(kind, definition, "p/msg/T");
  if (!schema) {
    return;
  }
  const auto table = CdrTable::make(std::move(*schema));
  if (table) {
    const auto row = table->row(message);
    require(!row || row->size() == table->columns().size());
  }
}

void read_yaml(std::span<const std::uint8_t> input) {
  const std::string text(reinterpret_cast<const char*>(input.data()), input.size());
  (void)parse_rosbag2_metadata(text);
  (void)qos_from_yaml(text);
}

}  // namespace furrow::recording::fuzz
