#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "furrow_actuation/safety_rules.hpp"

namespace furrow::actuation {

/// The latched causes of one tool in a file, so that a restart of its process does not clear them.
/// A dedicated thread writes and syncs: the control loop never waits for a disk. Text, one cause a
/// line between a title and "end", replaced as a whole.
class LatchStore {
 public:
  /// Writes the file once, with what was loaded. Throws ConfigError when it cannot be written.
  explicit LatchStore(std::filesystem::path file);
  /// Waits until everything that was to be kept is written, or its writing failed.
  ~LatchStore();
  LatchStore(const LatchStore&) = delete;
  LatchStore& operator=(const LatchStore&) = delete;

  /// What the file held at construction: nothing when there was none, kLatchesUnknown when it
  /// could not be read or is damaged.
  [[nodiscard]] const CauseSet& loaded() const { return loaded_; }

  /// From now on `latched` is what a restart finds. Returns at once; never called from two threads
  /// at a time.
  void keep(const CauseSet& latched);
  /// Why the newest set is not on the disk; empty while it is, or is just being written.
  [[nodiscard]] std::string failure() const;
  /// The newest set is written and synced.
  [[nodiscard]] bool kept() const;

 private:
  void write_as_told(const std::stop_token& stop);

  std::filesystem::path file_;
  CauseSet loaded_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  CauseSet newest_;  // the members below: under mutex_
  std::optional<CauseSet> on_disk_;
  bool pending_ = false;
  std::string failure_;
  std::jthread writer_;
};

}  // namespace furrow::actuation
