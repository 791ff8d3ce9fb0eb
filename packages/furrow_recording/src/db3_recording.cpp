#include "db3_recording.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "compression.hpp"
#include "furrow_recording/topic_description.hpp"
#include "sqlite_database.hpp"

namespace furrow::recording {
namespace {

constexpr std::size_t kMaxTopics = 65'000;
constexpr std::array kZstdMagic = {std::byte{0x28}, std::byte{0xB5}, std::byte{0x2F},
                                   std::byte{0xFD}};

using TopicIds = std::map<std::int64_t, mcap::ChannelId>;  ///< by the id in the database

bool has(const std::vector<std::string>& columns, std::string_view name) {
  return std::ranges::find(columns, name) != columns.end();
}

/// Reads the messages in the order of time: first where they are, so that sorting needs no room for
/// their data.
class Db3Stream final : public MessageStream {
 public:
  Db3Stream(SqliteQuery order, SqliteQuery data, const TopicIds& topics,
            std::uint64_t max_message_bytes)
      : order_(std::move(order)),
        data_(std::move(data)),
        topics_(topics),
        max_message_bytes_(max_message_bytes) {}

  Result<std::optional<mcap::Message>> next() override {
    if (ended_) {
      return std::optional<mcap::Message>();
    }
    const auto row = order_.next();
    if (!row || !*row) {
      ended_ = true;
      return row ? Result<std::optional<mcap::Message>>(std::nullopt)
                 : Result<std::optional<mcap::Message>>(row.error());
    }
    mcap::Message message;
    message.log_time = Time::from_nanoseconds(order_.integer(1));
    message.publish_time = message.log_time;
    message.channel_id = topics_.at(order_.integer(2));
    if (Status status = data_.restart(order_.integer(0)); !status) {
      return status.error();
    }
    const auto found = data_.next();
    if (!found) {
      return found.error();
    }
    if (!*found) {
      return Error{ErrorCode::kParse, "a message is missing, the index of times is damaged"};
    }
    auto data = content(data_.blob(0));
    if (!data) {
      return data.error();
    }
    message.data = *data;
    return std::optional(message);
  }

 private:
  /// Compressed messages are told by their first bytes, which no CDR message begins with.
  Result<mcap::ByteView> content(mcap::ByteView data) {
    if (data.size() < kZstdMagic.size() ||
        !std::equal(kZstdMagic.begin(), kZstdMagic.end(), data.begin())) {
      return data;
    }
    if (Status status = mcap::unpack_zstd_frame(data, max_message_bytes_, unpacked_); !status) {
      return status.error();
    }
    return mcap::ByteView(unpacked_);
  }

  SqliteQuery order_;
  SqliteQuery data_;
  const TopicIds& topics_;
  std::uint64_t max_message_bytes_;
  mcap::Bytes unpacked_;
  bool ended_ = false;
};

/// Stands in for a stream whose queries cannot be made.
class FailedStream final : public MessageStream {
 public:
  explicit FailedStream(Error error) : error_(std::move(error)) {}
  Result<std::optional<mcap::Message>> next() override {
    if (std::exchange(told_, true)) {
      return std::optional<mcap::Message>();
    }
    return error_;
  }

 private:
  Error error_;
  bool told_ = false;
};

class Db3Recording final : public RecordingReader {
 public:
  Db3Recording(SqliteDatabase database, std::uint64_t bytes, const OpenOptions& options)
      : database_(std::move(database)), limits_(options.limits) {
    info_.format = "rosbag2";
    info_.profile = "ros2";
    info_.bytes = bytes;
    info_.summary.statistics.emplace();
  }

  Status load(bool check_everything) {
    for (const auto step : {&Db3Recording::read_definitions, &Db3Recording::read_topics,
                            &Db3Recording::count_messages, &Db3Recording::find_compression}) {
      if (Status status = (this->*step)(); !status) {
        return status;
      }
    }
    return check_everything ? check_integrity() : Status();
  }

  /// Keeps the bytes of a database in memory alive.
  void own(std::vector<std::byte> bytes) { bytes_ = std::move(bytes); }

  const RecordingInfo& info() const override { return info_; }

  std::unique_ptr<MessageStream> messages(const mcap::ReadOptions& options) const override {
    std::string ids;
    for (const auto& [id, channel] : topics_) {
      if (!options.accept || options.accept(info_.summary.channels.at(channel))) {
        ids += (ids.empty() ? "" : ",") + std::to_string(id);
      }
    }
    const Time begin = std::max(options.begin, Time());
    auto order =
        database_.query("SELECT id, timestamp, topic_id FROM messages WHERE timestamp >= " +
                        std::to_string(begin.count_ns()) + " AND timestamp < " +
                        std::to_string(options.end.count_ns()) + " AND topic_id IN (" + ids +
                        ") ORDER BY timestamp, id");
    auto data = database_.query("SELECT data FROM messages WHERE id = ?");
    if (!order || !data) {
      return std::make_unique<FailedStream>(order ? data.error() : order.error());
    }
    return std::make_unique<Db3Stream>(std::move(*order), std::move(*data), topics_,
                                       limits_.record_bytes);
  }

  Result<mcap::Attachment> attachment(std::size_t) const override {
    return Error{ErrorCode::kNotFound, "a .db3 file has no attachments"};
  }
  Result<mcap::Metadata> metadata(std::size_t) const override {
    return Error{ErrorCode::kNotFound, "a .db3 file has no metadata records"};
  }

 private:
  struct Definition {
    std::string encoding;
    std::string text;
  };

  /// Calls `use(query)` for each row.
  template <class Use>
  Status for_each_row(const std::string& sql, Use use) const {
    auto query = database_.query(sql);
    if (!query) {
      return query.error();
    }
    while (true) {
      const auto row = query->next();
      if (!row) {
        return row.error();
      }
      if (!*row) {
        return {};
      }
      use(*query);
    }
  }

  /// Since ROS 2 Iron the file may hold the text of its types.
  Status read_definitions() {
    const auto columns = database_.columns("message_definitions");
    if (!columns) {
      return columns.error();
    }
    if (!has(*columns, "topic_type") || !has(*columns, "encoded_message_definition") ||
        !has(*columns, "encoding")) {
      return {};
    }
    return for_each_row(
        "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions",
        [this](const SqliteQuery& row) {
          if (row.text(1) != "unknown" && definitions_.size() < kMaxTopics) {
            definitions_[row.text(0)] = {row.text(1), row.text(2)};
          }
        });
  }

  Status read_topics() {
    const auto columns = database_.columns("topics");
    if (!columns) {
      return columns.error();
    }
    if (!has(*columns, "id") || !has(*columns, "name") || !has(*columns, "type")) {
      return Error{ErrorCode::kParse, "not a rosbag2 file: it has no table of topics"};
    }
    const auto or_empty = [&columns](const std::string& name) {
      return has(*columns, name) ? name : std::string("''");
    };
    return for_each_row("SELECT id, name, type, " + or_empty("serialization_format") + ", " +
                            or_empty("offered_qos_profiles") + " FROM topics ORDER BY id",
                        [this](const SqliteQuery& row) { add_topic(row); });
  }

  void add_topic(const SqliteQuery& row) {
    mcap::Summary& summary = info_.summary;
    if (summary.channels.size() >= kMaxTopics) {
      if (!std::exchange(too_many_topics_, true)) {
        info_.faults.push_back("more than 65000 topics; the rest is left out");
      }
      return;
    }
    const std::string type = row.text(2);
    const auto id = static_cast<mcap::ChannelId>(summary.channels.size());
    mcap::Channel& channel = summary.channels[id];
    channel.id = id;
    channel.schema_id = add_schema(type);
    channel.topic = row.text(1);
    channel.message_encoding = row.text(3).empty() ? "cdr" : row.text(3);
    if (const std::string qos = row.text(4); !qos.empty()) {
      channel.metadata["offered_qos_profiles"] = qos;
    }
    topics_[row.integer(0)] = id;
  }

  mcap::SchemaId add_schema(const std::string& type) {
    auto& schemas = info_.summary.schemas;
    for (const auto& [id, schema] : schemas) {
      if (schema.name == type) {
        return id;
      }
    }
    const auto id = static_cast<mcap::SchemaId>(schemas.size() + 1);
    if (const auto own = definitions_.find(type); own != definitions_.end()) {
      schemas[id] = {id, type, own->second.encoding, own->second.text};
    } else {
      // Of the types that Furrow knows; else only the name is known.
      const TopicDescription topic = describe_topic("", type, {}, SchemaStyle::kRos2msg);
      schemas[id] = {id, type, topic.schema_encoding, topic.schema_text};
    }
    return id;
  }

  Status count_messages() {
    const auto columns = database_.columns("messages");
    if (!columns) {
      return columns.error();
    }
    if (!has(*columns, "id") || !has(*columns, "topic_id") || !has(*columns, "timestamp") ||
        !has(*columns, "data")) {
      return Error{ErrorCode::kParse, "not a rosbag2 file: it has no table of messages"};
    }
    std::uint64_t unreadable = 0;
    Status status = for_each_row(
        "SELECT topic_id, COUNT(*), MIN(timestamp), MAX(timestamp), "
        "timestamp IS NOT NULL AND timestamp >= 0 FROM messages GROUP BY 1, 5",
        [&](const SqliteQuery& row) {
          const auto topic = topics_.find(row.integer(0));
          const auto count = static_cast<std::uint64_t>(row.integer(1));
          if (topic == topics_.end() || row.integer(4) == 0) {
            unreadable += count;
            return;
          }
          add_count(topic->second, count, Time::from_nanoseconds(row.integer(2)),
                    Time::from_nanoseconds(row.integer(3)));
        });
    if (unreadable > 0) {
      info_.faults.push_back(std::to_string(unreadable) +
                             " messages have an unknown topic or a negative time");
    }
    mcap::Statistics& all = *info_.summary.statistics;
    all.schema_count = static_cast<std::uint16_t>(info_.summary.schemas.size());
    all.channel_count = static_cast<std::uint32_t>(info_.summary.channels.size());
    return status;
  }

  void add_count(mcap::ChannelId channel, std::uint64_t count, Time first, Time last) {
    mcap::Statistics& all = *info_.summary.statistics;
    all.start_time = all.message_count == 0 ? first : std::min(all.start_time, first);
    all.end_time = all.message_count == 0 ? last : std::max(all.end_time, last);
    all.message_count += count;
    all.channel_message_counts[channel] += count;
  }

  Status find_compression() {
    bool compressed = false;
    Status status = for_each_row("SELECT substr(data, 1, 4) FROM messages LIMIT 1",
                                 [&compressed](const SqliteQuery& row) {
                                   const auto head = row.blob(0);
                                   compressed = std::ranges::equal(head, kZstdMagic);
                                 });
    info_.compressions.insert(compressed ? "zstd" : "none");
    return status;
  }

  Status check_integrity() {
    return for_each_row("PRAGMA integrity_check(100)", [this](const SqliteQuery& row) {
      if (const std::string line = row.text(0); line != "ok") {
        info_.faults.push_back(line);
      }
    });
  }

  std::vector<std::byte> bytes_;
  SqliteDatabase database_;
  mcap::ReaderLimits limits_;
  RecordingInfo info_;
  std::map<std::string, Definition> definitions_;  ///< by type
  TopicIds topics_;
  bool too_many_topics_ = false;
};

Result<std::unique_ptr<RecordingReader>> loaded(std::unique_ptr<Db3Recording> recording,
                                                const OpenOptions& options) {
  if (Status status = recording->load(options.scan); !status) {
    return status.error();
  }
  return std::unique_ptr<RecordingReader>(std::move(recording));
}

}  // namespace

Result<std::unique_ptr<RecordingReader>> open_db3(const std::filesystem::path& path,
                                                  const OpenOptions& options, bool temporary) {
  std::error_code failure;
  const auto bytes = std::filesystem::file_size(path, failure);
  auto database = SqliteDatabase::open(path, options.limits.record_bytes, temporary);
  if (database && !temporary && !database->query("SELECT 1 FROM sqlite_master LIMIT 1")) {
    // A journal that cannot be opened, in a folder that may not be written to.
    database = SqliteDatabase::open(path, options.limits.record_bytes, true);
  }
  if (!database) {
    return database.error();
  }
  return loaded(std::make_unique<Db3Recording>(std::move(*database), failure ? 0 : bytes, options),
                options);
}

Result<std::unique_ptr<RecordingReader>> open_db3(std::vector<std::byte> bytes,
                                                  const OpenOptions& options) {
  auto database = SqliteDatabase::open(bytes, options.limits.record_bytes);
  if (!database) {
    return database.error();
  }
  auto recording = std::make_unique<Db3Recording>(std::move(*database), bytes.size(), options);
  recording->own(std::move(bytes));
  return loaded(std::move(recording), options);
}

}  // namespace furrow::recording
