#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"
#include "furrow_msgs/sensor_msgs.h"

namespace furrow::components {

/// 8UC3 as bgr8, 8UC1 as mono8, 32FC1 as 32FC1. @pre one of these types, continuous or not.
[[nodiscard]] sensor_msgs::msg::Image to_msg(const cv::Mat& image, Time stamp,
                                             const std::string& frame);

/// A matrix over the bytes of the message, which must outlive it and must not be written through
/// it. Encodings are bgr8, rgb8, mono8, 8UC3, 16UC1 and 32FC1. kInvalidArgument: another encoding,
/// a big-endian image, or a size that does not match the data.
[[nodiscard]] Result<cv::Mat> view_of(const sensor_msgs::msg::Image& message);

/// A colour image in bgr order: bgr8 without a copy, rgb8 converted. Others as view_of.
[[nodiscard]] Result<cv::Mat> bgr_of(const sensor_msgs::msg::Image& message);

/// A depth image in metres: 32FC1 without a copy, 16UC1 (mm, REP 118) converted.
[[nodiscard]] Result<cv::Mat> depth_m_of(const sensor_msgs::msg::Image& message);

/// Run lengths of a mask (8UC1, zero or not), row by row, starting with background.
[[nodiscard]] std::vector<std::uint32_t> mask_runs(const cv::Mat& mask);
/// The inverse; kParse when the runs do not add up to the size.
[[nodiscard]] Result<cv::Mat> mask_from_runs(const std::vector<std::uint32_t>& runs, int width_px,
                                             int height_px);

}  // namespace furrow::components
