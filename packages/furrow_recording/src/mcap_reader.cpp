#include "furrow_recording/mcap_reader.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "reader_impl.hpp"
#include "summary_section.hpp"

namespace furrow::mcap {
namespace {

Result<Header> read_header(const Source& source, const ReaderLimits& limits) {
  std::array<std::byte, kMagic.size()> magic{};
  if (source.size() < magic.size()) {
    return Error{ErrorCode::kParse, "no MCAP file: shorter than its magic bytes"};
  }
  if (Status status = source.read(0, magic); !status) {
    return status.error();
  }
  if (magic != kMagic) {
    return Error{ErrorCode::kParse, "no MCAP file: it does not begin with the magic bytes"};
  }
  const auto place = place_record(source, magic.size(), source.size(), limits);
  if (!place || place->opcode != Opcode::kHeader) {
    return Error{ErrorCode::kParse, "the MCAP header is not there or cut short"};
  }
  Bytes content;
  if (Status status = read_content(source, *place, content); !status) {
    return status.error();
  }
  auto header = parse_header(content);
  if (!header) {
    return Error{ErrorCode::kParse, "the MCAP header is malformed"};
  }
  return std::move(*header);
}

/// Messages can be found by the summary alone.
bool is_complete(const Summary& summary) {
  return summary.statistics && (!summary.chunks.empty() || summary.statistics->message_count == 0);
}

Result<Bytes> read_indexed(const Source& source, std::uint64_t offset, Opcode opcode,
                           const ReaderLimits& limits) {
  const auto place = place_record(source, offset, source.size(), limits);
  if (!place) {
    return place.error();
  }
  if (place->opcode != opcode) {
    return Error{ErrorCode::kParse, "an index names a place where no such record is"};
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
  auto header = read_header(*source, limits);
  if (!header) {
    return header.error();
  }
  const auto tail = read_tail(*source);
  if (!tail) {
    return tail.error();
  }
  if (!*tail || (*tail)->footer.summary_start == 0) {
    return scan(std::move(source), limits);
  }
  auto summary = read_summary(*source, **tail, limits);
  if (!summary) {
    return summary.error();
  }
  if (!is_complete(*summary)) {
    return scan(std::move(source), limits);
  }
  auto impl = std::make_unique<Impl>();
  impl->source = std::move(source);
  impl->limits = limits;
  impl->header = std::move(*header);
  impl->summary = std::move(*summary);
  for (const ChunkIndex& chunk : impl->summary.chunks) {
    impl->spans.push_back({chunk.start_time, chunk.end_time, chunk.offset, chunk.length, true});
  }
  return Reader(std::move(impl));
}

Result<Reader> Reader::scan(std::unique_ptr<Source> source, const ReaderLimits& limits) {
  // Definitions that a damaged chunk held may stand in the summary again.
  Summary known;
  if (const auto tail = read_tail(*source); tail && *tail && (*tail)->footer.summary_start != 0) {
    if (auto summary = read_summary(*source, **tail, limits)) {
      known = std::move(*summary);
    }
  }
  auto found = walk_data_section(*source, limits, known);
  if (!found) {
    return found.error();
  }
  auto impl = std::make_unique<Impl>();
  impl->damage = found->data_end ? "the file has no usable summary"
                                 : "the file has no end: " + found->stopped_by;
  impl->bytes_ignored = found->data_end ? 0 : source->size() - found->whole_bytes;
  impl->source = std::move(source);
  impl->limits = limits;
  impl->header = std::move(found->header);
  impl->summary = std::move(found->summary);
  impl->spans = std::move(found->spans);
  impl->faults = std::move(found->faults);
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
    return Error{ErrorCode::kParse, "an attachment is malformed or its CRC does not fit"};
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
