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
#include "furrow_recording/byte_stream.hpp"
#include "furrow_recording/recorder.hpp"
#include "furrow_recording/topic_description.hpp"
#include "furrow_recording/topic_filter.hpp"

namespace furrow::recording {

struct PlayerOptions {
  TopicFilter topics;
  std::map<std::string, std::string> remap;  ///< recorded name to played name
  double rate = 1.0;                         ///< recorded seconds per second
  Duration start_offset;                     ///< from the first message
  std::optional<Duration> duration;          ///< of the recording, from the start offset
  bool loop = false;
  bool start_paused = false;
  /// Of /clock, per recorded second; 0: none. Else a recorded /clock is left out.
  double clock_hz = 0.0;
};

struct PlayedMessage {
  std::size_t topic = 0;  ///< into Player::topics()
  Time log_time;
  Time publish_time;
  bool latched_again = false;  ///< a repetition after a start offset, seek or loop
  Payload payload;
};
/// The recording's time has come to this (for /clock).
struct PlayedClock {
  Time time;
};
/// Nothing before `until`, of the caller's clock; without a value: nothing until it is resumed,
/// stepped or sought.
struct PlayerWait {
  std::optional<Time> until;
};
struct PlayerEnd {};
using PlayerEvent = std::variant<PlayedMessage, PlayedClock, PlayerWait, PlayerEnd>;

/// The logic of playing recordings, on any clock: `now` is an argument, never goes back, and the
/// recording's time follows it at the rate. Not thread-safe.
///
/// Messages come in the order of their log time over all files. A seek, a start offset and a loop
/// first repeat, for each latched topic, what a late joiner at that time would have got.
class Player {
 public:
  /// Files of one recording or several of one clock. kNotFound, kIo, kParse for files; also
  /// kInvalidArgument for options that cannot be met: a rate below 0.001 or above 1000, an offset
  /// outside.
  [[nodiscard]] static Result<Player> open(const std::vector<std::filesystem::path>& files,
                                           const PlayerOptions& options);
  [[nodiscard]] static Result<Player> open(std::vector<std::unique_ptr<mcap::Source>> files,
                                           const PlayerOptions& options);
  Player(Player&&) noexcept;
  Player& operator=(Player&&) noexcept;
  ~Player();

  /// Names as played, after filter and remap. Like topics of several files are one.
  [[nodiscard]] const std::vector<TopicDescription>& topics() const;
  /// As opened, with the rate as it is now.
  [[nodiscard]] const PlayerOptions& options() const;
  /// Of all messages of all files. Equal when there are none.
  [[nodiscard]] Time begin() const;
  [[nodiscard]] Time end() const;

  /// What is to be done at `now`. To be called again at once after a message or clock. After an
  /// error (a damaged chunk) it may be called again and goes on behind it.
  [[nodiscard]] Result<PlayerEvent> next(Time now);
  /// The next message whatever the time is, for runs in lock-step; none at the end. Loops and
  /// pauses are not observed.
  [[nodiscard]] Result<std::optional<PlayedMessage>> next_message();

  void pause(Time now);
  void resume(Time now);
  [[nodiscard]] bool paused() const;
  /// While paused: lets so many messages through at once.
  void step(std::uint64_t messages = 1);
  /// To this time of the recording, clamped to begin() and end() of what is to be played.
  void seek(Time now, Time to);
  /// kInvalidArgument when not between 0.001 and 1000.
  [[nodiscard]] Status set_rate(Time now, double rate);
  /// The recording's time at `now`.
  [[nodiscard]] Time position(Time now) const;
  /// How often it came to the end and began again.
  [[nodiscard]] std::uint64_t loops() const;

 private:
  class Impl;
  explicit Player(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::recording
