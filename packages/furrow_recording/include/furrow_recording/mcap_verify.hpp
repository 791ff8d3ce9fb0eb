#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_recording/mcap_reader.hpp"

namespace furrow::mcap {

struct VerifyReport {
  std::uint64_t messages = 0;
  std::uint64_t chunks = 0;
  std::uint64_t bytes = 0;
  bool closed = false;  ///< the file has its end
  /// At most a hundred, each with its offset; empty when the file is sound.
  std::vector<std::string> faults;
};

/// Reads every byte: structure, CRCs of chunks, data section, attachments and summary, and whether
/// indexes and statistics match the content. What a file may leave out is not a fault. Faults of
/// the file are in the report; an Error means that the source could not be read.
[[nodiscard]] Result<VerifyReport> verify(const Source& source, const ReaderLimits& limits = {});

}  // namespace furrow::mcap
