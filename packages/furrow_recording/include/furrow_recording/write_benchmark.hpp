#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::recording {

struct WriteBenchmarkOptions {
  std::uint64_t megabytes = 1000;           ///< 1e6 bytes, per run
  std::uint64_t message_bytes = 3'700'000;  ///< an image of 1280 x 960, three bytes a pixel
  int runs = 3;                             ///< of each, in turns
};

/// One run; "on the disk" means that the data are synced.
struct WriteBenchmarkRun {
  double recorder_mbps = 0.0;  ///< recorder with its thread and queue, no compression
  double dd_mbps = 0.0;        ///< `dd if=/dev/zero bs=1M conv=fdatasync`
  std::uint64_t dropped = 0;
};

/// Measures sustained writing in `folder`, whose files it removes again. kUnavailable without dd,
/// kIo when the disk refuses.
[[nodiscard]] Result<std::vector<WriteBenchmarkRun>> benchmark_writing(
    const std::filesystem::path& folder, const WriteBenchmarkOptions& options);

}  // namespace furrow::recording
