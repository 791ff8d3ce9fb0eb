#include "furrow_recording/recording_copy.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "furrow_recording/latched_messages.hpp"
#include "new_file.hpp"

namespace furrow::recording {
namespace {

constexpr std::size_t kMaxFaults = 100;

std::string seconds_text(Duration duration) {
  std::string text = std::to_string(duration.to_seconds());
  return text.substr(0, text.find('.') + 4);
}

/// Channels of a recording that the patterns accept.
std::set<mcap::ChannelId> accepted_channels(const mcap::Summary& summary,
                                            const TopicFilter& topics) {
  std::set<mcap::ChannelId> accepted;
  for (const auto& [id, channel] : summary.channels) {
    if (topics.accepts(topic_from_file(channel.topic))) {
      accepted.insert(id);
    }
  }
  return accepted;
}

class Copier {
 public:
  Copier(const RecordingReader& reader, mcap::Writer& writer, const Selection& selection)
      : reader_(reader), writer_(writer), selection_(selection) {}

  Result<CopyReport> run() {
    const RecordingInfo& info = reader_.info();
    report_.messages_in = info.statistics().message_count;
    report_.damage = info.damage;
    report_.bytes_ignored = info.bytes_ignored;
    report_.faults = info.faults;
    report_.notes = info.notes;
    Status status = select();
    for (const auto step : {&Copier::copy_metadata, &Copier::copy_attachments,
                            &Copier::add_channels, &Copier::copy_latched, &Copier::copy_messages}) {
      if (status) {
        status = (this->*step)();
      }
    }
    if (!status) {
      return status.error();
    }
    return std::move(report_);
  }

 private:
  Status select() {
    const mcap::Summary& summary = reader_.info().summary;
    std::vector<std::string> names;
    for (const auto& [id, channel] : summary.channels) {
      names.push_back(topic_from_file(channel.topic));
    }
    report_.unmatched_includes = unmatched_patterns(selection_.topics.include, names);
    report_.unmatched_excludes = unmatched_patterns(selection_.topics.exclude, names);
    accepted_ = accepted_channels(summary, selection_.topics);
    if (accepted_.empty() && !summary.channels.empty()) {
      return Error{ErrorCode::kInvalidArgument,
                   "no topic matches; the recording has " + list_of_topics(std::move(names))};
    }
    const mcap::Statistics& statistics = *summary.statistics;
    const Duration length = statistics.end_time - statistics.start_time;
    if (!std::isfinite(selection_.from_s) || selection_.from_s < 0.0 ||
        Duration::seconds(selection_.from_s) > length) {
      return Error{
          ErrorCode::kInvalidArgument,
          "the start lies outside of the recording, which is " + seconds_text(length) + " s long"};
    }
    begin_ = statistics.start_time + Duration::seconds(selection_.from_s);
    if (selection_.to_s) {
      if (!(*selection_.to_s > selection_.from_s)) {
        return Error{ErrorCode::kInvalidArgument, "the end is not later than the start"};
      }
      end_ = statistics.start_time + Duration::seconds(*selection_.to_s);
    }
    return {};
  }

  static std::string list_of_topics(std::vector<std::string> names) {
    constexpr std::size_t kShown = 10;
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
      text += (i > 0 ? ", " : "") + names[i];
    }
    return names.size() > kShown ? text + " and " + std::to_string(names.size() - kShown) + " more"
                                 : text;
  }

  Status copy_metadata() {
    for (std::size_t i = 0; i < reader_.info().summary.metadata.size(); ++i) {
      const auto record = reader_.metadata(i);
      if (!record) {
        fault(record.error().message);
      } else if (Status status = writer_.write(*record); !status) {
        return status;
      } else {
        ++report_.metadata;
      }
    }
    return {};
  }

  Status copy_attachments() {
    for (std::size_t i = 0; i < reader_.info().summary.attachments.size(); ++i) {
      const auto record = reader_.attachment(i);
      if (!record) {
        fault(record.error().message);
      } else if (Status status = writer_.write(*record); !status) {
        return status;
      } else {
        ++report_.attachments;
      }
    }
    return {};
  }

  /// Also channels without messages: a topic that was recorded and was silent is a fact.
  Status add_channels() {
    const mcap::Summary& summary = reader_.info().summary;
    for (const mcap::ChannelId id : accepted_) {
      mcap::Channel channel = summary.channels.at(id);
      const auto schema = summary.schemas.find(channel.schema_id);
      describe(id, channel, schema == summary.schemas.end() ? nullptr : &schema->second);
      channel.schema_id = 0;
      if (schema != summary.schemas.end()) {
        const auto added =
            writer_.add_schema(schema->second.name, schema->second.encoding, schema->second.data);
        if (!added) {
          return added.error();
        }
        channel.schema_id = *added;
      }
      const auto added = writer_.add_channel(std::move(channel));
      if (!added) {
        return added.error();
      }
      channels_[id] = *added;
    }
    return {};
  }

  void describe(mcap::ChannelId id, const mcap::Channel& channel, const mcap::Schema* schema) {
    const TopicDescription topic = describe_channel(channel, schema);
    latched_.add_channel(id, topic);
  }

  [[nodiscard]] mcap::ReadOptions read_options(Time begin, Time end) const {
    mcap::ReadOptions options;
    options.begin = begin;
    options.end = end;
    options.accept = [this](const mcap::Channel& channel) {
      return accepted_.contains(channel.id);
    };
    return options;
  }

  Status copy_latched() {
    if (!selection_.latched || selection_.from_s <= 0.0) {
      return {};
    }
    mcap::ReadOptions options = read_options(Time(), begin_);
    options.accept = [this](const mcap::Channel& channel) {
      return accepted_.contains(channel.id) && latched_.keeps(channel.id);
    };
    Status status = for_each(options, [this](const mcap::Message& message) -> Status {
      latched_.add({message.channel_id, message.sequence, message.log_time, message.publish_time,
                    std::make_shared<const std::vector<std::byte>>(message.data.begin(),
                                                                   message.data.end())});
      return {};
    });
    for (const KeptMessage& kept : latched_.take()) {
      if (status) {
        ++report_.latched;
        status = write({static_cast<mcap::ChannelId>(kept.channel), kept.sequence, begin_,
                        kept.publish_time, *kept.payload});
      }
    }
    return status;
  }

  Status copy_messages() {
    return for_each(read_options(begin_, end_), [this](const mcap::Message& message) {
      return is_too_early(message) ? Status() : write(message);
    });
  }

  /// Calls `use` for each message; what cannot be read becomes a fault.
  template <class Use>
  Status for_each(const mcap::ReadOptions& options, Use use) {
    const auto stream = reader_.messages(options);
    while (true) {
      const auto next = stream->next();
      if (!next) {
        if (next.error().code == ErrorCode::kIo) {
          return next.error();
        }
        fault(next.error().message);
        continue;
      }
      if (!*next) {
        return {};
      }
      if (Status status = use(**next); !status) {
        return status;
      }
    }
  }

  bool is_too_early(const mcap::Message& message) {
    if (selection_.max_hz <= 0.0 || latched_.keeps(message.channel_id)) {
      return false;
    }
    const auto [due, first] = due_.try_emplace(message.channel_id, message.log_time);
    if (message.log_time < due->second) {
      return true;
    }
    // On a grid, so that the mean rate is met; a gap begins a new one.
    const Duration period = Duration::seconds(1.0 / selection_.max_hz);
    due->second += period;
    if (due->second <= message.log_time) {
      due->second = message.log_time + period;
    }
    return false;
  }

  Status write(mcap::Message message) {
    message.channel_id = channels_.at(message.channel_id);
    if (Status status = writer_.write(message); !status) {
      return status;
    }
    ++report_.messages;
    return {};
  }

  void fault(const std::string& what) {
    const bool known = std::ranges::find(report_.faults, what) != report_.faults.end();
    if (!known && report_.faults.size() < kMaxFaults) {
      report_.faults.push_back(what);
    }
  }

  const RecordingReader& reader_;
  mcap::Writer& writer_;
  const Selection& selection_;
  CopyReport report_;
  std::set<mcap::ChannelId> accepted_;
  std::map<mcap::ChannelId, mcap::ChannelId> channels_;  ///< of the input to the output
  LatchedMessages latched_;
  std::map<mcap::ChannelId, Time> due_;  ///< earliest next message, for max_hz
  Time begin_;
  Time end_ = mcap::ReadOptions().end;
};

}  // namespace

Result<CopyReport> copy_recording(const RecordingReader& reader, mcap::Writer& writer,
                                  const Selection& selection) {
  return Copier(reader, writer, selection).run();
}

Result<CopyReport> run_copy(const CopyJob& job) {
  const auto reader = open_recordings(job.inputs, job.open);
  if (!reader) {
    return reader.error();
  }
  NewFile file(job.output);
  auto sink = file.create();
  if (!sink) {
    return sink.error();
  }
  mcap::WriterOptions options = job.writer;
  options.profile = (*reader)->info().profile;
  auto writer = mcap::Writer::open(std::move(*sink), options);
  if (!writer) {
    return writer.error();
  }
  auto report = copy_recording(**reader, **writer, job.selection);
  if (!report) {
    return report;
  }
  if (Status status = (*writer)->close(); !status) {
    return status.error();
  }
  if (Status status = file.publish(); !status) {
    return status.error();
  }
  return report;
}

}  // namespace furrow::recording
