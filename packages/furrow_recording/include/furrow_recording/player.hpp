#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"
#include "furrow_recording/payload.hpp"
#include "furrow_recording/recording_reader.hpp"
#include "furrow_recording/topic_description.hpp"
#include "furrow_recording/topic_filter.hpp"

namespace furrow::recording {

struct PlayerOptions {
  TopicFilter topics;
  std::map<std::string, std::string> remap;  ///< recorded name to played name
  double rate = 1.0;                         ///< recorded seconds per second
  Duration start_offset;                     ///< from the first message
  std::optional<Duration> duration;          ///< of the recording, from the start offset
  /// Begin again at the end: at once, or once a second (at rate 1) when the played part takes less
  /// than 10 ms, as a single message does.
  bool loop = false;
  bool start_paused = false;
  /// Rate of /clock, per recorded second; 0: none. Otherwise a recorded /clock is left out.
  double clock_hz = 0.0;
};

struct PlayedMessage {
  std::size_t topic = 0;  ///< into Player::topics()
  Time log_time;
  Time publish_time;
  bool latched_again = false;  ///< a repetition after a start offset, seek or loop
  Payload payload;
};
/// The recording's time has reached this (for /clock).
struct PlayedClock {
  Time time;
};
/// Nothing is due before `until`, of the caller's clock. Without a value: nothing is due until
/// resume, step or seek.
struct PlayerWait {
  std::optional<Time> until;
};
struct PlayerEnd {};
using PlayerEvent = std::variant<PlayedMessage, PlayedClock, PlayerWait, PlayerEnd>;

/// A topic that the options ask for and that cannot be played.
struct UnplayableTopic {
  std::string name;
  std::string reason;  ///< its message encoding, or an unknown type
  std::uint64_t messages = 0;
};

/// The logic of playing a recording, on any clock: `now` is an argument, never goes back, and the
/// recording's time follows it at the rate. Not thread-safe.
///
/// Messages come in the order of their log time. A seek, a start offset and a loop first repeat,
/// for each latched topic, what a late joiner at that time would have got.
class Player {
 public:
  /// Plays one recording, or several of one clock. Fails as open_recordings(), and with
  /// kInvalidArgument for options that cannot be met: a rate outside of 0.001 to 1000, an offset
  /// outside of the recording.
  [[nodiscard]] static Result<Player> open(const std::vector<std::filesystem::path>& files,
                                           const PlayerOptions& options);
  [[nodiscard]] static Result<Player> open(std::unique_ptr<RecordingReader> recording,
                                           const PlayerOptions& options);
  Player(Player&&) noexcept;
  Player& operator=(Player&&) noexcept;
  ~Player();

  /// The played topics, after filter and remap. Channels of one topic and type are one topic.
  [[nodiscard]] const std::vector<TopicDescription>& topics() const;
  /// Topics that pass the filter and are not played, because only CDR of known types can be.
  [[nodiscard]] const std::vector<UnplayableTopic>& unplayable() const;
  /// Include patterns that match no topic of the recording.
  [[nodiscard]] const std::vector<std::string>& unmatched_patterns() const;
  /// The recording's content and damage.
  [[nodiscard]] const RecordingInfo& recording() const;
  /// As opened, with the current rate.
  [[nodiscard]] const PlayerOptions& options() const;
  /// Of all messages of the recording. Equal when there are none.
  [[nodiscard]] Time begin() const;
  [[nodiscard]] Time end() const;

  /// The event due at `now`. Call again at once after a message or clock. After an error (a damaged
  /// chunk) a further call goes on behind it.
  [[nodiscard]] Result<PlayerEvent> next(Time now);
  /// The next message whatever the time, for runs in lock-step; none at the end. Loops and pauses
  /// are not observed.
  [[nodiscard]] Result<std::optional<PlayedMessage>> next_message();

  void pause(Time now);
  void resume(Time now);
  [[nodiscard]] bool paused() const;
  /// While paused: plays so many messages at once.
  void step(std::uint64_t messages = 1);
  /// Goes to this time of the recording, clamped to what is played.
  void seek(Time now, Time to);
  /// kInvalidArgument outside of 0.001 to 1000.
  [[nodiscard]] Status set_rate(Time now, double rate);
  /// The recording's time at `now`.
  [[nodiscard]] Time position(Time now) const;
  /// How often the end was reached and playing began again.
  [[nodiscard]] std::uint64_t loops() const;

 private:
  class Impl;
  explicit Player(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::recording
