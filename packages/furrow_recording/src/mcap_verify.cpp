#include "furrow_recording/mcap_verify.hpp"

#include <algorithm>
#include <set>

#include "data_section.hpp"
#include "record_source.hpp"
#include "summary_section.hpp"

namespace furrow::mcap {
namespace {

/// True when both records have the same bytes.
template <class Record>
bool same(const Record& a, const Record& b) {
  const auto in_bytes = [](const Record& record) {
    Bytes bytes;
    ByteWriter out(bytes);
    put(out, record);
    return bytes;
  };
  return in_bytes(a) == in_bytes(b);
}

/// The summary may repeat some of the data section's definitions, and may define more: rosbag2 puts
/// topics without messages there only.
template <class Id, class Record>
bool agree(const std::map<Id, Record>& repeated, const std::map<Id, Record>& found) {
  return std::ranges::all_of(repeated, [&found](const auto& entry) {
    const auto at = found.find(entry.first);
    return at == found.end() || same(at->second, entry.second);
  });
}

template <class Index>
bool same_indexes(std::vector<Index> a, const std::vector<Index>& b) {
  std::ranges::sort(a, {}, &Index::offset);
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Index& x, const Index& y) { return same(x, y); });
}

/// The times of a chunk without messages mean nothing; writers put different values there.
void clear_times_without_messages(std::vector<ChunkIndex>& chunks,
                                  const std::set<std::uint64_t>& with_messages) {
  for (ChunkIndex& chunk : chunks) {
    if (!with_messages.contains(chunk.offset)) {
      chunk.start_time = chunk.end_time = Time();
    }
  }
}

bool agree(Statistics repeated, Statistics found, const Summary& defined) {
  // Writers count the definitions of the data section, or also those that only the summary has.
  const auto between = [](std::uint64_t value, std::uint64_t low, std::uint64_t high) {
    return value >= low && value <= std::max(low, high);
  };
  if (!between(repeated.schema_count, found.schema_count, defined.schemas.size()) ||
      !between(repeated.channel_count, found.channel_count, defined.channels.size())) {
    return false;
  }
  repeated.schema_count = found.schema_count;
  repeated.channel_count = found.channel_count;
  if (repeated.message_count == 0) {
    repeated.start_time = found.start_time;
    repeated.end_time = found.end_time;
  }
  std::erase_if(repeated.channel_message_counts,
                [](const auto& entry) { return entry.second == 0; });
  if (repeated.channel_message_counts.empty()) {
    found.channel_message_counts.clear();
  }
  return same(repeated, found);
}

/// A summary need not hold everything, but what it holds must be right.
void compare(Summary repeated, DataSection found, std::uint64_t offset, Faults& faults) {
  const auto check = [&](bool given, bool right, const char* what) {
    if (given && !right) {
      faults.add(offset, std::string("the summary's ") + what + " do not match the file");
    }
  };
  std::set<std::uint64_t> with_messages;
  for (const Span& span : found.spans) {
    with_messages.insert(span.offset);
  }
  clear_times_without_messages(repeated.chunks, with_messages);
  const Summary& data = found.summary;
  check(true, agree(repeated.schemas, data.schemas), "schemas");
  check(true, agree(repeated.channels, data.channels), "channels");
  check(!repeated.chunks.empty(), same_indexes(repeated.chunks, data.chunks), "chunk indexes");
  check(!repeated.attachments.empty(), same_indexes(repeated.attachments, data.attachments),
        "attachment indexes");
  check(!repeated.metadata.empty(), same_indexes(repeated.metadata, data.metadata),
        "metadata indexes");
  check(repeated.statistics.has_value(),
        repeated.statistics && agree(*repeated.statistics, *data.statistics, repeated),
        "statistics");
}

/// Each SummaryOffset record must point to records of its opcode.
Status check_offsets(const Source& source, const Tail& tail, const ReaderLimits& limits) {
  std::uint64_t at = tail.footer.summary_offset_start;
  while (at != 0 && at < tail.footer_offset) {
    const auto place = place_record(source, at, tail.footer_offset, limits);
    if (!place) {
      return place.error();
    }
    Bytes content;
    if (Status status = read_content(source, *place, content); !status) {
      return status;
    }
    ByteReader in(content);
    const auto group = static_cast<Opcode>(in.number<std::uint8_t>());
    std::uint64_t record = in.number<std::uint64_t>();
    const auto length = in.number<std::uint64_t>();
    const bool inside = in.ok() && record >= tail.footer.summary_start &&
                        record <= tail.footer_offset && length <= tail.footer_offset - record;
    const std::uint64_t end = inside ? record + length : record;
    while (inside && record < end) {
      const auto member = place_record(source, record, end, limits);
      if (!member || member->opcode != group) {
        return Error{ErrorCode::kParse, "a summary offset points to records of another kind"};
      }
      record = member->end();
    }
    if (!inside || place->opcode != Opcode::kSummaryOffset) {
      return Error{ErrorCode::kParse, "a summary offset points outside of the summary"};
    }
    at = place->end();
  }
  return {};
}

/// Compares summary and footer with what the data section holds.
void check_end(const Source& source, const Tail& tail, const ReaderLimits& limits,
               DataSection found, Faults& faults) {
  const bool has_summary = tail.footer.summary_start != 0;
  const std::uint64_t start = has_summary ? tail.footer.summary_start : tail.footer_offset;
  if (start != found.whole_bytes) {
    faults.add(tail.footer_offset, "the summary does not begin behind the data");
  }
  if (!has_summary) {
    return;
  }
  auto summary = read_summary(source, tail, limits);
  if (!summary) {
    faults.add(start, summary.error().message);
  } else {
    compare(std::move(*summary), std::move(found), start, faults);
  }
  if (Status offsets = check_offsets(source, tail, limits); !offsets) {
    faults.add(start, offsets.error().message);
  }
}

}  // namespace

Result<VerifyReport> verify(const Source& source, const ReaderLimits& limits) {
  VerifyReport report;
  report.bytes = source.size();
  auto found = scan_data_section(source, limits, ScanDepth::kContents);
  if (!found) {
    if (found.error().code == ErrorCode::kIo) {
      return found.error();
    }
    report.faults.push_back("at byte 0: " + found.error().message);
    return report;
  }
  report.messages = found->summary.statistics->message_count;
  report.chunks = found->summary.statistics->chunk_count;
  const auto tail = read_tail(source);
  if (!tail) {
    return tail.error();
  }
  report.closed = found->data_end && tail->has_value();
  report.faults = found->faults;
  Faults faults;
  if (!found->data_end) {
    faults.add(found->whole_bytes, "the end is missing: " + found->stopped_by);
  } else if (!*tail) {
    faults.add(found->whole_bytes, "the footer or the magic bytes at the end are missing");
  } else {
    check_end(source, **tail, limits, std::move(*found), faults);
  }
  report.faults.insert(report.faults.end(), faults.list().begin(), faults.list().end());
  report.faults.resize(std::min<std::size_t>(report.faults.size(), 100));
  return report;
}

}  // namespace furrow::mcap
