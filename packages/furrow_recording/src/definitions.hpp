#pragma once

#include <map>
#include <string>
#include <vector>

#include "data_section.hpp"
#include "furrow_core/result.hpp"
#include "furrow_recording/mcap_types.hpp"
#include "records.hpp"

namespace furrow::mcap {

/// Schemas and channels of a file as its data section defines them. The repetition in the summary
/// fills in what the data section was not searched for.
class Definitions {
 public:
  explicit Definitions(const RepeatedSummary& repeated)
      : repeated_schemas_(repeated.summary.schemas),
        repeated_channels_(repeated.summary.channels),
        checked_(repeated.checked) {}

  /// kParse when another schema has this id. Id 0 means "none" and is ignored.
  [[nodiscard]] Status add(Schema schema);
  /// kParse when another channel has this id, or its schema is unknown; the channel is added in the
  /// second case.
  [[nodiscard]] Status add(Channel channel);
  [[nodiscard]] bool has_channel(ChannelId id) const {
    return channels_.contains(id) || repeated_channels_.contains(id);
  }
  /// The channel and its schema are known.
  [[nodiscard]] bool has_described_channel(ChannelId id) const;
  /// Definitions that only the summary has are appended: rosbag2 puts topics without messages
  /// there. Tells which ones differ from a checked repetition, which is then used.
  std::vector<std::string> move_to(Summary& summary) &&;

 private:
  [[nodiscard]] bool has_schema(SchemaId id) const;

  std::map<SchemaId, Schema> schemas_;
  std::map<ChannelId, Channel> channels_;
  std::map<SchemaId, Schema> repeated_schemas_;
  std::map<ChannelId, Channel> repeated_channels_;
  bool checked_;  ///< the CRC of the repetition matches
};

/// Parses a Schema or Channel record of the chunk or record at `offset`, and adds it. Whatever is
/// wrong with it is a fault.
void add_definition(Definitions& definitions, Opcode opcode, ByteView content, std::uint64_t offset,
                    Faults& faults);

}  // namespace furrow::mcap
