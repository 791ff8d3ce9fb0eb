#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"

namespace furrow::recording {

struct ExportedImage {
  int width = 0;
  int height = 0;
  std::string encoding;  ///< as recorded
  std::string frame_id;
  Time stamp;  ///< of acquisition
  std::vector<std::uint8_t> png;
};

/// True for the types that decode_image() reads.
[[nodiscard]] bool is_image_type(const std::string& type_name);

/// A sensor_msgs/Image or CompressedImage in CDR as PNG. kParse for a message that is malformed or
/// too short for its size, kInvalidArgument for an encoding that is not supported.
[[nodiscard]] Result<ExportedImage> decode_image(const std::string& type_name,
                                                 std::span<const std::byte> cdr);

}  // namespace furrow::recording
