#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_recording/recorder.hpp"

namespace furrow::recording {

/// Records every topic of a domain that the filters accept, of any type, as it is discovered; the
/// transport's own writers are left out. Topics with keys, or with several types, are recorded by
/// the first type without keys, or not at all, and then named in skipped().
class DdsRecorder {
 public:
  /// Begins at once, or arms when there is a pre-trigger window. Log times are Unix times of
  /// reception. Throws as Recorder. The transport must outlive it.
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
