#include "furrow_annotation/run_lengths.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "furrow_core/random.hpp"

namespace furrow::annotation {
namespace {

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::countNonZero(a != b) == 0;
}

/// The mask over the whole image.
cv::Mat whole(const BoxedMask& mask, cv::Size size) {
  cv::Mat full = cv::Mat::zeros(size, CV_8U);
  if (!mask.box_px.empty()) mask.pixels.copyTo(full(mask.box_px));
  return full;
}

TEST(RunLengths, RunDownTheColumnsAndStartWithZeros) {
  const cv::Mat mask = (cv::Mat_<std::uint8_t>(2, 3) << 255, 0, 0,  //
                        255, 255, 0);
  EXPECT_EQ(encode_run_lengths(mask), (RunLengths{0, 2, 1, 1, 2}));
}

TEST(RunLengths, ComeBackFromAnyMask) {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    cv::Mat mask(static_cast<int>(random.integer(1, 40)), static_cast<int>(random.integer(1, 40)),
                 CV_8U);
    const double share = random.uniform();
    for (auto& pixel : cv::Mat_<std::uint8_t>(mask)) pixel = random.bernoulli(share) ? 255 : 0;
    const auto runs = decompress_run_lengths(compress_run_lengths(encode_run_lengths(mask)));
    ASSERT_TRUE(runs.ok());
    const auto back = decode_run_lengths(*runs, mask.size());
    ASSERT_TRUE(back.ok());
    EXPECT_TRUE(same(whole(*back, mask.size()), mask));
  }
}

TEST(RunLengths, CompressAsTheFormSays) {
  // 5 is 00101: one character, 48 + 5. 100 is 00011 00100: low five bits first with the mark 32:
  // 48 + 32 + 4 and 48 + 3. The fourth run stands as the difference to the second: 98 - 100 = -2,
  // 11110: 48 + 30.
  EXPECT_EQ(compress_run_lengths({5, 100, 5, 98}), "5T35N");
  const auto runs = decompress_run_lengths("5T35N");
  ASSERT_TRUE(runs.ok());
  EXPECT_EQ(*runs, (RunLengths{5, 100, 5, 98}));
}

TEST(RunLengths, AreCutToTheBoxOfWhatIsSet) {
  // 4 rows, 3 columns; set: rows 2 and 3 of column 0, row 0 of column 1.
  const auto mask = decode_run_lengths({2, 3, 7}, {3, 4});
  ASSERT_TRUE(mask.ok());
  EXPECT_EQ(mask->box_px, cv::Rect(0, 0, 2, 4));
  EXPECT_EQ(cv::countNonZero(mask->pixels), 3);
  const auto none = decode_run_lengths({12}, {3, 4});
  ASSERT_TRUE(none.ok());
  EXPECT_TRUE(none->box_px.empty());
}

TEST(RunLengths, RefuseWhatIsMalformed) {
  EXPECT_FALSE(decompress_run_lengths("T").ok());  // ends within a number
  EXPECT_FALSE(decompress_run_lengths("5 5").ok());
  EXPECT_FALSE(decompress_run_lengths("ooooooooooooooooooooo0").ok());
  EXPECT_FALSE(decompress_run_lengths("N").ok());  // -2
  EXPECT_FALSE(decode_run_lengths({3, 4}, {2, 2}).ok());
  EXPECT_FALSE(decode_run_lengths({4294967295u, 4294967295u}, {2, 2}).ok());
}

}  // namespace
}  // namespace furrow::annotation
