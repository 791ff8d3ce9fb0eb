#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_recording/recorder.hpp"

namespace furrow::recording {

/// Records every discovered topic of a domain that the filters accept, of any type. The transport's
/// own writers are left out. Each publisher of a latched topic has its own channel. Of a topic with
/// several types the first type without keys is recorded; skipped() names the others.
class DdsRecorder {
 public:
  /// Records at once, or arms the pre-trigger window. Log times are Unix times of reception.
  /// Throws as Recorder. The transport must outlive it.
  DdsRecorder(dds::DdsTransport& transport, const RecorderParameters& parameters,
              std::filesystem::path stem);
  ~DdsRecorder();

  // Thread-safe, as in RecorderThread.
  void trigger();
  void pause();
  void resume();
  Status stop();
  [[nodiscard]] RecorderStatus status() const;
  /// Topics that are not recorded, each with the reason.
  [[nodiscard]] std::vector<std::string> skipped() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::recording
