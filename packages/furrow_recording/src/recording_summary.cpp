#include "furrow_recording/recording_summary.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "furrow_recording/topic_description.hpp"
#include "records.hpp"

namespace furrow::recording {
namespace {

constexpr std::size_t kMaxReportedFaults = 100;

std::string quality_of(const TopicDescription& topic) {
  if (topic.offered_qos.empty()) {
    return topic.latched() ? "latched" : "-";
  }
  const bool reliable = topic.offered_qos.front().reliability == msgs::Reliability::kReliable;
  return std::string(reliable ? "reliable" : "best effort") + (topic.latched() ? ", latched" : "");
}

/// True for the bytes of an MCAP file, whatever else is wrong with it.
bool is_mcap(const std::filesystem::path& path) {
  const auto source = mcap::open_file(path);
  std::array<std::byte, mcap::kMagic.size()> magic{};
  return source && (*source)->read(0, magic) && magic == mcap::kMagic;
}

void read_all_messages(const RecordingReader& reader, mcap::VerifyReport& report) {
  const auto stream = reader.messages({});
  while (true) {
    const auto next = stream->next();
    if (next && !*next) {
      return;
    }
    if (next) {
      ++report.messages;
      continue;
    }
    report.faults.push_back(next.error().message);
    if (next.error().code == ErrorCode::kIo || report.faults.size() >= kMaxReportedFaults) {
      return;
    }
  }
}

}  // namespace

std::vector<TopicSummary> summarize_topics(const RecordingInfo& info) {
  const mcap::Statistics& statistics = info.statistics();
  const double duration_s = (statistics.end_time - statistics.start_time).to_seconds();
  std::vector<TopicSummary> topics;
  for (const auto& [id, channel] : info.summary.channels) {
    const auto schema = info.summary.schemas.find(channel.schema_id);
    const TopicDescription described =
        describe_channel(channel, schema == info.summary.schemas.end() ? nullptr : &schema->second);
    const auto count = statistics.channel_message_counts.find(id);
    const std::uint64_t messages =
        count == statistics.channel_message_counts.end() ? 0 : count->second;
    TopicSummary topic{described.name,
                       described.type_name,
                       messages,
                       0.0,
                       described.schema_encoding,
                       described.message_encoding,
                       quality_of(described)};
    const auto same = std::ranges::find_if(topics, [&topic](const TopicSummary& other) {
      return std::tie(other.topic, other.type, other.encoding) ==
             std::tie(topic.topic, topic.type, topic.encoding);
    });
    if (same != topics.end()) {
      same->messages += messages;
      ++same->channels;
    } else {
      topics.push_back(std::move(topic));
    }
  }
  for (TopicSummary& topic : topics) {
    topic.rate_hz = duration_s > 0.0 ? static_cast<double>(topic.messages) / duration_s : 0.0;
  }
  return topics;
}

Result<mcap::VerifyReport> verify_recording(const std::filesystem::path& path) {
  if (is_mcap(path)) {
    const auto source = mcap::open_file(path);
    return source ? mcap::verify(**source) : Result<mcap::VerifyReport>(source.error());
  }
  OpenOptions options;
  options.scan = true;
  const auto reader = open_recording(path, options);
  mcap::VerifyReport report;
  if (!reader) {
    if (reader.error().code != ErrorCode::kParse) {
      return reader.error();
    }
    report.faults.push_back(reader.error().message);
    return report;
  }
  const RecordingInfo& info = (*reader)->info();
  report.chunks = info.statistics().chunk_count;
  report.bytes = info.bytes;
  report.closed = info.damage.empty();
  report.faults = info.faults;
  if (!info.damage.empty()) {
    report.faults.push_back(info.damage);
  }
  read_all_messages(**reader, report);
  return report;
}

}  // namespace furrow::recording
