#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/core/mat.hpp>

#include "furrow_core/result.hpp"

namespace furrow::annotation {

/// Decodes a grey image file as CV_8UC1 of the values stored. This package decodes no images
/// itself: codecs bring many libraries, and their user chooses them.
using MaskReader = std::function<Result<cv::Mat>(const std::filesystem::path&)>;

}  // namespace furrow::annotation
