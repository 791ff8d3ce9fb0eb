#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_recording/payload.hpp"
#include "furrow_recording/topic_description.hpp"

namespace furrow::recording {

/// A message that owns its data.
struct KeptMessage {
  std::size_t channel = 0;
  std::uint32_t sequence = 0;
  Time log_time;
  Time publish_time;
  Payload payload;
};

/// Keeps the messages that a late joiner of latched (TRANSIENT_LOCAL) topics would get: of each
/// channel the last ones, as many as its publishers keep together. Transforms of tf_static are kept
/// by content instead: a message stays until each of its child frames has a later transform, since
/// several publishers share that topic.
class LatchedMessages {
 public:
  /// Declares a channel of this topic. Messages of topics that are not latched are never kept.
  void add_channel(std::size_t channel, const TopicDescription& topic);
  [[nodiscard]] bool keeps(std::size_t channel) const { return channels_.contains(channel); }

  /// @pre add_channel() of its channel. Messages that keeps() refuses are let go.
  void add(KeptMessage message);
  /// The messages kept, in the order of log time, and forgets them.
  [[nodiscard]] std::vector<KeptMessage> take();

 private:
  struct Channel {
    std::string topic;
    std::size_t depth = 1;
    bool static_transforms = false;
  };
  struct TransformMessage {
    KeptMessage message;
    std::vector<std::string> children;  ///< frames without a later transform
  };
  void add_transforms(const Channel& channel, KeptMessage message,
                      std::vector<std::string> children);

  std::map<std::size_t, Channel> channels_;
  std::map<std::size_t, std::deque<KeptMessage>> last_;             ///< by channel
  std::map<std::string, std::deque<TransformMessage>> transforms_;  ///< by topic
};

}  // namespace furrow::recording
