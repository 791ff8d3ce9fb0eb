#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "bytes.hpp"
#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"
#include "furrow_recording/byte_stream.hpp"

/// The records of ROS 1 bag files, format 2.0 (wiki.ros.org/Bags/Format/2.0).
namespace furrow::recording {

using mcap::Bytes;
using mcap::ByteView;

inline constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
/// Begins bags of every version.
inline constexpr std::string_view kAnyBagMagic = "#ROSBAG V";

enum class BagOp : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7,
};

/// The fields of a record's header: "name=value" each.
class BagFields {
 public:
  /// None when it is malformed.
  [[nodiscard]] static std::optional<BagFields> parse(ByteView header);

  /// Each is none when the field is missing or has another size.
  [[nodiscard]] std::optional<std::string> text(const std::string& name) const;
  [[nodiscard]] std::optional<std::uint8_t> byte(const std::string& name) const;
  [[nodiscard]] std::optional<std::uint32_t> number(const std::string& name) const;
  [[nodiscard]] std::optional<std::uint64_t> number64(const std::string& name) const;
  [[nodiscard]] std::optional<Time> time(const std::string& name) const;

 private:
  [[nodiscard]] const std::string* find(const std::string& name, std::size_t size) const;
  std::map<std::string, std::string> fields_;
};

/// A record: header and data are views.
struct BagRecord {
  BagOp op = BagOp::kMessage;
  BagFields fields;
  ByteView data;
};

/// Takes the next record off the front of `records`. kParse when it is cut short or malformed.
[[nodiscard]] Result<BagRecord> take_bag_record(ByteView& records);

/// A record in the file, whose data are not read.
struct BagPlace {
  BagOp op = BagOp::kMessage;
  BagFields fields;
  std::uint64_t offset = 0;
  std::uint64_t data_offset = 0;
  std::uint64_t data_bytes = 0;
  [[nodiscard]] std::uint64_t end() const { return data_offset + data_bytes; }
};

/// The record at `offset`. kParse when it is not whole or malformed, kOutOfRange when its data are
/// larger than `max_bytes`.
[[nodiscard]] Result<BagPlace> place_bag_record(const mcap::Source& source, std::uint64_t offset,
                                                std::uint64_t max_bytes);

/// Seconds and nanoseconds, both uint32, as bags store a time.
[[nodiscard]] Time bag_time(std::uint32_t sec, std::uint32_t nsec);

}  // namespace furrow::recording
