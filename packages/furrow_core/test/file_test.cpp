#include "furrow_core/file.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace furrow {
namespace {

std::filesystem::path scratch() {
  const auto folder = std::filesystem::path(testing::TempDir()) /
                      testing::UnitTest::GetInstance()->current_test_info()->name();
  std::filesystem::remove_all(folder);
  return folder;
}

TEST(File, WrittenAndReadBack) {
  const auto path = scratch() / "deep" / "file.txt";
  ASSERT_TRUE(write_file_atomically(path, "one").ok());
  ASSERT_TRUE(write_file_atomically(path, std::string_view("t\0wo", 4)).ok());
  const auto content = read_file(path);
  ASSERT_TRUE(content.ok());
  EXPECT_EQ(*content, std::string("t\0wo", 4));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path.parent_path()), {}), 1);
}

TEST(File, FailureLeavesNothingBehind) {
  const auto folder = scratch();
  std::filesystem::create_directories(folder / "target");
  const Status status = write_file_atomically(folder / "target", "x");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kIo);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(File, ReadErrorsAreTold) {
  const auto folder = scratch();
  EXPECT_EQ(read_file(folder / "none").error().code, ErrorCode::kNotFound);
  std::filesystem::create_directories(folder);
  EXPECT_EQ(read_file(folder).error().code, ErrorCode::kIo);
  std::ofstream(folder / "big") << "12345";
  EXPECT_EQ(read_file(folder / "big", 4).error().code, ErrorCode::kOutOfRange);
}

}  // namespace
}  // namespace furrow
