#include "furrow_recording/mcap_reader.hpp"

#include <optional>
#include <utility>

#include "reader_impl.hpp"
#include "record_source.hpp"
#include "summary_section.hpp"

namespace furrow::mcap {
namespace {

/// The end of a file, as far as it can be read.
struct End {
  std::optional<Tail> tail;
  RepeatedSummary repeated;
  std::string damage;  ///< why the summary could not be read
};

Result<End> read_end(const Source& source, const ReaderLimits& limits) {
  const auto tail = read_tail(source);
  if (!tail) {
    return tail.error();
  }
  End end;
  end.tail = *tail;
  if (!end.tail) {
    return end;
  }
  auto summary = read_summary(source, *end.tail, limits);
  if (summary) {
    end.repeated = {std::move(*summary), end.tail->footer.summary_crc != 0};
  } else if (summary.error().code == ErrorCode::kIo) {
    return summary.error();
  } else {
    end.damage = summary.error().message;
  }
  return end;
}

/// The scan missed messages that the statistics count, or the other way round.
bool contradicts(const Summary& repeated, const DataSection& found) {
  return repeated.statistics &&
         repeated.statistics->message_count != found.summary.statistics->message_count;
}

std::string damage_of(const DataSection& found, const End& end) {
  if (!found.data_end) {
    return "the end is missing: " + found.stopped_by;
  }
  return end.tail ? end.damage : "the end is missing: no footer and magic bytes";
}

Result<Bytes> read_indexed(const Source& source, std::uint64_t offset, Opcode opcode,
                           const ReaderLimits& limits) {
  const auto place = place_record(source, offset, source.size(), limits);
  if (!place) {
    return place.error();
  }
  if (place->opcode != opcode) {
    return Error{ErrorCode::kParse, "an index points to another record"};
  }
  Bytes content;
  if (Status status = read_content(source, *place, content); !status) {
    return status.error();
  }
  return content;
}

}  // namespace

Reader::Reader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Reader::Reader(Reader&&) noexcept = default;
Reader& Reader::operator=(Reader&&) noexcept = default;
Reader::~Reader() = default;

Result<Reader> Reader::open(std::unique_ptr<Source> source, const ReaderLimits& limits) {
  return open(std::move(source), limits, ScanDepth::kIndexes);
}

Result<Reader> Reader::scan(std::unique_ptr<Source> source, const ReaderLimits& limits) {
  return open(std::move(source), limits, ScanDepth::kContents);
}

Result<Reader> Reader::open(std::unique_ptr<Source> source, const ReaderLimits& limits,
                            ScanDepth depth) {
  const auto end = read_end(*source, limits);
  if (!end) {
    return end.error();
  }
  auto found = scan_data_section(*source, limits, depth, end->repeated);
  if (found && depth == ScanDepth::kIndexes && contradicts(end->repeated.summary, *found)) {
    found = scan_data_section(*source, limits, ScanDepth::kContents, end->repeated);
  }
  if (!found) {
    return found.error();
  }
  auto impl = std::make_unique<Impl>();
  impl->damage = damage_of(*found, *end);
  impl->faults = std::move(found->faults);
  if (contradicts(end->repeated.summary, *found)) {
    impl->faults.push_back(
        "the statistics count " + std::to_string(end->repeated.summary.statistics->message_count) +
        " messages, the file has " + std::to_string(found->summary.statistics->message_count));
  }
  impl->bytes_ignored = found->data_end ? 0 : source->size() - found->whole_bytes;
  impl->source = std::move(source);
  impl->limits = limits;
  impl->header = std::move(found->header);
  impl->summary = std::move(found->summary);
  impl->spans = std::move(found->spans);
  return Reader(std::move(impl));
}

const Header& Reader::header() const {
  return impl_->header;
}
const Summary& Reader::summary() const {
  return impl_->summary;
}
const std::string& Reader::damage() const {
  return impl_->damage;
}
std::uint64_t Reader::bytes_ignored() const {
  return impl_->bytes_ignored;
}
const std::vector<std::string>& Reader::faults() const {
  return impl_->faults;
}

const Channel* Reader::channel(ChannelId id) const {
  const auto at = impl_->summary.channels.find(id);
  return at == impl_->summary.channels.end() ? nullptr : &at->second;
}

Result<Attachment> Reader::attachment(const AttachmentIndex& index) const {
  auto content = read_indexed(*impl_->source, index.offset, Opcode::kAttachment, impl_->limits);
  if (!content) {
    return content.error();
  }
  auto attachment = parse_attachment(*content);
  if (!attachment) {
    return Error{ErrorCode::kParse, "an attachment is malformed or its CRC does not match"};
  }
  return std::move(*attachment);
}

Result<Metadata> Reader::metadata(const MetadataIndex& index) const {
  auto content = read_indexed(*impl_->source, index.offset, Opcode::kMetadata, impl_->limits);
  if (!content) {
    return content.error();
  }
  auto metadata = parse_metadata(*content);
  if (!metadata) {
    return Error{ErrorCode::kParse, "a metadata record is malformed"};
  }
  return std::move(*metadata);
}

}  // namespace furrow::mcap
