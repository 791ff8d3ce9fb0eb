// Each encoding of ROS, written here pixel by pixel from a colour, must give that colour back.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "furrow_components/image_conversions.hpp"

namespace furrow::components {
namespace {

constexpr int kWidth_px = 8;
constexpr int kHeight_px = 6;

struct Colour {
  double r, g, b;
};
constexpr Colour kLeaf{60, 140, 40};

std::uint8_t byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
}

/// Bytes of the pixel at (u, v).
using Pixel = std::function<std::vector<std::uint8_t>(int u, int v)>;

sensor_msgs::msg::Image encode(const std::string& encoding, const Pixel& pixel) {
  constexpr int kPadding = 4;  // rows may end in bytes that mean nothing
  sensor_msgs::msg::Image message;
  message.width(kWidth_px);
  message.height(kHeight_px);
  message.encoding(encoding);
  for (int v = 0; v < kHeight_px; ++v) {
    for (int u = 0; u < kWidth_px; ++u) {
      for (const std::uint8_t value : pixel(u, v)) message.data().push_back(value);
    }
    if (v == 0) message.step(static_cast<std::uint32_t>(message.data().size() + kPadding));
    message.data().insert(message.data().end(), kPadding, 0xEE);
  }
  return message;
}

/// The colour of a Bayer pattern's filter at (u, v), such as "rggb": rows of two.
Pixel bayer(const std::string& pattern) {
  return [pattern](int u, int v) -> std::vector<std::uint8_t> {
    const char filter = pattern[static_cast<std::size_t>(2 * (v % 2) + u % 2)];
    return {byte(filter == 'r' ? kLeaf.r : filter == 'g' ? kLeaf.g : kLeaf.b)};
  };
}

// Luminance and chrominance of ITU-R BT.601 for values from 16 to 235 and 240.
std::uint8_t y601() {
  return byte(16.0 + (65.481 * kLeaf.r + 128.553 * kLeaf.g + 24.966 * kLeaf.b) / 255.0);
}
std::uint8_t u601() {
  return byte(128.0 + (-37.797 * kLeaf.r - 74.203 * kLeaf.g + 112.0 * kLeaf.b) / 255.0);
}
std::uint8_t v601() {
  return byte(128.0 + (112.0 * kLeaf.r - 93.786 * kLeaf.g - 18.214 * kLeaf.b) / 255.0);
}

struct Case {
  std::string encoding;
  Pixel pixel;
};

std::vector<Case> colour_cases() {
  const std::uint8_t r = byte(kLeaf.r), g = byte(kLeaf.g), b = byte(kLeaf.b);
  const auto plain = [](std::vector<std::uint8_t> bytes) -> Pixel {
    return [bytes](int, int) { return bytes; };
  };
  const Pixel uyvy = [](int u, int) -> std::vector<std::uint8_t> {
    return {u % 2 == 0 ? u601() : v601(), y601()};
  };
  const Pixel yuyv = [](int u, int) -> std::vector<std::uint8_t> {
    return {y601(), u % 2 == 0 ? u601() : v601()};
  };
  return {{"bgr8", plain({b, g, r})},
          {"rgb8", plain({r, g, b})},
          {"8UC3", plain({b, g, r})},
          {"bgra8", plain({b, g, r, 9})},
          {"rgba8", plain({r, g, b, 9})},
          {"8UC4", plain({b, g, r, 9})},
          {"bayer_rggb8", bayer("rggb")},
          {"bayer_bggr8", bayer("bggr")},
          {"bayer_gbrg8", bayer("gbrg")},
          {"bayer_grbg8", bayer("grbg")},
          {"yuv422", uyvy},
          {"uyvy", uyvy},
          {"yuv422_yuy2", yuyv},
          {"yuyv", yuyv}};
}

TEST(ImageEncodings, EachGivesTheColourBack) {
  for (const Case& one : colour_cases()) {
    const auto message = encode(one.encoding, one.pixel);
    const auto bgr = bgr_of(message);
    ASSERT_TRUE(bgr.ok()) << one.encoding << ": " << bgr.error().message;
    ASSERT_EQ(bgr->type(), CV_8UC3) << one.encoding;
    ASSERT_EQ(bgr->size(), cv::Size(kWidth_px, kHeight_px)) << one.encoding;
    EXPECT_FALSE(is_grey(message)) << one.encoding;
    const double tolerance = one.encoding.starts_with("yuv") || one.encoding == "uyvy" ? 3.0 : 0.0;
    for (int v = 0; v < kHeight_px; ++v) {
      for (int u = 0; u < kWidth_px; ++u) {
        const auto& pixel = bgr->at<cv::Vec3b>(v, u);
        EXPECT_NEAR(pixel[0], kLeaf.b, tolerance) << one.encoding << " at " << u << ", " << v;
        EXPECT_NEAR(pixel[1], kLeaf.g, tolerance) << one.encoding << " at " << u << ", " << v;
        EXPECT_NEAR(pixel[2], kLeaf.r, tolerance) << one.encoding << " at " << u << ", " << v;
      }
    }
  }
}

TEST(ImageEncodings, GreyHasThreeEqualChannelsAndIsToldAsGrey) {
  for (const std::string encoding : {"mono8", "8UC1"}) {
    const auto message = encode(encoding, [](int u, int v) -> std::vector<std::uint8_t> {
      return {static_cast<std::uint8_t>(10 * u + v)};
    });
    EXPECT_TRUE(is_grey(message));
    const auto bgr = bgr_of(message);
    ASSERT_TRUE(bgr.ok());
    EXPECT_EQ(bgr->at<cv::Vec3b>(2, 5), cv::Vec3b(52, 52, 52));
  }
}

TEST(ImageEncodings, AnErrorNamesWhatIsRead) {
  const auto bgr = bgr_of(encode("bayer_rggb16", [](int, int) -> std::vector<std::uint8_t> {
    return {0, 0};
  }));
  ASSERT_FALSE(bgr.ok());
  EXPECT_NE(bgr.error().message.find("bayer_rggb16"), std::string::npos);
  EXPECT_NE(bgr.error().message.find("bayer_rggb8"), std::string::npos);
}

TEST(ImageEncodings, TheUnitOfADepthOfIntegersIsAParameter) {
  for (const std::string encoding : {"16UC1", "mono16"}) {
    const auto message = encode(encoding, [](int, int) -> std::vector<std::uint8_t> {
      return {0x10, 0x27};
    });
    const auto depth_m = depth_m_of(message, 1e-4);  // 0x2710 is 10000
    ASSERT_TRUE(depth_m.ok());
    EXPECT_FLOAT_EQ(depth_m->at<float>(3, 4), 1.0F);
  }
}

// Rows that begin at half a value would be read from addresses that are not aligned.
TEST(ImageEncodings, RowsThatBeginAtHalfAValueAreAnError) {
  auto message = encode("16UC1", [](int, int) -> std::vector<std::uint8_t> { return {0, 1}; });
  ASSERT_TRUE(depth_m_of(message).ok());
  message.step(message.step() - 1);
  EXPECT_FALSE(depth_m_of(message).ok());
}

}  // namespace
}  // namespace furrow::components
