#include "image_files.hpp"

#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string_view>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/sensor_msgs.h"

namespace furrow::recording {
namespace {

constexpr std::string_view kImageType = "sensor_msgs/msg/Image";
constexpr std::string_view kCompressedType = "sensor_msgs/msg/CompressedImage";
constexpr std::uint32_t kMaxSide_px = 65'500;
constexpr std::uint64_t kMaxPixels = 200'000'000;
constexpr double kMillimetres = 1000.0;

/// How pixels lie in memory, and the conversion to BGR that OpenCV writes.
struct PixelFormat {
  std::string_view encoding;
  int type = CV_8UC1;
  int to_bgr = -1;  ///< a cv::ColorConversionCodes; -1: none is needed
};

// OpenCV names Bayer patterns by the second row's second and third pixel, ROS by the first row.
constexpr std::array kPixelFormats = {
    PixelFormat{"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
    PixelFormat{"bgr8", CV_8UC3},
    PixelFormat{"8UC3", CV_8UC3},
    PixelFormat{"rgba8", CV_8UC4, cv::COLOR_RGBA2BGRA},
    PixelFormat{"bgra8", CV_8UC4},
    PixelFormat{"8UC4", CV_8UC4},
    PixelFormat{"mono8", CV_8UC1},
    PixelFormat{"8UC1", CV_8UC1},
    PixelFormat{"mono16", CV_16UC1},
    PixelFormat{"16UC1", CV_16UC1},
    PixelFormat{"32FC1", CV_32FC1},
    PixelFormat{"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR},
    PixelFormat{"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR},
    PixelFormat{"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR},
    PixelFormat{"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR},
    PixelFormat{"yuv422", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    PixelFormat{"uyvy", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    PixelFormat{"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
    PixelFormat{"yuyv", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
};

std::optional<PixelFormat> pixel_format(const std::string& encoding) {
  const auto at = std::ranges::find(kPixelFormats, encoding, &PixelFormat::encoding);
  return at == kPixelFormats.end() ? std::nullopt : std::optional(*at);
}

template <class Message>
ExportedImage described(const Message& message) {
  ExportedImage image;
  image.frame_id = message.header().frame_id();
  const auto& stamp = message.header().stamp();
  image.stamp = Time() + Duration::milliseconds(std::int64_t{stamp.sec()} * 1000) +
                Duration::nanoseconds(stamp.nanosec());
  return image;
}

Result<ExportedImage> with_pixels(ExportedImage image, const cv::Mat& pixels) {
  image.width = pixels.cols;
  image.height = pixels.rows;
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(pixels.cols);
  png.height = static_cast<png_uint_32>(pixels.rows);
  png.flags = PNG_IMAGE_FLAG_FAST;
  png.format = pixels.channels() == 3     ? PNG_FORMAT_BGR
               : pixels.channels() == 4   ? PNG_FORMAT_BGRA
               : pixels.depth() == CV_16U ? PNG_FORMAT_LINEAR_Y
                                          : PNG_FORMAT_GRAY;
  png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(png);
  image.png.resize(bytes);
  const auto stride = static_cast<png_int_32>(pixels.step / pixels.elemSize1());
  const int written =
      png_image_write_to_memory(&png, image.png.data(), &bytes, 0, pixels.data, stride, nullptr);
  if (written == 0) {
    return Error{ErrorCode::kInvalidArgument, std::string("libpng: ") + png.message};
  }
  image.png.resize(bytes);
  return image;
}

/// Depth in metres as millimetres; what is not a depth becomes 0.
cv::Mat in_millimetres(const cv::Mat& depth_m) {
  cv::Mat depth = depth_m.clone();
  cv::patchNaNs(depth, 0.0);
  cv::Mat depth_mm;
  depth.convertTo(depth_mm, CV_16UC1, kMillimetres);  // saturates
  return depth_mm;
}

bool fits(std::uint64_t width, std::uint64_t height) {
  return width > 0 && height > 0 && width <= kMaxSide_px && height <= kMaxSide_px &&
         width * height <= kMaxPixels;
}

Result<ExportedImage> decode_raw(const sensor_msgs::msg::Image& message) {
  ExportedImage image = described(message);
  image.encoding = message.encoding();
  const auto format = pixel_format(message.encoding());
  if (!format) {
    return Error{ErrorCode::kInvalidArgument,
                 "the image encoding '" + message.encoding().substr(0, 40) + "' is not supported"};
  }
  const std::uint64_t row_bytes = std::uint64_t{message.width()} * CV_ELEM_SIZE(format->type);
  if (!fits(message.width(), message.height()) || message.step() < row_bytes ||
      std::uint64_t{message.step()} * message.height() > message.data().size()) {
    return Error{ErrorCode::kParse, "the image's data do not match its size"};
  }
  // OpenCV takes no const data, but reads only.
  auto* const data = const_cast<std::uint8_t*>(message.data().data());
  cv::Mat pixels(static_cast<int>(message.height()), static_cast<int>(message.width()),
                 format->type, data, message.step());
  if (message.is_bigendian() != 0 && format->type == CV_16UC1) {
    cv::Mat swapped(pixels.size(), CV_16UC1);
    for (int row = 0; row < pixels.rows; ++row) {
      const auto* from = pixels.ptr<std::uint16_t>(row);
      std::transform(from, from + pixels.cols, swapped.ptr<std::uint16_t>(row),
                     [](std::uint16_t value) {
                       return static_cast<std::uint16_t>(value << 8U | value >> 8U);
                     });
    }
    pixels = swapped;
  }
  if (format->type == CV_32FC1) {
    pixels = in_millimetres(pixels);
  } else if (format->to_bgr >= 0) {
    cv::Mat converted;
    cv::cvtColor(pixels, converted, format->to_bgr);
    pixels = converted;
  }
  return with_pixels(std::move(image), pixels);
}

/// A PNG file as it is, with the size that its header says.
Result<ExportedImage> png_as_it_is(ExportedImage image, std::span<const std::uint8_t> data) {
  constexpr std::size_t kHeaderBytes = 24;
  const auto big_endian = [&data](std::size_t at) {
    return std::uint32_t{data[at]} << 24U | std::uint32_t{data[at + 1]} << 16U |
           std::uint32_t{data[at + 2]} << 8U | data[at + 3];
  };
  if (data.size() < kHeaderBytes || !fits(big_endian(16), big_endian(20))) {
    return Error{ErrorCode::kParse, "the compressed image is cut short or too large"};
  }
  image.width = static_cast<int>(big_endian(16));
  image.height = static_cast<int>(big_endian(20));
  image.png.assign(data.begin(), data.end());
  return image;
}

Result<ExportedImage> decode_jpeg(ExportedImage image, std::span<const std::uint8_t> data) {
  struct Destroy {
    void operator()(void* handle) const { tjDestroy(handle); }
  };
  const std::unique_ptr<void, Destroy> jpeg(tjInitDecompress());
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int colour_space = 0;
  if (tjDecompressHeader3(jpeg.get(), data.data(), data.size(), &width, &height, &subsampling,
                          &colour_space) != 0 ||
      !fits(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height))) {
    return Error{ErrorCode::kParse, "the JPEG image is malformed or too large"};
  }
  const bool grey = colour_space == TJCS_GRAY;
  cv::Mat pixels(height, width, grey ? CV_8UC1 : CV_8UC3);
  // A warning about damaged data counts as an error: half of a picture is not a picture.
  if (tjDecompress2(jpeg.get(), data.data(), data.size(), pixels.data, width,
                    static_cast<int>(pixels.step), height, grey ? TJPF_GRAY : TJPF_BGR, 0) != 0) {
    return Error{ErrorCode::kParse, std::string("JPEG: ") + tjGetErrorStr2(jpeg.get())};
  }
  return with_pixels(std::move(image), pixels);
}

/// By its content: `format` is written in different ways.
Result<ExportedImage> decode_compressed(const sensor_msgs::msg::CompressedImage& message) {
  ExportedImage image = described(message);
  image.encoding = message.format();
  std::span<const std::uint8_t> data(message.data());
  // compressed_depth_image_transport puts its parameters before the picture.
  constexpr std::size_t kDepthHeaderBytes = 12;
  if (message.format().find("compressedDepth") != std::string::npos &&
      data.size() > kDepthHeaderBytes) {
    data = data.subspan(kDepthHeaderBytes);
  }
  constexpr std::array<std::uint8_t, 8> kPngMagic = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::array<std::uint8_t, 2> kJpegMagic = {0xFF, 0xD8};
  const auto begins_with = [&data](const auto& magic) {
    return data.size() >= magic.size() && std::equal(magic.begin(), magic.end(), data.begin());
  };
  if (begins_with(kPngMagic)) {
    return png_as_it_is(std::move(image), data);
  }
  if (begins_with(kJpegMagic)) {
    return decode_jpeg(std::move(image), data);
  }
  return Error{ErrorCode::kInvalidArgument, "the compressed image format '" +
                                                message.format().substr(0, 40) +
                                                "' is not supported; JPEG and PNG are"};
}

template <class Message>
Result<Message> message_from(std::span<const std::byte> cdr) {
  Message message;
  if (Status status = msgs::message_type<Message>().deserialize(cdr, &message); !status) {
    return status.error();
  }
  return message;
}

}  // namespace

bool is_image_type(const std::string& type_name) {
  return type_name == kImageType || type_name == kCompressedType;
}

Result<ExportedImage> decode_image(const std::string& type_name, std::span<const std::byte> cdr) {
  try {
    if (type_name == kImageType) {
      const auto message = message_from<sensor_msgs::msg::Image>(cdr);
      return message ? decode_raw(*message) : Result<ExportedImage>(message.error());
    }
    const auto message = message_from<sensor_msgs::msg::CompressedImage>(cdr);
    return message ? decode_compressed(*message) : Result<ExportedImage>(message.error());
  } catch (const cv::Exception& failure) {
    return Error{ErrorCode::kInvalidArgument, "OpenCV: " + failure.err};
  }
}

}  // namespace furrow::recording
