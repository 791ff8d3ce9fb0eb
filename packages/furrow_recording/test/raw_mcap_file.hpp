#pragma once

#include <optional>
#include <vector>

#include "mcap_test_support.hpp"
#include "records.hpp"
#include "summary_section.hpp"

namespace furrow::mcap {

/// Builds MCAP files record by record, as writers other than ours do: with any chunk times, and
/// with any part of the summary left out or wrong.
class RawMcapFile {
 public:
  RawMcapFile() {
    bytes.assign(kMagic.begin(), kMagic.end());
    ByteWriter out(bytes);
    put(out, Header{"ros2", "test"});
  }

  /// Schema 1 and channel 1 on /chatter, in `records` or in the data section.
  void define(Bytes* records = nullptr) {
    summary.schemas[1] = {1, "std_msgs/msg/String", "ros2msg", "string data"};
    summary.channels[1] = {1, 1, "/chatter", "cdr", {}};
    ByteWriter out(records == nullptr ? bytes : *records);
    put(out, summary.schemas[1]);
    put(out, summary.channels[1]);
  }

  static void add_message(Bytes& records, std::int64_t time_ns, std::string_view data,
                          ChannelId channel = 1) {
    const Bytes content = bytes_of(data);
    ByteWriter out(records);
    put_head(out, {channel, 0, at_ns(time_ns), at_ns(time_ns), content});
    out.raw(content);
  }

  /// A chunk of records with these times, and the message indexes given.
  void add_chunk(const Bytes& records, std::uint64_t start, std::uint64_t end,
                 const std::vector<MessageIndex>& indexes = {}) {
    ChunkIndex index;
    index.start_time = at_ns(static_cast<std::int64_t>(start));
    index.end_time = at_ns(static_cast<std::int64_t>(end));
    index.offset = bytes.size();
    index.compressed_size = index.uncompressed_size = records.size();
    ByteWriter out(bytes);
    const auto at = out.begin_record(static_cast<std::uint8_t>(Opcode::kChunk));
    out.number(start);
    out.number(end);
    out.number(static_cast<std::uint64_t>(records.size()));
    out.number(std::uint32_t{0});
    out.string("");
    out.number(static_cast<std::uint64_t>(records.size()));
    out.raw(records);
    out.end_record(at);
    index.length = bytes.size() - index.offset;
    for (const MessageIndex& messages : indexes) {
      index.message_index_offsets[messages.channel_id] = bytes.size();
      put(out, messages);
    }
    index.message_index_length = bytes.size() - index.offset - index.length;
    summary.chunks.push_back(std::move(index));
  }

  /// A chunk of one message of 1000 bytes, with its index: as rosbag2 writes images.
  void add_message_chunk(std::int64_t time_ns) {
    Bytes records;
    add_message(records, time_ns, std::string(1000, 'x'));
    const auto time = static_cast<std::uint64_t>(time_ns);
    add_chunk(records, time, time, {{1, {{at_ns(time_ns), 0}}}});
  }

  /// The file with its end, of `summary` as it is. Without statistics none are written.
  [[nodiscard]] Bytes closed() const {
    Bytes whole = bytes;
    ByteWriter out(whole);
    put_data_end(out, 0);
    const std::uint64_t start = whole.size();
    for (const auto& [id, schema] : summary.schemas) put(out, schema);
    for (const auto& [id, channel] : summary.channels) put(out, channel);
    if (summary.statistics) put(out, *summary.statistics);
    for (const ChunkIndex& index : summary.chunks) put(out, index);
    for (const AttachmentIndex& index : summary.attachments) put(out, index);
    for (const MetadataIndex& index : summary.metadata) put(out, index);
    const bool empty = whole.size() == start;
    const auto at = out.begin_record(static_cast<std::uint8_t>(Opcode::kFooter));
    out.number(empty ? std::uint64_t{0} : start);
    out.number(std::uint64_t{0});
    out.number(std::uint32_t{0});
    out.end_record(at);
    out.raw(kMagic);
    return whole;
  }

  Bytes bytes;      ///< up to here, without the end
  Summary summary;  ///< of what was added; tests change it
};

}  // namespace furrow::mcap
