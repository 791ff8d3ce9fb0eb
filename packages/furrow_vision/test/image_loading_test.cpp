#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "furrow_core/file.hpp"
#include "furrow_core/random.hpp"
#include "furrow_core/test_support/temporary_folder.hpp"
#include "furrow_vision/annotated_image.hpp"

namespace furrow::vision {
namespace {

cv::Mat noise() {
  Random random(3);
  cv::Mat bgr(120, 160, CV_8UC3);
  for (auto& p : cv::Mat_<cv::Vec3b>(bgr)) {
    for (int c = 0; c < 3; ++c) p[c] = static_cast<std::uint8_t>(random.integer(0, 255));
  }
  return bgr;
}

class ImageLoading : public testing::Test {
 protected:
  Status load(const std::string& name) {
    image_ = {};
    image_.path = folder_.path() / name;
    return load_pixels(image_);
  }
  void expect_refused(const std::string& name) {
    const Status status = load(name);
    ASSERT_FALSE(status.ok()) << name;
    EXPECT_NE(status.error().message.find(name), std::string::npos) << status.error().message;
    EXPECT_TRUE(image_.bgr.empty());
  }
  TemporaryFolder folder_;
  AnnotatedImage image_;
};

TEST_F(ImageLoading, RefusesTruncatedImages) {
  for (const char* name : {"whole.png", "whole.jpg"}) {
    ASSERT_TRUE(cv::imwrite((folder_.path() / name).string(), noise()));
    EXPECT_TRUE(load(name).ok());
    const auto bytes = read_file(folder_.path() / name);
    ASSERT_TRUE(bytes.ok());
    for (const double share : {0.0, 0.02, 0.5, 0.9}) {
      const std::string part = "part" + std::filesystem::path(name).extension().string();
      const auto kept = static_cast<std::size_t>(share * static_cast<double>(bytes->size()));
      ASSERT_TRUE(write_file_atomically(folder_.path() / part, bytes->substr(0, kept)).ok());
      expect_refused(part);
    }
  }
}

TEST_F(ImageLoading, RefusesWhatIsNoImage) {
  ASSERT_TRUE(write_file_atomically(folder_.path() / "text.png", "no image").ok());
  expect_refused("text.png");
  expect_refused("absent.png");
}

TEST_F(ImageLoading, NamesTheFormatThatIsNotRead) {
  using namespace std::string_literals;
  for (const auto& [begin, named] :
       std::vector<std::pair<std::string, std::string>>{{"GIF89a"s, "GIF"},
                                                        {"\0\0\0\x18"s + "ftypheic"s, "HEIF"},
                                                        {"%PDF-1.7 and more"s, "PDF"},
                                                        {""s, "empty"}}) {
    ASSERT_TRUE(write_file_atomically(folder_.path() / "photo.jpg", begin).ok());
    const Status status = load("photo.jpg");
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find(named), std::string::npos) << status.error().message;
  }
}

TEST_F(ImageLoading, RefusesAHeaderThatPromisesTooMuch) {
  // A bitmap's header of 100000 x 100000 pixels, and nothing behind it.
  std::string header = "BM";
  const auto add = [&](std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) header.push_back(static_cast<char>(value >> (8 * i) & 0xFF));
  };
  add(54, 4);
  add(0, 4);
  add(54, 4);
  add(40, 4);
  add(100000, 4);
  add(100000, 4);
  add(1, 2);
  add(24, 2);
  for (int i = 0; i < 6; ++i) add(0, 4);
  ASSERT_TRUE(write_file_atomically(folder_.path() / "huge.bmp", header).ok());
  expect_refused("huge.bmp");
}

TEST_F(ImageLoading, ReadsGreyAnd16BitFilesAsColour) {
  cv::imwrite((folder_.path() / "grey.png").string(), cv::Mat(20, 30, CV_8U, cv::Scalar(80)));
  ASSERT_TRUE(load("grey.png").ok());
  EXPECT_EQ(image_.bgr.at<cv::Vec3b>(3, 4), cv::Vec3b(80, 80, 80));
  cv::imwrite((folder_.path() / "deep.png").string(),
              cv::Mat(20, 30, CV_16UC3, cv::Scalar(256, 512, 65535)));
  ASSERT_TRUE(load("deep.png").ok());
  EXPECT_EQ(image_.bgr.type(), CV_8UC3);
  EXPECT_EQ(image_.bgr.at<cv::Vec3b>(3, 4), cv::Vec3b(1, 2, 255));
}

}  // namespace
}  // namespace furrow::vision
