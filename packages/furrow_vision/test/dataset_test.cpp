#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "furrow_core/file.hpp"
#include "furrow_core/test_support/temporary_folder.hpp"
#include "furrow_vision/annotated_image.hpp"

namespace furrow::vision {
namespace {

TEST(LoadPixels, RefusesWhatIsNoImageOfTheSizeAnnotated) {
  TemporaryFolder folder;
  AnnotatedImage image;
  image.path = folder.path() / "a.png";
  EXPECT_EQ(load_pixels(image).error().code, ErrorCode::kNotFound);
  ASSERT_TRUE(write_file_atomically(image.path, "").ok());
  EXPECT_EQ(load_pixels(image).error().code, ErrorCode::kParse);
  cv::imwrite(image.path.string(), cv::Mat(8, 9, CV_8UC3, cv::Scalar::all(1)));
  image.width_px = 8;
  image.height_px = 8;
  EXPECT_NE(load_pixels(image).error().message.find("9x8"), std::string::npos);
  // Cut off in the middle of its data.
  cv::Mat noise(64, 64, CV_8UC3);
  cv::randu(noise, 0, 255);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", noise, bytes);
  image.width_px = image.height_px = 0;
  ASSERT_TRUE(
      write_file_atomically(image.path, {reinterpret_cast<const char*>(bytes.data()), 40}).ok());
  EXPECT_EQ(load_pixels(image).error().code, ErrorCode::kParse);
}

}  // namespace
}  // namespace furrow::vision
