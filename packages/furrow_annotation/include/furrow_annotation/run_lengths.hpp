#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::annotation {

/// COCO's run lengths of a mask (Lin et al. 2014): lengths of runs of equal pixels, column after
/// column, beginning with a run of unset pixels (of length 0 where the first pixel is set).
using RunLengths = std::vector<std::uint32_t>;

/// @pre mask is CV_8U; not zero counts as set.
[[nodiscard]] RunLengths encode_run_lengths(const cv::Mat& mask);

/// A mask cut to the bounding box of its set pixels. `box_px` is empty when there is none.
struct BoxedMask {
  cv::Rect box_px;
  cv::Mat pixels;  ///< CV_8U of 0 and 255, size of box_px
};
/// kParse when the runs do not add up to the size.
[[nodiscard]] Result<BoxedMask> decode_run_lengths(const RunLengths& runs, cv::Size size);

/// The printable ("compressed") form. Each run from the fourth on is stored as the difference to
/// the run two before it. Numbers are split into groups of five bits, lowest first, one character
/// each.
[[nodiscard]] std::string compress_run_lengths(const RunLengths& runs);
/// kParse on characters or lengths that the form does not have.
[[nodiscard]] Result<RunLengths> decompress_run_lengths(std::string_view text);

}  // namespace furrow::annotation
