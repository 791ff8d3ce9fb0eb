#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::vision {

enum class ImageChannels { kGrey, kColour, kAsStored };

// OpenCV's codecs are loaded with the first file. They depend on more than a hundred libraries,
// which a process that only moves an axis does not need.

/// 8-bit grey, 8-bit BGR, or what is in the file. Errors, with the file's name: kNotFound, and
/// kParse for what is no image.
[[nodiscard]] Result<cv::Mat> read_image(const std::filesystem::path& file, ImageChannels channels);
/// A mask of 8 bits as it is stored; errors as read_image.
[[nodiscard]] Result<cv::Mat> read_mask(const std::filesystem::path& file);
/// The suffix tells the format. Errors: kIo.
[[nodiscard]] Status write_image(const std::filesystem::path& file, const cv::Mat& image);
/// Quality from 0 to 100. Errors: kIo.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_jpeg(const cv::Mat& image, int quality);

}  // namespace furrow::vision
