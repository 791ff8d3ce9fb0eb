#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "furrow_recording/latched_messages.hpp"
#include "furrow_recording/player.hpp"

namespace furrow::recording {

/// The messages that a player plays, in their order, from any time on.
class PlaybackSource {
 public:
  /// kInvalidArgument when the options name a range outside of the recording.
  [[nodiscard]] static Result<std::unique_ptr<PlaybackSource>> open(
      std::unique_ptr<RecordingReader> recording, const PlayerOptions& options);
  explicit PlaybackSource(std::unique_ptr<RecordingReader> recording)
      : recording_(std::move(recording)) {}

  [[nodiscard]] const std::vector<TopicDescription>& topics() const { return topics_; }
  [[nodiscard]] const std::vector<UnplayableTopic>& unplayable() const { return unplayable_; }
  [[nodiscard]] const std::vector<std::string>& unmatched() const { return unmatched_; }
  [[nodiscard]] const RecordingInfo& recording() const { return recording_->info(); }
  /// Of what is played.
  [[nodiscard]] Time begin() const { return begin_; }
  [[nodiscard]] Time end() const { return end_; }

  /// Goes on at `time`, after the latched messages that hold there.
  [[nodiscard]] Status go_to(Time time);
  /// The next message, null at the end. Repetitions of latched messages come first. After an error
  /// other than kIo the next call goes on behind it.
  [[nodiscard]] Result<const PlayedMessage*> peek();
  /// @pre peek() returned a message.
  [[nodiscard]] PlayedMessage pop();

 private:
  [[nodiscard]] Status set_range(const PlayerOptions& options);
  void add_channels(const PlayerOptions& options);
  void add_channel(const mcap::Channel& channel, TopicDescription topic,
                   const PlayerOptions& options);
  void add_unplayable(const std::string& name, const std::string& reason, mcap::ChannelId channel);
  std::size_t add_topic(const TopicDescription& topic);
  [[nodiscard]] Status find_latched(Time before);

  std::unique_ptr<RecordingReader> recording_;
  std::vector<TopicDescription> topics_;
  std::vector<UnplayableTopic> unplayable_;
  std::vector<std::string> unmatched_;
  std::map<mcap::ChannelId, std::size_t> topic_of_channel_;  ///< of channels that are played
  LatchedMessages latched_;
  Time begin_;
  Time end_;
  bool end_included_ = true;
  std::unique_ptr<MessageStream> stream_;
  std::deque<PlayedMessage> repeated_;
  std::optional<PlayedMessage> head_;
};

}  // namespace furrow::recording
