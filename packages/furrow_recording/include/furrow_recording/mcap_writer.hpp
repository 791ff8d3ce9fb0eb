#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "furrow_core/result.hpp"
#include "furrow_recording/byte_stream.hpp"
#include "furrow_recording/mcap_types.hpp"

namespace furrow::mcap {

struct WriterOptions {
  std::string profile = "ros2";
  std::string library = "furrow";
  Compression compression = Compression::kZstd;
  int zstd_level = 1;
  std::size_t chunk_bytes = 1u << 20;        ///< a chunk ends when it is at least this large
  std::size_t max_message_bytes = 1u << 28;  ///< larger ones are refused
  /// Threads that compress, with at most two chunks each in memory; 0: the caller's thread does.
  /// The file is the same. Chunks reach the sink later, also after an error of an earlier one.
  std::size_t threads = 0;
};

/// Writes one MCAP file. Each full chunk goes to the sink at once, with its message indexes. So a
/// file that is never closed can be read up to its last chunk. Holds one chunk, and about 100 bytes
/// for each chunk written. Not thread-safe.
///
/// When the sink refuses (a full disk), the file is cut back to its last whole record and the call
/// returns kIo. Later writes return the same; close() still tries to write the summary. The
/// messages of the chunk that could not be written are counted in lost_messages().
class Writer {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Writer>> open(std::unique_ptr<Sink> sink,
                                                            const WriterOptions& options = {});
  /// Closes a file that is still open. Call close() to learn of errors.
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// The id of a schema; the same content has the same id. kOutOfRange above 65535 schemas.
  [[nodiscard]] Result<SchemaId> add_schema(std::string_view name, std::string_view encoding,
                                            std::string_view data);
  /// Returns the new channel's id; `channel.id` is ignored. kInvalidArgument for an unknown schema.
  [[nodiscard]] Result<ChannelId> add_channel(Channel channel);

  /// Copies the message into the current chunk. kInvalidArgument for an unknown channel, a
  /// negative time or a closed file; kOutOfRange for too large a message.
  [[nodiscard]] Status write(const Message& message);
  [[nodiscard]] Status write(const Attachment& attachment);
  [[nodiscard]] Status write(const Metadata& metadata);

  /// Ends the current chunk and writes it to the sink.
  [[nodiscard]] Status flush();
  /// Flushes and writes the summary: the file is whole. Further calls do nothing.
  [[nodiscard]] Status close();

  /// Of the file so far, without the chunk in memory.
  [[nodiscard]] std::uint64_t bytes_written() const;
  /// Bytes of messages in memory.
  [[nodiscard]] std::size_t bytes_pending() const;
  [[nodiscard]] std::uint64_t lost_messages() const;
  /// Of all messages that were written and not lost, also of those in memory.
  [[nodiscard]] Statistics statistics() const;

 private:
  class Impl;
  explicit Writer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::mcap
