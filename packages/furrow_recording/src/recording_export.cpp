#include "furrow_recording/recording_export.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "furrow_core/file.hpp"
#include "furrow_recording/cdr_table.hpp"
#include "furrow_recording/topic_description.hpp"
#include "image_files.hpp"

namespace furrow::recording {
namespace {

constexpr std::size_t kMaxExportFaults = 100;

/// A file name for a topic: letters, digits, "-" and "_".
std::string file_name_of(const std::string& topic) {
  std::string name;
  for (const char c : topic) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_';
    name += plain ? c : '_';
  }
  return name.empty() ? "topic" : name.substr(0, 200);
}

Error cannot_write(const std::filesystem::path& path) {
  return {ErrorCode::kIo, path.string() + ": cannot be written"};
}

/// Where the messages of one topic go.
class TopicExport {
 public:
  explicit TopicExport(std::string name) { topic_.name = std::move(name); }
  virtual ~TopicExport() = default;
  TopicExport(const TopicExport&) = delete;
  TopicExport& operator=(const TopicExport&) = delete;

  /// kIo when the disk refuses; a message that cannot be read is counted.
  [[nodiscard]] virtual Status add(const mcap::Message& message) = 0;
  [[nodiscard]] virtual Status finish() { return {}; }
  [[nodiscard]] const ExportedTopic& topic() const { return topic_; }

 protected:
  Status leave_out(const std::string& reason) {
    topic_.reason = topic_.left_out == 0 ? reason : topic_.reason;
    ++topic_.left_out;
    return {};
  }
  ExportedTopic topic_;
};

/// A topic that cannot be exported.
class NoExport final : public TopicExport {
 public:
  NoExport(std::string name, std::string reason)
      : TopicExport(std::move(name)), reason_(std::move(reason)) {}
  Status add(const mcap::Message&) override { return leave_out(reason_); }

 private:
  std::string reason_;
};

class CsvExport final : public TopicExport {
 public:
  CsvExport(std::string name, const std::filesystem::path& path, CdrTable table)
      : TopicExport(std::move(name)),
        path_(path),
        table_(std::move(table)),
        file_(path, std::ios::binary) {
    topic_.file = path.filename().string();
    std::vector<std::string> columns = {"log_time_ns", "publish_time_ns"};
    columns.insert(columns.end(), table_.columns().begin(), table_.columns().end());
    file_ << csv_line(columns);
  }

  Status add(const mcap::Message& message) override {
    auto row = table_.row(message.data);
    if (!row) {
      return leave_out(row.error().message);
    }
    row->insert(row->begin(), {std::to_string(message.log_time.count_ns()),
                               std::to_string(message.publish_time.count_ns())});
    file_ << csv_line(*row);
    ++topic_.written;
    return file_ ? Status() : Status(cannot_write(path_));
  }

  Status finish() override {
    file_.close();
    return file_ ? Status() : Status(cannot_write(path_));
  }

 private:
  std::filesystem::path path_;
  CdrTable table_;
  std::ofstream file_;
};

/// PNG files, and their entries in the list of frames that all image topics share.
class ImageExport final : public TopicExport {
 public:
  ImageExport(std::string name, std::string type, const std::filesystem::path& folder,
              nlohmann::ordered_json& frames)
      : TopicExport(std::move(name)), type_(std::move(type)), folder_(folder), frames_(frames) {
    topic_.file = folder.filename().string();
  }

  Status add(const mcap::Message& message) override {
    const auto image = decode_image(type_, message.data);
    if (!image) {
      return leave_out(image.error().message);
    }
    char number[16];
    std::snprintf(number, sizeof number, "%06llu", static_cast<unsigned long long>(topic_.written));
    const std::string file =
        std::string(number) + "_" + std::to_string(image->stamp.count_ns()) + ".png";
    const std::string_view content(reinterpret_cast<const char*>(image->png.data()),
                                   image->png.size());
    if (Status status = write_file_atomically(folder_ / file, content); !status) {
      return status;
    }
    ++topic_.written;
    frames_.push_back({{"id", frames_.size() + 1},
                       {"file_name", topic_.file + "/" + file},
                       {"width", image->width},
                       {"height", image->height},
                       {"topic", topic_.name},
                       {"stamp_ns", image->stamp.count_ns()},
                       {"log_time_ns", message.log_time.count_ns()},
                       {"frame_id", image->frame_id},
                       {"encoding", image->encoding}});
    return {};
  }

 private:
  std::string type_;
  std::filesystem::path folder_;
  nlohmann::ordered_json& frames_;
};

/// A folder that gets its name when it is whole, else is removed.
class NewFolder {
 public:
  explicit NewFolder(std::filesystem::path path)
      : path_(std::move(path)), part_(path_.string() + ".part" + std::to_string(::getpid())) {}
  ~NewFolder() {
    std::error_code ignored;
    if (!part_.empty()) {
      std::filesystem::remove_all(part_, ignored);
    }
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  Status create() {
    std::error_code failure;
    if (std::filesystem::exists(std::filesystem::symlink_status(path_, failure))) {
      part_.clear();
      return Error{ErrorCode::kInvalidArgument,
                   path_.string() + ": exists and is not overwritten; choose another name"};
    }
    if (!std::filesystem::create_directories(part_, failure)) {
      return Error{ErrorCode::kIo, part_.string() + ": cannot be made: " + failure.message()};
    }
    return {};
  }
  Status publish() {
    std::error_code failure;
    std::filesystem::rename(part_, path_, failure);
    if (failure) {
      return Error{ErrorCode::kIo, path_.string() + ": cannot be named: " + failure.message()};
    }
    part_.clear();
    return {};
  }
  [[nodiscard]] const std::filesystem::path& part() const { return part_; }

 private:
  std::filesystem::path path_;
  std::filesystem::path part_;
};

class Exporter {
 public:
  Exporter(const RecordingReader& reader, const std::filesystem::path& folder,
           const ExportOptions& options)
      : reader_(reader), folder_(folder), options_(options) {}

  Result<ExportReport> run() {
    report_.damage = reader_.info().damage;
    report_.faults = reader_.info().faults;
    Status status = select();
    if (status) {
      status = folder_.create();
    }
    if (status) {
      add_topics();
      status = read_messages();
    }
    for (const auto& topic : topics_) {
      if (status) {
        status = topic->finish();
      }
    }
    if (status && !frames_.empty()) {
      status = write_frames();
    }
    if (status) {
      status = folder_.publish();
    }
    if (!status) {
      return status.error();
    }
    for (const auto& topic : topics_) {
      report_.topics.push_back(topic->topic());
    }
    report_.images = frames_.size();
    return std::move(report_);
  }

 private:
  Status select() {
    const mcap::Statistics& statistics = reader_.info().statistics();
    const Duration length = statistics.end_time - statistics.start_time;
    if (!std::isfinite(options_.from_s) || options_.from_s < 0.0 ||
        Duration::seconds(options_.from_s) > length) {
      return Error{ErrorCode::kInvalidArgument, "the start lies outside of the recording"};
    }
    std::vector<std::string> names;
    bool any = false;
    for (const auto& [id, channel] : reader_.info().summary.channels) {
      names.push_back(topic_from_file(channel.topic));
      any = any || options_.topics.accepts(names.back());
    }
    report_.unmatched_includes = unmatched_patterns(options_.topics.include, names);
    return any || names.empty()
               ? Status()
               : Status(Error{ErrorCode::kInvalidArgument, "no topic of the recording matches"});
  }

  void add_topics() {
    const mcap::Summary& summary = reader_.info().summary;
    std::map<std::tuple<std::string, std::string, std::string>, std::size_t> known;
    for (const auto& [id, channel] : summary.channels) {
      const auto schema = summary.schemas.find(channel.schema_id);
      const TopicDescription topic =
          describe_channel(channel, schema == summary.schemas.end() ? nullptr : &schema->second);
      if (!options_.topics.accepts(topic.name)) {
        continue;
      }
      const auto [at, added] =
          known.try_emplace({topic.name, topic.type_name, topic.message_encoding}, topics_.size());
      if (added) {
        topics_.push_back(make(topic));
      }
      channels_[id] = at->second;
    }
  }

  std::unique_ptr<TopicExport> make(const TopicDescription& topic) {
    if (topic.message_encoding != "cdr") {
      return std::make_unique<NoExport>(
          topic.name, "the message encoding is '" + topic.message_encoding + "', not CDR");
    }
    if (is_image_type(topic.type_name)) {
      return std::make_unique<ImageExport>(topic.name, topic.type_name,
                                           folder_.part() / unused_name(topic.name, ""), frames_);
    }
    auto schema = parse_schema_text(topic.schema_encoding, topic.schema_text, topic.type_name);
    if (!schema) {
      return std::make_unique<NoExport>(topic.name, schema.error().message);
    }
    auto table = CdrTable::make(std::move(*schema));
    if (!table) {
      return std::make_unique<NoExport>(topic.name, table.error().message);
    }
    return std::make_unique<CsvExport>(topic.name, folder_.part() / unused_name(topic.name, ".csv"),
                                       std::move(*table));
  }

  /// Different topics may have the same name as files.
  std::string unused_name(const std::string& topic, const std::string& extension) {
    const std::string name = file_name_of(topic);
    const int uses = names_[name]++;
    return name + (uses == 0 ? "" : "_" + std::to_string(uses + 1)) + extension;
  }

  Status read_messages() {
    const Time start = reader_.info().statistics().start_time;
    mcap::ReadOptions range;
    range.begin = start + Duration::seconds(options_.from_s);
    if (options_.to_s) {
      range.end = start + Duration::seconds(*options_.to_s);
    }
    range.accept = [this](const mcap::Channel& channel) { return channels_.contains(channel.id); };
    const auto stream = reader_.messages(range);
    while (true) {
      const auto next = stream->next();
      if (!next && next.error().code == ErrorCode::kIo) {
        return next.error();
      }
      if (!next) {
        if (report_.faults.size() < kMaxExportFaults) {
          report_.faults.push_back(next.error().message);
        }
        continue;
      }
      if (!*next) {
        return {};
      }
      if (Status status = topics_[channels_.at((*next)->channel_id)]->add(**next); !status) {
        return status;
      }
    }
  }

  Status write_frames() {
    const nlohmann::ordered_json coco = {
        {"info", {{"description", "frames of a recording, not annotated"}}},
        {"images", frames_},
        {"annotations", nlohmann::ordered_json::array()},
        {"categories", nlohmann::ordered_json::array()}};
    const std::string text =
        coco.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    return write_file_atomically(folder_.part() / "frames.json", text + "\n");
  }

  const RecordingReader& reader_;
  NewFolder folder_;
  const ExportOptions& options_;
  ExportReport report_;
  std::vector<std::unique_ptr<TopicExport>> topics_;
  std::map<mcap::ChannelId, std::size_t> channels_;  ///< number in topics_
  std::map<std::string, int> names_;                 ///< of files, with their uses
  nlohmann::ordered_json frames_ = nlohmann::ordered_json::array();
};

}  // namespace

bool ExportReport::complete() const {
  return faults.empty() && damage.empty() && unmatched_includes.empty() &&
         std::ranges::all_of(topics,
                             [](const ExportedTopic& topic) { return topic.left_out == 0; });
}

Result<ExportReport> export_recording(const RecordingReader& reader,
                                      const std::filesystem::path& folder,
                                      const ExportOptions& options) {
  return Exporter(reader, folder, options).run();
}

}  // namespace furrow::recording
