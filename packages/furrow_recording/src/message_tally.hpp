#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "records.hpp"

namespace furrow::mcap {

/// Counts and times of some messages.
struct MessageTally {
  Time start;  ///< meaningless without messages, as `end`
  Time end;
  std::uint64_t messages = 0;
  std::map<ChannelId, std::uint64_t> by_channel;

  void add(ChannelId channel, Time time) {
    start = messages == 0 ? time : std::min(start, time);
    end = messages == 0 ? time : std::max(end, time);
    ++messages;
    ++by_channel[channel];
  }
  [[nodiscard]] std::vector<ChannelId> channels() const {
    std::vector<ChannelId> ids;
    for (const auto& [id, count] : by_channel) {
      ids.push_back(id);
    }
    return ids;
  }
};

inline void add_to(Statistics& statistics, const MessageTally& tally) {
  if (tally.messages == 0) {
    return;
  }
  const bool first = statistics.message_count == 0;
  statistics.start_time = first ? tally.start : std::min(statistics.start_time, tally.start);
  statistics.end_time = first ? tally.end : std::max(statistics.end_time, tally.end);
  statistics.message_count += tally.messages;
  for (const auto& [id, count] : tally.by_channel) {
    statistics.channel_message_counts[id] += count;
  }
}

}  // namespace furrow::mcap
