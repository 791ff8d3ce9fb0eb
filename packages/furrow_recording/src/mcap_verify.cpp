#include <algorithm>

#include "data_section.hpp"
#include "furrow_recording/mcap_tools.hpp"
#include "summary_section.hpp"

namespace furrow::mcap {
namespace {

template <class Record, class Put>
Bytes in_bytes(const Record& record, Put&& put_record) {
  Bytes bytes;
  ByteWriter out(bytes);
  put_record(out, record);
  return bytes;
}

/// Records are the same when their bytes are.
template <class Record>
bool same(const Record& a, const Record& b) {
  const auto put_record = [](ByteWriter& out, const Record& record) { put(out, record); };
  return in_bytes(a, put_record) == in_bytes(b, put_record);
}

template <class Record>
bool same(const std::vector<Record>& a, const std::vector<Record>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Record& x, const Record& y) { return same(x, y); });
}

template <class Id, class Record>
bool same(const std::map<Id, Record>& a, const std::map<Id, Record>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.first == y.first && same(x.second, y.second);
  });
}

/// A summary need not hold everything, but what it holds must be so.
void compare(const Summary& said, Summary found, std::uint64_t offset, Faults& faults) {
  const auto check = [&](bool given, bool right, const char* what) {
    if (given && !right) {
      faults.add(offset, std::string("the summary's ") + what + " are not those of the file");
    }
  };
  if (said.statistics && said.statistics->channel_message_counts.empty()) {
    found.statistics->channel_message_counts.clear();
  }
  check(!said.schemas.empty(), same(said.schemas, found.schemas), "schemas");
  check(!said.channels.empty(), same(said.channels, found.channels), "channels");
  check(!said.chunks.empty(), same(said.chunks, found.chunks), "chunk indexes");
  check(!said.attachments.empty(), same(said.attachments, found.attachments), "attachment indexes");
  check(!said.metadata.empty(), same(said.metadata, found.metadata), "metadata indexes");
  check(said.statistics.has_value(), said.statistics && same(*said.statistics, *found.statistics),
        "statistics");
}

/// Each SummaryOffset record must name a run of records of its opcode.
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
        return Error{ErrorCode::kParse, "a summary offset names other records than it says"};
      }
      record = member->end();
    }
    if (!inside || place->opcode != Opcode::kSummaryOffset) {
      return Error{ErrorCode::kParse, "a summary offset names no place inside the summary"};
    }
    at = place->end();
  }
  return {};
}

}  // namespace

Result<VerifyReport> verify(const Source& source, const ReaderLimits& limits) {
  VerifyReport report;
  report.bytes = source.size();
  auto found = walk_data_section(source, limits);
  if (!found) {
    if (found.error().code == ErrorCode::kIo) {
      return found.error();
    }
    report.faults.push_back("at byte 0: " + found.error().message);
    return report;
  }
  report.messages = found->summary.statistics->message_count;
  report.chunks = found->summary.statistics->chunk_count;
  Faults faults;
  if (!found->data_end) {
    faults.add(found->whole_bytes, "the file has no end: " + found->stopped_by);
  }
  const auto tail = read_tail(source);
  if (!tail) {
    return tail.error();
  }
  report.closed = found->data_end && tail->has_value();
  if (found->data_end && !*tail) {
    faults.add(found->whole_bytes, "the footer or the magic bytes at the end are not there");
  }
  if (report.closed) {
    const Tail& end = **tail;
    const std::uint64_t start =
        end.footer.summary_start == 0 ? end.footer_offset : end.footer.summary_start;
    if (start != found->whole_bytes) {
      faults.add(end.footer_offset, "the summary does not begin behind the data");
    }
    if (end.footer.summary_start != 0) {
      const auto summary = read_summary(source, end, limits);
      const Status offsets = check_offsets(source, end, limits);
      if (!summary) {
        faults.add(start, summary.error().message);
      } else {
        compare(*summary, found->summary, start, faults);
      }
      if (!offsets) {
        faults.add(start, offsets.error().message);
      }
    }
  }
  report.faults = found->faults;
  report.faults.insert(report.faults.end(), faults.list().begin(), faults.list().end());
  report.faults.resize(std::min<std::size_t>(report.faults.size(), 100));
  return report;
}

}  // namespace furrow::mcap
