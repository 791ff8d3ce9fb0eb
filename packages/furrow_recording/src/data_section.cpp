#include "data_section.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "chunk_scanner.hpp"
#include "crc32.hpp"
#include "definitions.hpp"
#include "message_tally.hpp"
#include "record_source.hpp"

namespace furrow::mcap {
namespace {

constexpr std::size_t kMaxFaults = 100;
/// Adjacent messages outside of chunks are read in spans of about this size.
constexpr std::uint64_t kMaxLooseBytes = 4u << 20;
/// Of a record that is only described: its fields, but not its data.
constexpr std::uint64_t kHeadBytes = 1u << 12;

/// A record that the summary names.
struct IndexedRecord {
  std::uint64_t length = 0;
  Opcode opcode = Opcode::kChunk;
};
using IndexedRecords = std::map<std::uint64_t, IndexedRecord>;  ///< by offset

IndexedRecords indexed_records(const Summary& summary) {
  IndexedRecords records;
  for (const ChunkIndex& chunk : summary.chunks) {
    records[chunk.offset] = {chunk.length, Opcode::kChunk};
  }
  for (const AttachmentIndex& attachment : summary.attachments) {
    records[attachment.offset] = {attachment.length, Opcode::kAttachment};
  }
  for (const MetadataIndex& metadata : summary.metadata) {
    records[metadata.offset] = {metadata.length, Opcode::kMetadata};
  }
  return records;
}

/// Kinds of records by offset, where the summary is checked. The opcode of a record has no CRC:
/// one changed bit makes a message of a message index.
std::map<std::uint64_t, Opcode> kinds_of(const RepeatedSummary& repeated,
                                         const IndexedRecords& indexed) {
  std::map<std::uint64_t, Opcode> kinds;
  if (!repeated.checked) {
    return kinds;
  }
  for (const auto& [offset, record] : indexed) {
    kinds[offset] = record.opcode;
  }
  for (const ChunkIndex& chunk : repeated.summary.chunks) {
    for (const auto& [channel, offset] : chunk.message_index_offsets) {
      kinds[offset] = Opcode::kMessageIndex;
    }
  }
  return kinds;
}

class Scanner {
 public:
  Scanner(const Source& source, const ReaderLimits& limits, ScanDepth depth,
          const RepeatedSummary& repeated)
      : file_(source),
        source_(file_),
        limits_(limits),
        contents_(depth == ScanDepth::kContents),
        definitions_(repeated),
        indexed_(indexed_records(repeated.summary)),
        kinds_(kinds_of(repeated, indexed_)),
        chunks_(definitions_, faults_, limits, depth) {}

  Result<DataSection> run() {
    if (Status status = begin(); !status) {
      return status.error();
    }
    while (!found_.data_end && found_.stopped_by.empty()) {
      const auto place = next_place();
      if (!place) {
        if (place.error().code == ErrorCode::kIo) {
          return place.error();
        }
        if (!resume_behind(place.error().message)) {
          found_.stopped_by = place.error().message;
        }
        continue;
      }
      place_ = *place;
      correct_kind();
      if (Status status = take(); !status) {
        return status.error();
      }
    }
    if (Status status = chunks_.finish(source_, found_); !status) {
      return status.error();
    }
    return finish();
  }

 private:
  Status begin() {
    std::array<std::byte, kMagic.size()> magic{};
    if (source_.size() < magic.size()) {
      return Error{ErrorCode::kParse, "not an MCAP file: shorter than the magic bytes"};
    }
    if (Status status = source_.read(0, magic); !status) {
      return status;
    }
    if (magic != kMagic) {
      return Error{ErrorCode::kParse, "not an MCAP file: the magic bytes are missing"};
    }
    const auto place = place_record(source_, magic.size(), source_.size(), limits_);
    if (!place) {
      return Error{ErrorCode::kParse, "the MCAP header is cut short"};
    }
    if (Status status = read_content(source_, *place, content_); !status) {
      return status;
    }
    auto header = parse_header(content_);
    if (place->opcode != Opcode::kHeader || !header) {
      return Error{ErrorCode::kParse, "the MCAP header is missing or malformed"};
    }
    found_.header = std::move(*header);
    found_.summary.statistics.emplace();
    place_ = *place;
    crc_ = crc32(magic);
    add_to_crc();
    at_ = place_.end();
    return {};
  }

  /// The record at the position. kParse also when it would reach over a record that the summary
  /// names and that is there: then its own length is wrong.
  Result<RecordPlace> next_place() {
    auto place = place_record(source_, at_, source_.size(), limits_);
    if (!place) {
      return place;
    }
    if (static_cast<std::uint8_t>(place->opcode) == 0) {
      return Error{ErrorCode::kParse, "not a record"};
    }
    const auto inside = indexed_.upper_bound(at_);
    if (inside != indexed_.end() && inside->first < place->end() && is_there(*inside)) {
      return Error{ErrorCode::kParse, "a record's length is wrong"};
    }
    return place;
  }

  [[nodiscard]] bool is_there(const IndexedRecords::value_type& indexed) const {
    const auto place = place_record(source_, indexed.first, source_.size(), limits_);
    return place && place->opcode == indexed.second.opcode &&
           place->end() - place->offset == indexed.second.length;
  }

  void correct_kind() {
    const auto kind = kinds_.find(place_.offset);
    if (kind != kinds_.end() && kind->second != place_.opcode) {
      fault("a record is of another kind than in the summary");
      place_.opcode = kind->second;
    }
  }

  /// Moves to the next record that the summary names; false when there is none.
  bool resume_behind(const std::string& damage) {
    for (auto next = indexed_.upper_bound(at_); next != indexed_.end(); ++next) {
      if (is_there(*next)) {
        faults_.add(at_, damage + "; the " + std::to_string(next->first - at_) +
                             " bytes up to the next indexed record are left out");
        at_ = next->first;
        crc_ = std::nullopt;
        return true;
      }
    }
    return false;
  }

  void add_to_crc() {
    if (!contents_ || !crc_) {
      return;
    }
    Bytes head;
    ByteWriter out(head);
    out.number(static_cast<std::uint8_t>(place_.opcode));
    out.number(place_.content_bytes);
    crc_ = crc32(content_, crc32(head, *crc_));
  }

  void fault(const std::string& what) { faults_.add(place_.offset, what); }

  Status take() {
    if (place_.opcode != Opcode::kMessageIndex) {
      if (Status status = chunks_.finish(source_, found_); !status) {
        return status;
      }
    }
    const bool has_data = place_.opcode == Opcode::kChunk || place_.opcode == Opcode::kMessage ||
                          place_.opcode == Opcode::kAttachment;
    const bool head_only = has_data && !contents_;
    if (Status status =
            read_content(source_, place_, content_, head_only ? kHeadBytes : UINT64_MAX);
        !status) {
      return status;
    }
    if (place_.opcode == Opcode::kFooter) {
      found_.stopped_by = "the footer follows without an end of the data section";
      return {};
    }
    take_content();
    add_to_crc();
    at_ = place_.end();
    return {};
  }

  void take_content() {
    switch (place_.opcode) {
      case Opcode::kSchema:
      case Opcode::kChannel:
        add_definition(definitions_, place_.opcode, content_, place_.offset, faults_);
        break;
      case Opcode::kMessage:
        take_loose_message();
        break;
      case Opcode::kChunk:
        chunks_.begin(place_, content_);
        break;
      case Opcode::kMessageIndex:
        chunks_.add_index(place_, content_);
        break;
      case Opcode::kAttachment:
        take_attachment();
        break;
      case Opcode::kMetadata:
        take_metadata();
        break;
      case Opcode::kDataEnd:
        take_data_end();
        break;
      default:  // reserved for later versions and for extensions
        break;
    }
  }

  void take_data_end() {
    ByteReader in(content_);
    const auto crc = in.number<std::uint32_t>();
    if (!in.ok() || (contents_ && crc_ && crc != 0 && crc != *crc_)) {
      fault("the CRC of the data section does not match");
    }
    found_.data_end = true;
  }

  void take_loose_message() {
    const auto message = parse_message(content_);
    if (!message) {
      fault("a message is malformed");
      return;
    }
    if (!definitions_.has_channel(message->channel_id)) {
      fault("a message has an unknown channel");
      return;
    }
    const Time time = message->log_time;
    MessageTally tally;
    tally.add(message->channel_id, time);
    add_to(*found_.summary.statistics, tally);
    auto& spans = found_.spans;
    if (spans.empty() || spans.back().chunk ||
        spans.back().offset + spans.back().length != place_.offset ||
        spans.back().length > kMaxLooseBytes) {
      spans.push_back({time, time, place_.offset, 0, false, {}});
    }
    Span& span = spans.back();
    span.start_time = std::min(span.start_time, time);
    span.end_time = std::max(span.end_time, time);
    span.length = place_.end() - span.offset;
    const auto at =
        std::lower_bound(span.channels.begin(), span.channels.end(), message->channel_id);
    if (at == span.channels.end() || *at != message->channel_id) {
      span.channels.insert(at, message->channel_id);
    }
  }

  void take_attachment() {
    const auto head = parse_attachment_head(content_);
    const std::uint64_t fields = head ? head->data_offset + sizeof(std::uint32_t) : 0;
    const bool whole =
        head && fields <= place_.content_bytes && head->data_bytes <= place_.content_bytes - fields;
    if (!whole || (contents_ && !parse_attachment(content_))) {
      fault("an attachment is malformed or its CRC does not match");
      return;
    }
    found_.summary.attachments.push_back({place_.offset, place_.end() - place_.offset,
                                          head->log_time, head->create_time, head->data_bytes,
                                          head->name, head->media_type});
  }

  void take_metadata() {
    const auto metadata = parse_metadata(content_);
    if (!metadata) {
      fault("a metadata record is malformed");
      return;
    }
    found_.summary.metadata.push_back(
        {place_.offset, place_.end() - place_.offset, metadata->name});
  }

  DataSection finish() {
    found_.whole_bytes = at_;
    for (const std::string& difference : std::move(definitions_).move_to(found_.summary)) {
      faults_.add(at_, difference);
    }
    Statistics& statistics = *found_.summary.statistics;
    statistics.schema_count = static_cast<std::uint16_t>(found_.summary.schemas.size());
    statistics.channel_count = static_cast<std::uint32_t>(found_.summary.channels.size());
    statistics.attachment_count = static_cast<std::uint32_t>(found_.summary.attachments.size());
    statistics.metadata_count = static_cast<std::uint32_t>(found_.summary.metadata.size());
    found_.faults = faults_.list();
    return std::move(found_);
  }

  const Source& file_;
  const BufferedSource source_;
  const ReaderLimits& limits_;
  const bool contents_;
  Definitions definitions_;
  const IndexedRecords indexed_;
  const std::map<std::uint64_t, Opcode> kinds_;
  DataSection found_;
  Faults faults_;
  ChunkScanner chunks_;
  std::uint64_t at_ = 0;
  std::optional<std::uint32_t> crc_;  ///< of the data section so far; none behind a gap
  RecordPlace place_;
  Bytes content_;  ///< of the record at place_
};

}  // namespace

void Faults::add(std::uint64_t offset, const std::string& what) {
  if (list_.size() < kMaxFaults) {
    list_.push_back("at byte " + std::to_string(offset) + ": " + what);
  }
}

Result<DataSection> scan_data_section(const Source& source, const ReaderLimits& limits,
                                      ScanDepth depth, const RepeatedSummary& repeated) {
  return Scanner(source, limits, depth, repeated).run();
}

}  // namespace furrow::mcap
