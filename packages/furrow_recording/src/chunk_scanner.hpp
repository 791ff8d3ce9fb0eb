#pragma once

#include <map>
#include <optional>
#include <vector>

#include "data_section.hpp"
#include "definitions.hpp"
#include "message_tally.hpp"
#include "record_source.hpp"

namespace furrow::mcap {

/// Finds out what the chunks of a data section hold, for scan_data_section().
class ChunkScanner {
 public:
  /// The references must outlive the scanner.
  ChunkScanner(Definitions& definitions, Faults& faults, const ReaderLimits& limits,
               ScanDepth depth)
      : definitions_(definitions),
        faults_(faults),
        limits_(limits),
        contents_(depth == ScanDepth::kContents) {}

  /// Takes a Chunk record. `content` is all of it with kContents, else at least its fields.
  void begin(const RecordPlace& place, ByteView content);
  /// Takes a MessageIndex record behind it.
  void add_index(const RecordPlace& place, ByteView content);
  /// Adds the chunk to `found`. It is unpacked from `source` when its indexes do not describe it.
  [[nodiscard]] Status finish(const Source& source, DataSection& found);

 private:
  struct OpenChunk {
    RecordPlace place;
    ChunkHead head;
    ChunkIndex index;
    bool unpacked = false;
    MessageTally tally;  ///< of its messages when unpacked, else of its message indexes
    std::map<ChannelId, std::vector<IndexEntry>> entries;  ///< of its messages, for kContents
  };

  bool unpack(OpenChunk& chunk, ByteView content);
  void take_message(OpenChunk& chunk, ByteView content, std::size_t offset);
  [[nodiscard]] bool is_described(const OpenChunk& chunk) const;
  void check(const OpenChunk& chunk);

  Definitions& definitions_;
  Faults& faults_;
  const ReaderLimits& limits_;
  const bool contents_;
  std::optional<OpenChunk> chunk_;  ///< whose message indexes are being read
  Bytes content_;
  Bytes records_;
};

}  // namespace furrow::mcap
