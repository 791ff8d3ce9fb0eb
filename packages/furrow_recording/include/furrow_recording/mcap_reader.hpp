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

enum class ScanDepth : std::uint8_t;

/// Bounds of the memory that a file can take. Lengths in a file are never trusted: memory is taken
/// for bytes that are there.
struct ReaderLimits {
  std::uint64_t record_bytes = 1u << 29;  ///< one record, and one chunk unpacked; else kOutOfRange
  /// Unpacked chunks that overlap in time. Above it chunks are unpacked again when their next
  /// message is due: slower, with the same messages.
  std::uint64_t open_bytes = 1u << 27;
};

struct ReadOptions {
  Time begin;                                                                   ///< included
  Time end = Time::from_nanoseconds(std::numeric_limits<std::int64_t>::max());  ///< excluded
  std::function<bool(const Channel&)> accept;  ///< empty: every channel
  bool check_crcs = true;
};

/// Messages in the order of their log time. Messages of equal time come in the order of the file.
class MessageCursor {
 public:
  MessageCursor(MessageCursor&&) noexcept;
  MessageCursor& operator=(MessageCursor&&) noexcept;
  ~MessageCursor();
  /// The next message, or none at the end. Its data live until the next call. After an error (a
  /// damaged chunk) reading may go on: only what could not be read is left out.
  [[nodiscard]] Result<std::optional<Message>> next();

 private:
  friend class Reader;
  class Impl;
  explicit MessageCursor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads one MCAP file. Nothing that is optional in a file is trusted or needed: opening passes
/// over the headers of all records, and unpacks the chunks that their message indexes do not
/// describe. A file without its end (a killed recorder, a full disk) is read up to its last whole
/// record.
class Reader {
 public:
  /// kParse when it is not an MCAP file. A damaged or missing end is told by damage().
  [[nodiscard]] static Result<Reader> open(std::unique_ptr<Source> source,
                                           const ReaderLimits& limits = {});
  /// As open(), and reads and checks every byte.
  [[nodiscard]] static Result<Reader> scan(std::unique_ptr<Source> source,
                                           const ReaderLimits& limits = {});
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;
  ~Reader();

  [[nodiscard]] const Header& header() const;
  /// As counted in the file, not as its own summary says. `statistics` is always set.
  [[nodiscard]] const Summary& summary() const;
  /// Null when there is none.
  [[nodiscard]] const Channel* channel(ChannelId id) const;
  /// Why the file is not whole; empty when it is.
  [[nodiscard]] const std::string& damage() const;
  /// Bytes at the end that belong to no whole record.
  [[nodiscard]] std::uint64_t bytes_ignored() const;
  /// What was found damaged and left out at opening. At most a hundred.
  [[nodiscard]] const std::vector<std::string>& faults() const;

  /// The cursor must not outlive the reader.
  [[nodiscard]] MessageCursor messages(ReadOptions options = {}) const;
  [[nodiscard]] Result<Attachment> attachment(const AttachmentIndex& index) const;
  [[nodiscard]] Result<Metadata> metadata(const MetadataIndex& index) const;

 private:
  friend class MessageCursor;
  class Impl;
  [[nodiscard]] static Result<Reader> open(std::unique_ptr<Source> source,
                                           const ReaderLimits& limits, ScanDepth depth);
  explicit Reader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::mcap
