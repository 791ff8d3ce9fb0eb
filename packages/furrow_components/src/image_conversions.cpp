#include "furrow_components/image_conversions.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <span>
#include <string_view>

#include "furrow_components/conversions.hpp"
#include "furrow_core/statistics.hpp"

namespace furrow::components {
namespace {

constexpr int kAsItIs = -1;
constexpr int kNoColour = -2;

struct Encoding {
  std::string_view name;
  int type;
  int to_bgr;  // a cv::ColorConversionCodes
};
// The first of a type is what to_msg() calls it. OpenCV names a Bayer pattern by the second row's
// second and third pixel, ROS by the first two of each row.
constexpr Encoding kEncodings[] = {
    {"bgr8", CV_8UC3, kAsItIs},
    {"mono8", CV_8UC1, cv::COLOR_GRAY2BGR},
    {"16UC1", CV_16UC1, kNoColour},
    {"32FC1", CV_32FC1, kNoColour},
    {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
    {"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
    {"8UC3", CV_8UC3, kAsItIs},
    {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
    {"8UC4", CV_8UC4, cv::COLOR_BGRA2BGR},
    {"8UC1", CV_8UC1, cv::COLOR_GRAY2BGR},
    {"mono16", CV_16UC1, kNoColour},
    {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR},
    {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR},
    {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR},
    {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR},
    {"yuv422", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    {"uyvy", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
    {"yuyv", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
};

const Encoding* find_encoding(std::string_view name) {
  const auto* const found = std::ranges::find(kEncodings, name, &Encoding::name);
  return found == std::end(kEncodings) ? nullptr : found;
}

Error unknown_encoding(const std::string& name) {
  std::string known;
  for (const Encoding& encoding : kEncodings) {
    known += (known.empty() ? "" : ", ") + std::string(encoding.name);
  }
  return {ErrorCode::kInvalidArgument, "image encoding '" + name + "' is not one of " + known};
}

}  // namespace

sensor_msgs::msg::Image to_msg(const cv::Mat& image, Time stamp, const std::string& frame) {
  sensor_msgs::msg::Image message;
  message.header(header(stamp, frame));
  message.width(static_cast<std::uint32_t>(image.cols));
  message.height(static_cast<std::uint32_t>(image.rows));
  for (const Encoding& encoding : kEncodings) {
    if (encoding.type == image.type()) {
      message.encoding(std::string(encoding.name));
      break;
    }
  }
  message.is_bigendian(std::endian::native == std::endian::big ? 1 : 0);
  const std::size_t step = image.elemSize() * static_cast<std::size_t>(image.cols);
  message.step(static_cast<std::uint32_t>(step));
  message.data().resize(step * static_cast<std::size_t>(image.rows));
  cv::Mat target(image.rows, image.cols, image.type(), message.data().data(), step);
  image.copyTo(target);
  return message;
}

Result<cv::Mat> view_of(const sensor_msgs::msg::Image& message) {
  const Encoding* const encoding = find_encoding(message.encoding());
  if (encoding == nullptr) return unknown_encoding(message.encoding());
  const int type = encoding->type;
  if (message.is_bigendian() != 0 && CV_ELEM_SIZE1(type) > 1) {
    return Error{ErrorCode::kInvalidArgument, "big-endian images are not supported"};
  }
  constexpr std::uint32_t kMaxSide_px = 1u << 15;
  const std::size_t row = static_cast<std::size_t>(CV_ELEM_SIZE(type)) * message.width();
  const bool fits =
      message.width() > 0 && message.height() > 0 && message.width() <= kMaxSide_px &&
      message.height() <= kMaxSide_px && message.step() >= row &&
      message.step() % CV_ELEM_SIZE1(type) == 0 &&
      message.data().size() >= std::size_t{message.step()} * (message.height() - 1) + row;
  if (!fits) {
    return Error{ErrorCode::kInvalidArgument, "the image size does not match its data"};
  }
  // cv::Mat has no read-only form. The contract of view_of() forbids writing.
  auto* data = const_cast<std::uint8_t*>(message.data().data());
  return cv::Mat(static_cast<int>(message.height()), static_cast<int>(message.width()), type, data,
                 message.step());
}

Result<cv::Mat> bgr_of(const sensor_msgs::msg::Image& message) {
  auto view = view_of(message);
  if (!view.ok()) return view;
  const int to_bgr = find_encoding(message.encoding())->to_bgr;
  if (to_bgr == kAsItIs) return view;
  const bool halved = view->channels() == 2;  // one colour for two pixels of a row
  if (to_bgr == kNoColour || (halved && view->cols % 2 != 0)) {
    return Error{ErrorCode::kInvalidArgument, "image of " + std::to_string(view->cols) +
                                                  " px width and encoding '" + message.encoding() +
                                                  "' is not a colour image of 8 bits"};
  }
  cv::Mat bgr;
  cv::cvtColor(*view, bgr, to_bgr);
  return bgr;
}

bool is_grey(const sensor_msgs::msg::Image& message) {
  const Encoding* const encoding = find_encoding(message.encoding());
  return encoding != nullptr && encoding->to_bgr == cv::COLOR_GRAY2BGR;
}

Result<cv::Mat> depth_m_of(const sensor_msgs::msg::Image& message, double unit_m) {
  auto view = view_of(message);
  if (!view.ok() || view->type() == CV_32FC1) return view;
  if (view->type() != CV_16UC1) {
    return Error{ErrorCode::kInvalidArgument,
                 "image encoding '" + message.encoding() + "' is not a depth image"};
  }
  cv::Mat depth_m;
  view->convertTo(depth_m, CV_32F, unit_m);
  return depth_m;
}

std::optional<double> median_depth_m(const cv::Mat& depth_m) {
  constexpr int kStep = 8;  // a sample is enough
  std::vector<float> depths_m;
  for (int v = 0; v < depth_m.rows; v += kStep) {
    const auto* row = depth_m.ptr<float>(v);
    for (int u = 0; u < depth_m.cols; u += kStep) {
      if (std::isfinite(row[u]) && row[u] > 0.0F) depths_m.push_back(row[u]);
    }
  }
  if (depths_m.empty()) return std::nullopt;
  return median_element(std::span(depths_m));
}

std::vector<std::uint32_t> mask_runs(const cv::Mat& mask) {
  std::vector<std::uint32_t> runs;
  bool inside = false;
  std::uint32_t length = 0;
  for (int row = 0; row < mask.rows; ++row) {
    const auto* pixels = mask.ptr<std::uint8_t>(row);
    for (int column = 0; column < mask.cols; ++column) {
      if ((pixels[column] != 0) != inside) {
        runs.push_back(length);
        length = 0;
        inside = !inside;
      }
      ++length;
    }
  }
  runs.push_back(length);
  return runs;
}

Result<cv::Mat> mask_from_runs(const std::vector<std::uint32_t>& runs, int width_px,
                               int height_px) {
  if (width_px < 0 || height_px < 0)
    return Error{ErrorCode::kParse, "the mask has a negative size"};
  cv::Mat mask(height_px, width_px, CV_8UC1, cv::Scalar(0));
  const std::size_t total = mask.total();
  std::size_t at = 0;
  bool inside = false;
  for (const std::uint32_t run : runs) {
    if (run > total - at) return Error{ErrorCode::kParse, "the mask is longer than its box"};
    if (inside) std::fill_n(mask.data + at, run, std::uint8_t{255});
    at += run;
    inside = !inside;
  }
  if (at != total) return Error{ErrorCode::kParse, "the mask does not fill its box"};
  return mask;
}

}  // namespace furrow::components
