#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace furrow::vision {

/// What the library of the codecs offers; may throw cv::Exception.
struct ImageCodecs {
  cv::Mat (*read_grey)(const std::string& file);
  cv::Mat (*read_colour)(const std::string& file);
  cv::Mat (*read_as_stored)(const std::string& file);
  bool (*write)(const std::string& file, const cv::Mat& image);
  bool (*encode_jpeg)(const cv::Mat& image, int quality, std::vector<std::uint8_t>& bytes);
};

inline constexpr char kImageCodecsLibrary[] = "libfurrow_image_codecs.so";
inline constexpr char kImageCodecsFunction[] = "furrow_image_codecs";
using ImageCodecsFunction = const ImageCodecs*();

}  // namespace furrow::vision
