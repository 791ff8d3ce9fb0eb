#include "furrow_vision/dataset_groups.hpp"

#include <gtest/gtest.h>

namespace furrow::vision {
namespace {

Dataset dataset_of(const std::vector<std::string>& paths) {
  Dataset dataset;
  for (const std::string& path : paths) dataset.images.emplace_back().path = path;
  return dataset;
}

std::vector<std::string> sequences_of(const Dataset& dataset) {
  std::vector<std::string> sequences;
  for (const auto& image : dataset.images) sequences.push_back(image.sequence);
  return sequences;
}

TEST(DatasetGroups, ByTheFirstGroupOfAPattern) {
  Dataset dataset = dataset_of({"a/row1_003.png", "a/row2_001.png", "b/row1_004.png"});
  const auto groups = group_by_path("(row[0-9]+)_", dataset);
  ASSERT_TRUE(groups.ok()) << groups.error().message;
  EXPECT_EQ(*groups, 2U);
  EXPECT_EQ(sequences_of(dataset), (std::vector<std::string>{"row1", "row2", "row1"}));
  ASSERT_TRUE(group_by_path("^[ab]", dataset).ok());
  EXPECT_EQ(sequences_of(dataset), (std::vector<std::string>{"a", "a", "b"}));
}

TEST(DatasetGroups, RefuseWhatDoesNotMatchAndChangeNothing) {
  Dataset dataset = dataset_of({"row1_1.png", "other.png"});
  const auto refused = group_by_path("row[0-9]+", dataset);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("other.png"), std::string::npos);
  EXPECT_EQ(sequences_of(dataset), (std::vector<std::string>{"", ""}));
  EXPECT_FALSE(group_by_path("row[", dataset).ok());
}

TEST(DatasetGroups, ByGapsBetweenTimesInAnyOrder) {
  // 0, 3 and 40 s of one drive, in ns; the last one given first.
  Dataset dataset =
      dataset_of({"1589534594000000000.png", "1589534554000000000.png", "1589534557000000000.png"});
  const auto groups = group_by_time(10.0, dataset);
  ASSERT_TRUE(groups.ok()) << groups.error().message;
  EXPECT_EQ(*groups, 2U);
  EXPECT_EQ(dataset.images[1].sequence, dataset.images[2].sequence);
  EXPECT_NE(dataset.images[0].sequence, dataset.images[1].sequence);
}

TEST(DatasetGroups, KnowTheUnitOfAUnixTimeByItsDigits) {
  for (const char* second : {"1589534555", "1589534555000", "1589534555000000"}) {
    Dataset dataset = dataset_of({"1589534554000000000.png", std::string(second) + ".png"});
    EXPECT_EQ(group_by_time(2.0, dataset).value(), 1U) << second;
    EXPECT_EQ(group_by_time(1.0, dataset).value(), 2U) << second;
  }
  Dataset stamped = dataset_of({"left.png"});
  stamped.images[0].stamp = Time::from_seconds(1.0);
  EXPECT_TRUE(group_by_time(1.0, stamped).ok());
  Dataset unknown = dataset_of({"IMG_12.jpg"});
  EXPECT_FALSE(group_by_time(1.0, unknown).ok());
}

}  // namespace
}  // namespace furrow::vision
