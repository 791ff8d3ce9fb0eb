#include "playback_source.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace furrow::recording {
namespace {

constexpr std::string_view kPlayedEncoding = "cdr";

Payload copy_of(std::span<const std::byte> data) {
  return std::make_shared<const std::vector<std::byte>>(data.begin(), data.end());
}

/// "planner/plan" for "/planner/plan"; names outside of ROS keep their "//".
std::string graph_name(const std::string& name) {
  return name.starts_with('/') && !name.starts_with("//") ? name.substr(1) : name;
}

}  // namespace

Result<std::unique_ptr<PlaybackSource>> PlaybackSource::open(
    std::unique_ptr<RecordingReader> recording, const PlayerOptions& options) {
  auto source = std::make_unique<PlaybackSource>(std::move(recording));
  source->add_channels(options);
  if (Status status = source->set_range(options); !status) {
    return status.error();
  }
  return source;
}

Status PlaybackSource::set_range(const PlayerOptions& options) {
  const mcap::Statistics& statistics = recording().statistics();
  const Duration length = statistics.end_time - statistics.start_time;
  if (options.start_offset < Duration() || options.start_offset > length) {
    return Error{ErrorCode::kInvalidArgument, "the start offset lies outside of the recording"};
  }
  if (options.duration && *options.duration < Duration()) {
    return Error{ErrorCode::kInvalidArgument, "the duration is negative"};
  }
  begin_ = statistics.start_time + options.start_offset;
  end_included_ = !options.duration || *options.duration >= length - options.start_offset;
  end_ = end_included_ ? statistics.end_time : begin_ + *options.duration;
  return {};
}

void PlaybackSource::add_channels(const PlayerOptions& options) {
  const mcap::Summary& summary = recording().summary;
  std::vector<std::string> names;
  for (const auto& [id, channel] : summary.channels) {
    const auto schema = summary.schemas.find(channel.schema_id);
    TopicDescription topic =
        describe_channel(channel, schema == summary.schemas.end() ? nullptr : &schema->second);
    names.push_back(topic.name);
    const bool made_here = options.clock_hz > 0.0 && topic.name == "clock";
    if (!made_here && options.topics.accepts(topic.name)) {
      add_channel(channel, std::move(topic), options);
    }
  }
  unmatched_ = unmatched_patterns(options.topics.include, names);
}

void PlaybackSource::add_channel(const mcap::Channel& channel, TopicDescription topic,
                                 const PlayerOptions& options) {
  if (topic.message_encoding != kPlayedEncoding) {
    add_unplayable(topic.name, "its message encoding is '" + topic.message_encoding + "', not CDR",
                   channel.id);
    return;
  }
  if (topic.type_name.empty()) {
    add_unplayable(topic.name, "its message type is not known", channel.id);
    return;
  }
  for (const auto& [from, to] : options.remap) {
    if (topic_in_file(topic.name) == from || topic.name == from) {
      topic.name = graph_name(to);
      break;
    }
  }
  topic_of_channel_[channel.id] = add_topic(topic);
  latched_.add_channel(channel.id, topic);
}

void PlaybackSource::add_unplayable(const std::string& name, const std::string& reason,
                                    mcap::ChannelId channel) {
  const auto& counts = recording().statistics().channel_message_counts;
  const auto count = counts.find(channel);
  const std::uint64_t messages = count == counts.end() ? 0 : count->second;
  const auto known = std::ranges::find_if(unplayable_, [&](const UnplayableTopic& topic) {
    return topic.name == name && topic.reason == reason;
  });
  if (known != unplayable_.end()) {
    known->messages += messages;
  } else {
    unplayable_.push_back({name, reason, messages});
  }
}

std::size_t PlaybackSource::add_topic(const TopicDescription& topic) {
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    if (topics_[i].name == topic.name && topics_[i].type_name == topic.type_name) {
      // One writer stands for the publishers of all channels.
      auto& offered = topics_[i].offered_qos;
      offered.insert(offered.end(), topic.offered_qos.begin(), topic.offered_qos.end());
      return i;
    }
  }
  topics_.push_back(topic);
  topics_.back().publisher.clear();
  return topics_.size() - 1;
}

Status PlaybackSource::go_to(Time time) {
  head_.reset();
  repeated_.clear();
  mcap::ReadOptions options;
  options.begin = time;
  if (!end_included_) {
    options.end = end_;
  }
  options.accept = [this](const mcap::Channel& channel) {
    return topic_of_channel_.contains(channel.id);
  };
  stream_ = recording_->messages(options);
  return find_latched(time);
}

Status PlaybackSource::find_latched(Time before) {
  mcap::ReadOptions options;
  options.end = before;
  options.accept = [this](const mcap::Channel& channel) { return latched_.keeps(channel.id); };
  const auto stream = recording_->messages(options);
  while (true) {
    const auto next = stream->next();
    if (!next && next.error().code == ErrorCode::kIo) {
      return next.error();
    }
    if (!next) {
      continue;  // damage is reported when it is played
    }
    if (!*next) {
      break;
    }
    const mcap::Message& message = **next;
    latched_.add({message.channel_id, message.sequence, message.log_time, message.publish_time,
                  copy_of(message.data)});
  }
  for (KeptMessage& kept : latched_.take()) {
    const auto channel = static_cast<mcap::ChannelId>(kept.channel);
    repeated_.push_back({topic_of_channel_.at(channel), kept.log_time, kept.publish_time, true,
                         std::move(kept.payload)});
  }
  return {};
}

Result<const PlayedMessage*> PlaybackSource::peek() {
  if (!repeated_.empty()) {
    return &repeated_.front();
  }
  if (!head_) {
    const auto next = stream_->next();
    if (!next) {
      return next.error();
    }
    if (*next) {
      const mcap::Message& message = **next;
      head_ = {topic_of_channel_.at(message.channel_id), message.log_time, message.publish_time,
               false, copy_of(message.data)};
    }
  }
  return head_ ? &*head_ : nullptr;
}

PlayedMessage PlaybackSource::pop() {
  if (!repeated_.empty()) {
    PlayedMessage message = std::move(repeated_.front());
    repeated_.pop_front();
    return message;
  }
  PlayedMessage message = std::move(*head_);
  head_.reset();
  return message;
}

}  // namespace furrow::recording
