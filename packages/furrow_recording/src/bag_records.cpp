#include "bag_records.hpp"

#include <array>

namespace furrow::recording {
namespace {

/// A header holds a few short fields.
constexpr std::uint32_t kMaxHeaderBytes = 1u << 20;

ByteView view_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

Error cut_short() {
  return {ErrorCode::kParse, "a record is cut short"};
}

Error malformed() {
  return {ErrorCode::kParse, "a record's header is malformed"};
}

}  // namespace

std::optional<BagFields> BagFields::parse(ByteView header) {
  BagFields fields;
  mcap::ByteReader in(header);
  while (in.left() > 0) {
    const std::string field = in.string();
    const std::size_t equals = field.find('=');
    if (!in.ok() || equals == std::string::npos) {
      return std::nullopt;
    }
    fields.fields_.insert_or_assign(field.substr(0, equals), field.substr(equals + 1));
  }
  return fields;
}

const std::string* BagFields::find(const std::string& name, std::size_t size) const {
  const auto at = fields_.find(name);
  return at != fields_.end() && at->second.size() == size ? &at->second : nullptr;
}

std::optional<std::string> BagFields::text(const std::string& name) const {
  const auto at = fields_.find(name);
  return at == fields_.end() ? std::nullopt : std::optional(at->second);
}

std::optional<std::uint8_t> BagFields::byte(const std::string& name) const {
  const std::string* value = find(name, 1);
  return value == nullptr ? std::nullopt : std::optional(static_cast<std::uint8_t>(value->front()));
}

std::optional<std::uint32_t> BagFields::number(const std::string& name) const {
  const std::string* value = find(name, sizeof(std::uint32_t));
  return value == nullptr
             ? std::nullopt
             : std::optional(mcap::ByteReader(view_of(*value)).number<std::uint32_t>());
}

std::optional<std::uint64_t> BagFields::number64(const std::string& name) const {
  const std::string* value = find(name, sizeof(std::uint64_t));
  return value == nullptr
             ? std::nullopt
             : std::optional(mcap::ByteReader(view_of(*value)).number<std::uint64_t>());
}

std::optional<Time> BagFields::time(const std::string& name) const {
  const std::string* value = find(name, sizeof(std::uint64_t));
  if (value == nullptr) {
    return std::nullopt;
  }
  mcap::ByteReader in(view_of(*value));
  const auto sec = in.number<std::uint32_t>();
  return bag_time(sec, in.number<std::uint32_t>());
}

Result<BagRecord> take_bag_record(ByteView& records) {
  mcap::ByteReader in(records);
  const ByteView header = in.raw(in.number<std::uint32_t>());
  const ByteView data = in.raw(in.number<std::uint32_t>());
  if (!in.ok()) {
    return cut_short();
  }
  auto fields = BagFields::parse(header);
  const auto op = fields ? fields->byte("op") : std::nullopt;
  if (!op) {
    return malformed();
  }
  records = in.rest();
  return BagRecord{static_cast<BagOp>(*op), std::move(*fields), data};
}

Result<BagPlace> place_bag_record(const mcap::Source& source, std::uint64_t offset,
                                  std::uint64_t max_bytes) {
  std::array<std::byte, sizeof(std::uint32_t)> length{};
  const auto read_length = [&](std::uint64_t at) -> Result<std::uint32_t> {
    if (at > source.size() || source.size() - at < length.size()) {
      return cut_short();
    }
    if (Status status = source.read(at, length); !status) {
      return status.error();
    }
    return mcap::ByteReader(length).number<std::uint32_t>();
  };
  const auto header_bytes = read_length(offset);
  if (!header_bytes) {
    return header_bytes.error();
  }
  const std::uint64_t header_at = offset + length.size();
  if (*header_bytes > source.size() - header_at) {
    return cut_short();
  }
  if (*header_bytes > kMaxHeaderBytes) {
    return malformed();
  }
  Bytes header(*header_bytes);
  if (Status status = source.read(header_at, header); !status) {
    return status.error();
  }
  const auto data_bytes = read_length(header_at + header.size());
  if (!data_bytes) {
    return data_bytes.error();
  }
  auto fields = BagFields::parse(header);
  const auto op = fields ? fields->byte("op") : std::nullopt;
  if (!op) {
    return malformed();
  }
  BagPlace place;
  place.op = static_cast<BagOp>(*op);
  place.fields = std::move(*fields);
  place.offset = offset;
  place.data_offset = header_at + header.size() + length.size();
  place.data_bytes = *data_bytes;
  if (place.data_bytes > source.size() - place.data_offset) {
    return cut_short();
  }
  if (place.data_bytes > max_bytes) {
    return Error{ErrorCode::kOutOfRange, "a record of " + std::to_string(place.data_bytes) +
                                             " bytes is larger than the limit of " +
                                             std::to_string(max_bytes)};
  }
  return place;
}

Time bag_time(std::uint32_t sec, std::uint32_t nsec) {
  return Time::from_nanoseconds(std::int64_t{sec} * 1'000'000'000 + nsec);
}

}  // namespace furrow::recording
