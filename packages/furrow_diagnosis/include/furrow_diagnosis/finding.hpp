#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace furrow::diagnosis {

/// How fundamental a finding is: the first is to be mended first.
enum class Rank : std::uint8_t {
  kDelivery,  ///< no message, or those of the wrong writer
  kClock,     ///< stamps
  kFormat,    ///< encoding, size, calibration: the message cannot be used
  kValue,     ///< unit, sign, place: the message is used wrongly
  kFrame,     ///< names of frames
  kRate       ///< rate and losses
};
[[nodiscard]] std::string to_string(Rank rank);

/// One fault of one input.
struct Finding {
  Rank rank = Rank::kDelivery;
  std::string topic;
  std::string check;    ///< stable name, "imu.rate_unit"
  std::string problem;  ///< with the numbers
  std::string remedy;   ///< what to change
};
using Findings = std::vector<Finding>;

}  // namespace furrow::diagnosis
