#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "furrow_vision/annotated_image.hpp"

namespace furrow::vision {

/// Fills box and mask from a mask over the whole image; false when no pixel is set.
[[nodiscard]] bool cut_to_box(const cv::Mat& full_mask, AnnotatedInstance& instance);
/// A mask file as CV_8UC1 of the values stored. Error names the file.
[[nodiscard]] Result<cv::Mat> read_mask(const std::filesystem::path& file);
/// Files of a folder with one of the extensions (lower case, with dot), in the order of names.
[[nodiscard]] Result<std::vector<std::filesystem::path>> list_files(
    const std::filesystem::path& folder, const std::vector<std::string>& extensions);

}  // namespace furrow::vision
