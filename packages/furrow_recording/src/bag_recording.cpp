#include "bag_recording.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "bag_scan.hpp"
#include "chunk_merger.hpp"
#include "furrow_recording/topic_description.hpp"
#include "message_tally.hpp"
#include "ros1_translation.hpp"

namespace furrow::recording {
namespace {

using Translators = std::map<std::uint32_t, Ros1Translator>;  ///< by connection number
using Channels = std::map<std::uint32_t, mcap::ChannelId>;    ///< by connection number

/// What the streams of one bag share.
struct Bag {
  std::unique_ptr<mcap::Source> source;
  mcap::ReaderLimits limits;
  BagContent content;
  Translators translators;
  Channels channels;
};

class BagStream final : public MessageStream {
 public:
  BagStream(const Bag& bag, const mcap::Summary& summary, mcap::ReadOptions options)
      : bag_(bag),
        options_(std::move(options)),
        accepted_(accepted_connections(summary)),
        merger_(
            wanted_spans(),
            [this](std::size_t span, Bytes& records, std::vector<mcap::ChunkEntry>* entries) {
              return load(bag_.content.spans[span], records, entries);
            },
            bag.limits.open_bytes) {}

  Result<std::optional<mcap::Message>> next() override {
    const auto item = merger_.next();
    if (!item) {
      return item.error();
    }
    if (!*item) {
      return std::optional<mcap::Message>();
    }
    ByteView rest = (*item)->record;
    const auto record = take_bag_record(rest);
    if (!record) {
      return record.error();
    }
    const auto connection = record->fields.number("conn").value_or(0);
    if (Status status =
            bag_.translators.at(connection).translate(record->data, bag_.limits.record_bytes, cdr_);
        !status) {
      return Error{status.error().code, "a message on " +
                                            bag_.content.connections.at(connection).topic +
                                            " is not translated: " + status.error().message};
    }
    mcap::Message message;
    message.channel_id = bag_.channels.at(connection);
    message.log_time = (*item)->time;
    message.publish_time = (*item)->time;
    message.data = cdr_;
    return std::optional(message);
  }

 private:
  [[nodiscard]] std::set<std::uint32_t> accepted_connections(const mcap::Summary& summary) const {
    std::set<std::uint32_t> accepted;
    for (const auto& [connection, id] : bag_.channels) {
      if (!options_.accept || options_.accept(summary.channels.at(id))) {
        accepted.insert(connection);
      }
    }
    return accepted;
  }

  [[nodiscard]] std::vector<mcap::ChunkMerger::Chunk> wanted_spans() const {
    std::vector<mcap::ChunkMerger::Chunk> wanted;
    const auto& spans = bag_.content.spans;
    for (std::size_t i = 0; i < spans.size(); ++i) {
      const bool accepted = std::ranges::any_of(
          spans[i].messages, [this](const auto& entry) { return accepted_.contains(entry.first); });
      if (accepted && spans[i].start < options_.end && spans[i].end >= options_.begin) {
        wanted.push_back({spans[i].start, i});
      }
    }
    return wanted;
  }

  Status load(const BagSpan& span, Bytes& records, std::vector<mcap::ChunkEntry>* entries) const {
    if (Status status = read_records(span, records); !status || entries == nullptr) {
      return status;
    }
    ByteView rest = records;
    while (!rest.empty()) {
      const std::size_t offset = records.size() - rest.size();
      const auto record = take_bag_record(rest);
      if (!record) {
        return record.error();
      }
      const auto connection = record->fields.number("conn");
      const auto time = record->fields.time("time");
      if (record->op == BagOp::kMessage && connection && time && accepted_.contains(*connection) &&
          *time >= options_.begin && *time < options_.end) {
        entries->push_back({*time, static_cast<std::uint32_t>(offset),
                            static_cast<std::uint32_t>(records.size() - rest.size() - offset)});
      }
    }
    return {};
  }

  Status read_records(const BagSpan& span, Bytes& records) const {
    if (!span.chunk) {
      records.resize(static_cast<std::size_t>(span.length));
      return bag_.source->read(span.offset, records);
    }
    const auto place = place_bag_record(*bag_.source, span.offset, bag_.limits.record_bytes);
    return place ? unpack_bag_chunk(*bag_.source, *place, bag_.limits, records)
                 : Status(place.error());
  }

  const Bag& bag_;
  mcap::ReadOptions options_;
  std::set<std::uint32_t> accepted_;
  mcap::ChunkMerger merger_;
  Bytes cdr_;
};

class BagRecording final : public RecordingReader {
 public:
  explicit BagRecording(Bag bag) : bag_(std::move(bag)) {
    info_.format = "rosbag1";
    info_.profile = "ros2";  // as its messages appear
    info_.bytes = bag_.source->size();
    info_.damage = bag_.content.damage;
    info_.bytes_ignored = bag_.content.bytes_ignored;
    info_.faults = bag_.content.faults;
    info_.compressions = bag_.content.compressions;
    info_.summary.statistics.emplace();
    info_.summary.statistics->chunk_count = bag_.content.chunks;
    const auto& known = known_ros2_structs();
    for (const auto& [number, connection] : bag_.content.connections) {
      add_connection(number, connection, known);
    }
    count();
  }

  const RecordingInfo& info() const override { return info_; }
  std::unique_ptr<MessageStream> messages(const mcap::ReadOptions& options) const override {
    return std::make_unique<BagStream>(bag_, info_.summary, options);
  }
  // Bags have neither.
  Result<mcap::Attachment> attachment(std::size_t) const override {
    return Error{ErrorCode::kNotFound, "a ROS 1 bag has no attachments"};
  }
  Result<mcap::Metadata> metadata(std::size_t) const override {
    return Error{ErrorCode::kNotFound, "a ROS 1 bag has no metadata"};
  }

 private:
  void add_connection(std::uint32_t number, const BagConnection& connection,
                      const std::map<std::string, MessageStruct>& known) {
    const std::string where = connection.topic + " (" + connection.type + ")";
    auto translator = Ros1Translator::make(connection.type, connection.definition, known);
    if (!translator) {
      info_.faults.push_back(where + " is left out: " + translator.error().message);
      return;
    }
    if (bag_.channels.size() >= std::numeric_limits<mcap::ChannelId>::max()) {
      info_.faults.push_back(where + " is left out: more than 65535 connections");
      return;
    }
    for (const std::string& note : translator->notes()) {
      if (std::ranges::find(info_.notes, note) == info_.notes.end()) {
        info_.notes.push_back(note);
      }
    }
    mcap::Summary& summary = info_.summary;
    TopicDescription topic;
    topic.name = topic_from_file(connection.topic.starts_with('/') ? connection.topic
                                                                   : "/" + connection.topic);
    topic.type_name = translator->type_name();
    topic.schema_encoding = "ros2msg";
    topic.schema_text = ros2_definition_text(translator->schema());
    topic.publisher = connection.publisher;
    msgs::Qos qos;
    qos.depth = connection.latching ? 1 : qos.depth;
    qos.durability = connection.latching ? msgs::Durability::kTransientLocal : qos.durability;
    topic.offered_qos = {qos};
    const auto id = static_cast<mcap::ChannelId>(summary.channels.size());
    summary.channels[id] = {id, add_schema(topic), topic_in_file(topic.name),
                            topic.message_encoding, channel_metadata(topic)};
    bag_.channels[number] = id;
    bag_.translators.emplace(number, std::move(*translator));
  }

  mcap::SchemaId add_schema(const TopicDescription& topic) {
    auto& schemas = info_.summary.schemas;
    for (const auto& [id, schema] : schemas) {
      if (schema.name == topic.type_name && schema.data == topic.schema_text) {
        return id;
      }
    }
    const auto id = static_cast<mcap::SchemaId>(schemas.size() + 1);
    schemas[id] = {id, topic.type_name, topic.schema_encoding, topic.schema_text};
    return id;
  }

  void count() {
    mcap::Statistics& all = *info_.summary.statistics;
    std::map<std::uint32_t, std::uint64_t> left_out;
    for (const BagSpan& span : bag_.content.spans) {
      mcap::MessageTally tally;
      tally.start = span.start;
      tally.end = span.end;
      for (const auto& [connection, count] : span.messages) {
        if (const auto id = bag_.channels.find(connection); id != bag_.channels.end()) {
          tally.by_channel[id->second] += count;
          tally.messages += count;
        } else {
          left_out[connection] += count;
        }
      }
      mcap::add_to(all, tally);
    }
    for (const auto& [connection, count] : left_out) {
      info_.faults.push_back(std::to_string(count) + " messages of " +
                             bag_.content.connections.at(connection).topic + " are left out");
    }
    all.schema_count = static_cast<std::uint16_t>(info_.summary.schemas.size());
    all.channel_count = static_cast<std::uint32_t>(info_.summary.channels.size());
  }

  Bag bag_;
  RecordingInfo info_;
};

}  // namespace

Result<std::unique_ptr<RecordingReader>> open_bag(std::unique_ptr<mcap::Source> source,
                                                  const OpenOptions& options) {
  auto content = scan_bag(*source, options);
  if (!content) {
    return content.error();
  }
  Bag bag;
  bag.source = std::move(source);
  bag.limits = options.limits;
  bag.content = std::move(*content);
  return std::unique_ptr<RecordingReader>(std::make_unique<BagRecording>(std::move(bag)));
}

}  // namespace furrow::recording
