#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_recording/mcap_verify.hpp"
#include "furrow_recording/recording_reader.hpp"

namespace furrow::recording {

/// A topic of a recording: its channels of one type together.
struct TopicSummary {
  std::string topic;
  std::string type;
  std::uint64_t messages = 0;
  double rate_hz = 0.0;  ///< over the length of the recording; 0 when that has none
  std::string schema;    ///< encoding of the type's text; empty: not known
  std::string encoding;  ///< of its messages
  std::string quality;   ///< "reliable, latched"; "-": not known
  std::uint64_t channels = 1;
};

/// The topics, in the order of their first channel.
[[nodiscard]] std::vector<TopicSummary> summarize_topics(const RecordingInfo& info);

/// Reads every byte of a recording of any format, and each of its messages: MCAP as mcap::verify(),
/// .bag chunks against their indexes, .db3 with SQLite's integrity check. Errors as
/// open_recording(), but a damaged file is told in the report.
[[nodiscard]] Result<mcap::VerifyReport> verify_recording(const std::filesystem::path& path);

}  // namespace furrow::recording
