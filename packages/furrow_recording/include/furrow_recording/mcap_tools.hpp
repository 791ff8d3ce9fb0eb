#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_recording/mcap_reader.hpp"
#include "furrow_recording/mcap_writer.hpp"

namespace furrow::mcap {

struct VerifyReport {
  std::uint64_t messages = 0;
  std::uint64_t chunks = 0;
  std::uint64_t bytes = 0;
  bool closed = false;  ///< the file has its end
  /// At most a hundred, each with its offset; empty when the file is sound.
  std::vector<std::string> faults;
};

/// Goes through every byte: structure, CRCs of chunks, data section, attachments and summary, and
/// whether indexes and statistics say what is there. Faults of the file are in the report; an Error
/// is only for a source that cannot be read.
[[nodiscard]] Result<VerifyReport> verify(const Source& source, const ReaderLimits& limits = {});

struct CopyReport {
  std::uint64_t messages = 0;
  std::uint64_t bytes_ignored = 0;       ///< of the input's end
  std::vector<std::string> faults = {};  ///< what was left out and why; at most a hundred
};

/// Writes a whole file from all that can be read of a damaged one.
[[nodiscard]] Result<CopyReport> recover(std::unique_ptr<Source> source, std::unique_ptr<Sink> sink,
                                         const WriterOptions& writer = {},
                                         const ReaderLimits& limits = {});

struct CutOptions {
  ReadOptions read;
  /// Channels whose last message before `read.begin` still holds there; it is put at the beginning,
  /// with `begin` as its log time. Empty: none.
  std::function<bool(const Channel&)> latched;
};

/// Copies a time range and some channels. Metadata records go along, attachments of the range too.
[[nodiscard]] Result<CopyReport> cut(std::unique_ptr<Source> source, std::unique_ptr<Sink> sink,
                                     const CutOptions& options, const WriterOptions& writer = {},
                                     const ReaderLimits& limits = {});

}  // namespace furrow::mcap
