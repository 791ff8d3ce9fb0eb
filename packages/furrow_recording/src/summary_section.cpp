#include "summary_section.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "crc32.hpp"

namespace furrow::mcap {
namespace {

template <class T>
bool take(std::optional<T> record, std::vector<T>& list) {
  if (record) {
    list.push_back(std::move(*record));
  }
  return record.has_value();
}

bool take(Opcode opcode, ByteView content, Summary& summary) {
  switch (opcode) {
    case Opcode::kSchema: {
      auto schema = parse_schema(content);
      if (schema && schema->id != 0) {
        summary.schemas.insert_or_assign(schema->id, *schema);
      }
      return schema.has_value();
    }
    case Opcode::kChannel: {
      auto channel = parse_channel(content);
      if (channel) {
        summary.channels.insert_or_assign(channel->id, *channel);
      }
      return channel.has_value();
    }
    case Opcode::kChunkIndex:
      return take(parse_chunk_index(content), summary.chunks);
    case Opcode::kAttachmentIndex:
      return take(parse_attachment_index(content), summary.attachments);
    case Opcode::kMetadataIndex:
      return take(parse_metadata_index(content), summary.metadata);
    case Opcode::kStatistics:
      summary.statistics = parse_statistics(content);
      return summary.statistics.has_value();
    default:
      return true;
  }
}

}  // namespace

Result<std::optional<Tail>> read_tail(const Source& source) {
  if (source.size() < kMagic.size() + kTailBytes) {
    return std::optional<Tail>();
  }
  Tail tail;
  tail.footer_offset = source.size() - kTailBytes;
  Bytes bytes(kTailBytes);
  if (Status status = source.read(tail.footer_offset, bytes); !status) {
    return status.error();
  }
  ByteReader in(bytes);
  const auto opcode = static_cast<Opcode>(in.number<std::uint8_t>());
  const auto length = in.number<std::uint64_t>();
  const ByteView content = in.raw(kFooterBytes);
  const auto footer = parse_footer(content);
  if (opcode != Opcode::kFooter || length != kFooterBytes || !footer ||
      !std::equal(kMagic.begin(), kMagic.end(), in.rest().begin())) {
    return std::optional<Tail>();
  }
  tail.footer = *footer;
  return std::optional<Tail>(tail);
}

Result<Summary> read_summary(const Source& source, const Tail& tail, const ReaderLimits& limits) {
  const std::uint64_t start = tail.footer.summary_start;
  const std::uint64_t offsets = tail.footer.summary_offset_start;
  const std::uint64_t end = tail.footer_offset;
  if (start == 0) {
    return Summary();
  }
  if (start < kMagic.size() || start > end ||
      (offsets != 0 && (offsets < start || offsets > end))) {
    return Error{ErrorCode::kParse, "the footer points outside of the file"};
  }
  if (end - start > limits.record_bytes) {
    return Error{ErrorCode::kOutOfRange, "the summary is larger than allowed"};
  }
  // The CRC covers the summary and the footer up to the CRC field.
  Bytes bytes(static_cast<std::size_t>(end - start) + kRecordHeaderBytes + 16);
  if (Status status = source.read(start, bytes); !status) {
    return status.error();
  }
  if (tail.footer.summary_crc != 0 && tail.footer.summary_crc != crc32(bytes)) {
    return Error{ErrorCode::kParse, "the CRC of the summary does not match"};
  }
  Summary summary;
  const auto records = ByteView(bytes).first(static_cast<std::size_t>(end - start));
  const Status status =
      for_each_record(records, [&summary](Opcode opcode, ByteView content, std::size_t) -> Status {
        if (!take(opcode, content, summary)) {
          return Error{ErrorCode::kParse, "a record of the summary is malformed"};
        }
        return {};
      });
  if (!status) {
    return Error{ErrorCode::kParse, "the summary is malformed"};
  }
  return summary;
}

Bytes put_end_of_file(const Summary& summary, std::uint64_t position, std::uint32_t data_crc) {
  Bytes bytes;
  ByteWriter out(bytes);
  put_data_end(out, data_crc);
  const std::size_t summary_at = bytes.size();
  struct Group {
    Opcode opcode;
    std::size_t at;
    std::size_t length;
  };
  std::vector<Group> groups;
  const auto end_group = [&bytes, &groups](Opcode opcode, std::size_t at) {
    if (bytes.size() > at) {
      groups.push_back({opcode, at, bytes.size() - at});
    }
  };
  const auto put_map = [&](Opcode opcode, const auto& records) {
    const std::size_t at = bytes.size();
    for (const auto& [id, record] : records) {
      put(out, record);
    }
    end_group(opcode, at);
  };
  const auto put_list = [&](Opcode opcode, const auto& records) {
    const std::size_t at = bytes.size();
    for (const auto& record : records) {
      put(out, record);
    }
    end_group(opcode, at);
  };
  put_map(Opcode::kSchema, summary.schemas);
  put_map(Opcode::kChannel, summary.channels);
  put_list(Opcode::kStatistics, std::array{*summary.statistics});
  put_list(Opcode::kChunkIndex, summary.chunks);
  put_list(Opcode::kAttachmentIndex, summary.attachments);
  put_list(Opcode::kMetadataIndex, summary.metadata);
  const std::size_t offsets_at = bytes.size();
  for (const Group& group : groups) {
    put_summary_offset(out, group.opcode, position + group.at, group.length);
  }
  const auto footer_at = out.begin_record(static_cast<std::uint8_t>(Opcode::kFooter));
  out.number(static_cast<std::uint64_t>(position + summary_at));
  out.number(static_cast<std::uint64_t>(position + offsets_at));
  // The CRC covers the record's length too, so that a value must be in its place for that.
  out.number(std::uint32_t{0});
  out.end_record(footer_at);
  bytes.resize(bytes.size() - sizeof(std::uint32_t));
  out.number(crc32(ByteView(bytes).subspan(summary_at)));
  out.raw(kMagic);
  return bytes;
}

}  // namespace furrow::mcap
