#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_recording/byte_stream.hpp"
#include "furrow_recording/mcap_types.hpp"

namespace furrow::mcap {

/// What a file may ask of this process; beyond it, kOutOfRange. No length from a file is trusted:
/// memory is taken for bytes that are there.
struct ReaderLimits {
  std::uint64_t record_bytes = 1u << 29;  ///< one record, and one chunk when unpacked
  std::uint64_t open_bytes = 1u << 30;    ///< unpacked chunks that overlap in time
};

struct ReadOptions {
  Time begin;                                                                   ///< included
  Time end = Time::from_nanoseconds(std::numeric_limits<std::int64_t>::max());  ///< excluded
  std::function<bool(const Channel&)> accept;  ///< empty: every channel
  bool check_crcs = true;
};

/// Messages in the order of their log time; those of equal time in the order of the file.
class MessageCursor {
 public:
  MessageCursor(MessageCursor&&) noexcept;
  MessageCursor& operator=(MessageCursor&&) noexcept;
  ~MessageCursor();
  /// The next message, or none at the end. Its data live until the next call. After an error (a
  /// damaged chunk) the chunk is left out and reading may go on.
  [[nodiscard]] Result<std::optional<Message>> next();

 private:
  friend class Reader;
  class Impl;
  explicit MessageCursor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads one MCAP file by its summary; where there is none (a recorder that was killed, a file cut
/// short) the whole file is gone through once at opening, up to the last whole record.
class Reader {
 public:
  /// kParse when it is no MCAP file or its summary is damaged.
  [[nodiscard]] static Result<Reader> open(std::unique_ptr<Source> source,
                                           const ReaderLimits& limits = {});
  /// Goes through the file in any case, and leaves damaged chunks out: for a damaged summary.
  [[nodiscard]] static Result<Reader> scan(std::unique_ptr<Source> source,
                                           const ReaderLimits& limits = {});
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;
  ~Reader();

  [[nodiscard]] const Header& header() const;
  /// `statistics` is always set.
  [[nodiscard]] const Summary& summary() const;
  /// Null when there is none.
  [[nodiscard]] const Channel* channel(ChannelId id) const;
  /// Why the file had to be gone through; empty when it was read by its summary.
  [[nodiscard]] const std::string& damage() const;
  /// Bytes at the end that belong to no whole record.
  [[nodiscard]] std::uint64_t bytes_ignored() const;
  /// What was damaged and left out when the file was gone through; at most a hundred.
  [[nodiscard]] const std::vector<std::string>& faults() const;

  /// The cursor must not outlive the reader.
  [[nodiscard]] MessageCursor messages(ReadOptions options = {}) const;
  [[nodiscard]] Result<Attachment> attachment(const AttachmentIndex& index) const;
  [[nodiscard]] Result<Metadata> metadata(const MetadataIndex& index) const;

 private:
  friend class MessageCursor;
  class Impl;
  explicit Reader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::mcap
