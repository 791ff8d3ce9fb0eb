#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <queue>
#include <vector>

#include "bytes.hpp"
#include "furrow_core/result.hpp"

namespace furrow::mcap {

/// One message in the records of an unpacked chunk.
struct ChunkEntry {
  Time time;
  std::uint32_t offset = 0;
  std::uint32_t bytes = 0;
};

/// Merges the messages of chunks that overlap in time, in the order of time, then of the chunks'
/// numbers, then of the file. Holds at most about `max_open_bytes` of unpacked chunks, but always
/// one: above it, chunks are unpacked again when their next message is due.
class ChunkMerger {
 public:
  struct Chunk {
    Time start;              ///< of its first message
    std::size_t number = 0;  ///< the caller's
  };
  /// Unpacks a chunk into `records`, whose memory is reused, and appends its wanted messages to
  /// `entries`, which is null when the chunk is unpacked again. An error may leave entries of what
  /// could be read.
  using Load =
      std::function<Status(std::size_t number, Bytes& records, std::vector<ChunkEntry>* entries)>;

  ChunkMerger(std::vector<Chunk> chunks, Load load, std::uint64_t max_open_bytes);

  struct Item {
    std::size_t chunk = 0;  ///< its number
    Time time;
    ByteView record;  ///< lives until the next call
  };
  /// The next message, or none at the end. After an error the next call goes on with what could be
  /// read.
  [[nodiscard]] Result<std::optional<Item>> next();

 private:
  /// An unpacked chunk whose messages are being handed out.
  struct Open {
    Bytes records;  ///< empty while it is packed again
    std::vector<ChunkEntry> entries;
    std::size_t next = 0;
  };
  struct Head {
    Time time;
    std::size_t chunk = 0;
    bool operator>(const Head& other) const {
      return time != other.time ? time > other.time : chunk > other.chunk;
    }
  };

  [[nodiscard]] Status open(std::size_t chunk);
  [[nodiscard]] Status reload(std::size_t chunk, Open& open);
  void advance_last();
  void keep_within_limit(std::size_t except);
  void take_records(Open& open);

  std::vector<Chunk> waiting_;  ///< the next one last
  Load load_;
  std::uint64_t max_open_bytes_;
  std::map<std::size_t, Open> open_;
  std::priority_queue<Head, std::vector<Head>, std::greater<>> heads_;
  std::optional<std::size_t> last_;  ///< chunk of the message that was handed out last
  std::uint64_t open_bytes_ = 0;
  Bytes spare_;  ///< memory of a closed chunk
};

}  // namespace furrow::mcap
