#pragma once

#include <cstdint>
#include <vector>

#include "compression.hpp"
#include "file_appender.hpp"
#include "furrow_core/result.hpp"
#include "furrow_recording/mcap_types.hpp"
#include "message_tally.hpp"
#include "records.hpp"

namespace furrow::mcap {

/// The messages of one chunk, not compressed yet.
struct ChunkContent {
  Bytes records;
  std::vector<std::vector<IndexEntry>> entries;  ///< by channel
  MessageTally tally;

  /// Appends the head of a message; its data follow in `records`.
  void add_head(const Message& message);
  void add_data(ByteView data) { records.insert(records.end(), data.begin(), data.end()); }
  /// Keeps the memory.
  void clear();
};

/// A chunk's records compressed, with their CRCs.
struct PackedChunk {
  ByteView records;  ///< of the packer or of the content, which must live on
  std::uint32_t packed_crc = 0;
  std::uint32_t unpacked_crc = 0;
};

/// Compresses the records of a chunk.
[[nodiscard]] Result<PackedChunk> pack_chunk(Packer& packer, Compression compression,
                                             const ChunkContent& content);

/// Appends the chunk and its message indexes to the file and returns its index entry. `tail`: data
/// of the last message that are not in the content, written without a copy; only without
/// compression.
[[nodiscard]] Result<ChunkIndex> append_chunk(FileAppender& file, const ChunkContent& content,
                                              const PackedChunk& packed, Compression compression,
                                              ByteView tail = {});

}  // namespace furrow::mcap
