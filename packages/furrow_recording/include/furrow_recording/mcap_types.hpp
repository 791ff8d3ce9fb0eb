#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "furrow_core/time.hpp"

/// The MCAP container (specification version 0, mcap.dev/spec): timestamped messages of any
/// encoding, in compressed and checked chunks, with an index at the end. Times are nanoseconds on
/// any clock; log times are never negative. CRCs are CRC-32 (ISO 3309, as in zlib).
namespace furrow::mcap {

using SchemaId = std::uint16_t;   ///< 0: none
using ChannelId = std::uint16_t;  ///< unique within a file
using StringMap = std::map<std::string, std::string>;

enum class Compression : std::uint8_t { kNone, kLz4, kZstd };

struct Header {
  std::string profile;
  std::string library;
};

struct Schema {
  SchemaId id = 0;
  std::string name;
  std::string encoding;  ///< "omgidl", "ros2msg", ...; empty: none is known
  std::string data;
};

struct Channel {
  ChannelId id = 0;
  SchemaId schema_id = 0;
  std::string topic;
  std::string message_encoding;  ///< "cdr"
  StringMap metadata;
};

/// A view: its source says how long `data` live.
struct Message {
  ChannelId channel_id = 0;
  std::uint32_t sequence = 0;
  Time log_time;      ///< when it was recorded; files are ordered by it
  Time publish_time;  ///< when it was sent
  std::span<const std::byte> data;
};

struct Attachment {
  Time log_time;
  Time create_time;
  std::string name;
  std::string media_type;
  std::vector<std::byte> data;
};

struct Metadata {
  std::string name;
  StringMap values;
};

/// The place and content of a chunk. Offsets count from the start of the file.
struct ChunkIndex {
  Time start_time;
  Time end_time;  ///< included
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::map<ChannelId, std::uint64_t> message_index_offsets;  ///< empty: not indexed
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};

struct AttachmentIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  Time log_time;
  Time create_time;
  std::uint64_t data_size = 0;
  std::string name;
  std::string media_type;
};

struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string name;
};

struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  Time start_time;  ///< zero in a file without messages
  Time end_time;    ///< included
  std::map<ChannelId, std::uint64_t> channel_message_counts;
};

/// The content of a file: as its end says it, or as it was found.
struct Summary {
  std::map<SchemaId, Schema> schemas;
  std::map<ChannelId, Channel> channels;
  std::vector<ChunkIndex> chunks;
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  std::optional<Statistics> statistics;
};

}  // namespace furrow::mcap
