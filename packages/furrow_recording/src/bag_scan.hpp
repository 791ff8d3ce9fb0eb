#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bag_records.hpp"
#include "data_section.hpp"
#include "furrow_core/result.hpp"
#include "furrow_recording/recording_reader.hpp"

namespace furrow::recording {

/// A publisher's topic: what a Connection record says.
struct BagConnection {
  std::string topic;
  std::string type;
  std::string definition;
  std::string publisher;
  bool latching = false;
};
using BagConnections = std::map<std::uint32_t, BagConnection>;  ///< by connection number

/// A part of a bag that unpacks to records: a chunk, or adjacent messages outside of chunks, which
/// a recorder that was killed leaves.
struct BagSpan {
  Time start;                ///< of its first message by time
  Time end;                  ///< of its last
  std::uint64_t offset = 0;  ///< of its record, or of the first message
  std::uint64_t length = 0;
  bool chunk = true;
  std::map<std::uint32_t, std::uint64_t> messages;  ///< by connection
};

struct BagContent {
  BagConnections connections;
  std::vector<BagSpan> spans;  ///< in the order of the file, none without messages
  std::set<std::string> compressions;
  std::uint32_t chunks = 0;
  std::vector<std::string> faults;
  std::string damage;  ///< why the bag is not whole
  std::uint64_t bytes_ignored = 0;
};

/// Passes over the records of a bag. Counts and times come from the index of each chunk. Chunks
/// whose index is missing, or contradicts the chunk infos at the end, are unpacked; with
/// `options.scan` all are. kParse when it is not a bag of version 2.0; kIo.
[[nodiscard]] Result<BagContent> scan_bag(const mcap::Source& source, const OpenOptions& options);

/// Unpacks the records of a chunk. kParse when it is damaged or its compression is not known.
[[nodiscard]] Status unpack_bag_chunk(const mcap::Source& source, const BagPlace& place,
                                      const mcap::ReaderLimits& limits, Bytes& records);

}  // namespace furrow::recording
