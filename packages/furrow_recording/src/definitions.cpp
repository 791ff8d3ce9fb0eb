#include "definitions.hpp"

#include <string>
#include <utility>

namespace furrow::mcap {
namespace {

bool equal(const Schema& a, const Schema& b) {
  return a.name == b.name && a.encoding == b.encoding && a.data == b.data;
}
bool equal(const Channel& a, const Channel& b) {
  return a.schema_id == b.schema_id && a.topic == b.topic &&
         a.message_encoding == b.message_encoding && a.metadata == b.metadata;
}

template <class Id, class Record>
void prefer_repeated(std::map<Id, Record>& defined, const std::map<Id, Record>& repeated,
                     const std::string& kind, std::vector<std::string>& differences) {
  for (const auto& [id, record] : repeated) {
    const auto at = defined.find(id);
    if (at != defined.end() && !equal(at->second, record)) {
      differences.push_back(kind + " " + std::to_string(id) +
                            " is defined otherwise in the summary");
      at->second = record;
    }
  }
}

}  // namespace

Status Definitions::add(Schema schema) {
  if (schema.id == 0) {
    return {};
  }
  const auto [at, added] = schemas_.try_emplace(schema.id, schema);
  if (!added && !equal(at->second, schema)) {
    return Error{ErrorCode::kParse, "two schemas have the id " + std::to_string(schema.id)};
  }
  return {};
}

Status Definitions::add(Channel channel) {
  const auto [at, added] = channels_.try_emplace(channel.id, channel);
  if (!added && !equal(at->second, channel)) {
    return Error{ErrorCode::kParse, "two channels have the id " + std::to_string(channel.id)};
  }
  if (!has_schema(channel.schema_id)) {
    return Error{ErrorCode::kParse, "channel " + channel.topic + " has no schema"};
  }
  return {};
}

bool Definitions::has_schema(SchemaId id) const {
  return id == 0 || schemas_.contains(id) || repeated_schemas_.contains(id);
}

bool Definitions::has_described_channel(ChannelId id) const {
  for (const auto* channels : {&channels_, &repeated_channels_}) {
    if (const auto at = channels->find(id); at != channels->end()) {
      return has_schema(at->second.schema_id);
    }
  }
  return false;
}

std::vector<std::string> Definitions::move_to(Summary& summary) && {
  std::vector<std::string> differences;
  if (checked_) {
    prefer_repeated(schemas_, repeated_schemas_, "schema", differences);
    prefer_repeated(channels_, repeated_channels_, "channel", differences);
  }
  summary.schemas = std::move(schemas_);
  summary.channels = std::move(channels_);
  summary.schemas.merge(repeated_schemas_);
  summary.channels.merge(repeated_channels_);
  return differences;
}

void add_definition(Definitions& definitions, Opcode opcode, ByteView content, std::uint64_t offset,
                    Faults& faults) {
  Status status;
  if (opcode == Opcode::kSchema) {
    auto schema = parse_schema(content);
    status = schema ? definitions.add(std::move(*schema))
                    : Status(Error{ErrorCode::kParse, "a schema is malformed"});
  } else {
    auto channel = parse_channel(content);
    status = channel ? definitions.add(std::move(*channel))
                     : Status(Error{ErrorCode::kParse, "a channel is malformed"});
  }
  if (!status) {
    faults.add(offset, status.error().message);
  }
}

}  // namespace furrow::mcap
