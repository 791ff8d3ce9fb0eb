#include "furrow_components/image_conversions.hpp"

#include <bit>
#include <opencv2/imgproc.hpp>

#include "furrow_components/conversions.hpp"

namespace furrow::components {
namespace {

struct Encoding {
  const char* name;
  int type;
};
constexpr Encoding kEncodings[] = {{"bgr8", CV_8UC3},  {"rgb8", CV_8UC3},   {"8UC3", CV_8UC3},
                                   {"mono8", CV_8UC1}, {"16UC1", CV_16UC1}, {"32FC1", CV_32FC1}};

}  // namespace

sensor_msgs::msg::Image to_msg(const cv::Mat& image, Time stamp, const std::string& frame) {
  sensor_msgs::msg::Image message;
  message.header(header(stamp, frame));
  message.width(static_cast<std::uint32_t>(image.cols));
  message.height(static_cast<std::uint32_t>(image.rows));
  for (const Encoding& encoding : kEncodings) {
    if (encoding.type == image.type()) {
      message.encoding(encoding.name);
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
  int type = -1;
  for (const Encoding& encoding : kEncodings) {
    if (message.encoding() == encoding.name) type = encoding.type;
  }
  if (type < 0) {
    return Error{ErrorCode::kInvalidArgument,
                 "image encoding '" + message.encoding() + "' is not supported"};
  }
  if (message.is_bigendian() != 0 && CV_ELEM_SIZE1(type) > 1) {
    return Error{ErrorCode::kInvalidArgument, "big-endian images are not supported"};
  }
  constexpr std::uint32_t kMaxSide_px = 1u << 15;
  const std::size_t row = static_cast<std::size_t>(CV_ELEM_SIZE(type)) * message.width();
  const bool fits =
      message.width() > 0 && message.height() > 0 && message.width() <= kMaxSide_px &&
      message.height() <= kMaxSide_px && message.step() >= row &&
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
  if (view->type() != CV_8UC3) {
    return Error{ErrorCode::kInvalidArgument,
                 "image encoding '" + message.encoding() + "' is not an 8-bit colour image"};
  }
  if (message.encoding() != "rgb8") return view;
  cv::Mat bgr;
  cv::cvtColor(*view, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

Result<cv::Mat> depth_m_of(const sensor_msgs::msg::Image& message) {
  auto view = view_of(message);
  if (!view.ok() || view->type() == CV_32FC1) return view;
  if (view->type() != CV_16UC1) {
    return Error{ErrorCode::kInvalidArgument,
                 "image encoding '" + message.encoding() + "' is not a depth image"};
  }
  cv::Mat depth_m;
  view->convertTo(depth_m, CV_32F, 1e-3);
  return depth_m;
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
