#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::vision {

/// COCO's run lengths of a mask (Lin et al. 2014): down the columns, zeros first, in turns.
using RunLengths = std::vector<std::uint32_t>;

/// @pre mask is CV_8U; not zero counts as set.
[[nodiscard]] RunLengths encode_run_lengths(const cv::Mat& mask);
/// CV_8U of 0 and 255. kParse when the runs do not add up to the size.
[[nodiscard]] Result<cv::Mat> decode_run_lengths(const RunLengths& runs, cv::Size size);

/// The printable form: differences to the run before the last, five bits a character.
[[nodiscard]] std::string compress_run_lengths(const RunLengths& runs);
/// kParse on characters or lengths that the form does not have.
[[nodiscard]] Result<RunLengths> decompress_run_lengths(std::string_view text);

}  // namespace furrow::vision
