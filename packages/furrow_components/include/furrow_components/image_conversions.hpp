#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"
#include "furrow_msgs/sensor_msgs.h"

namespace furrow::components {

/// 8UC3 as bgr8, 8UC4 as bgra8, 8UC1 as mono8, 16UC1 and 32FC1 by these names. @pre one of these
/// types, continuous or not.
[[nodiscard]] sensor_msgs::msg::Image to_msg(const cv::Mat& image, Time stamp,
                                             const std::string& frame);

/// A matrix over the message's own bytes, which must outlive it and must not be written through it.
/// Encodings are those of ROS (sensor_msgs/image_encodings.hpp): bgr8, rgb8, bgra8, rgba8, mono8,
/// 8UC1, 8UC3, 8UC4, bayer_{rggb,bggr,gbrg,grbg}8, 16UC1, mono16, 32FC1. YUV of 4:2:2 is yuv422 or
/// uyvy, and yuv422_yuy2 or yuyv. kInvalidArgument: another encoding, a big-endian image, or a size
/// that does not match the data.
[[nodiscard]] Result<cv::Mat> view_of(const sensor_msgs::msg::Image& message);

/// A colour image in bgr order: bgr8 and 8UC3 without a copy, others converted; mono8 with three
/// equal channels. kInvalidArgument for what has no 8 bits a channel, and as view_of.
[[nodiscard]] Result<cv::Mat> bgr_of(const sensor_msgs::msg::Image& message);
/// Whether the image has no colour.
[[nodiscard]] bool is_grey(const sensor_msgs::msg::Image& message);

/// A depth image in metres: 32FC1 without a copy; 16UC1 and mono16 times `unit_m`, which is a
/// millimetre by REP 118 and other with some cameras.
[[nodiscard]] Result<cv::Mat> depth_m_of(const sensor_msgs::msg::Image& message,
                                         double unit_m = 1e-3);
/// The median of a sample of the known depths of a CV_32FC1; empty: no pixel has a depth.
[[nodiscard]] std::optional<double> median_depth_m(const cv::Mat& depth_m);

/// Run lengths of a mask (8UC1, zero or not), row by row, starting with background.
[[nodiscard]] std::vector<std::uint32_t> mask_runs(const cv::Mat& mask);
/// The inverse; kParse when the runs do not add up to the size.
[[nodiscard]] Result<cv::Mat> mask_from_runs(const std::vector<std::uint32_t>& runs, int width_px,
                                             int height_px);

}  // namespace furrow::components
