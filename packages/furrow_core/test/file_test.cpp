#include "furrow_core/file.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <fstream>
#include <vector>

namespace {

/// What the library asked of the operating system, in order.
std::vector<std::string> calls;
int fail_file_sync = 0;

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// In place of the C library's, for the whole program.
extern "C" int fsync(int descriptor) {
  struct stat status {};
  const bool folder = ::fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode);
  calls.push_back(folder ? "sync folder" : "sync file");
  if (!folder && fail_file_sync != 0) {
    errno = fail_file_sync;
    return -1;
  }
  return next<int(int)>("fsync")(descriptor);
}

extern "C" int rename(const char* from, const char* to) noexcept {
  calls.emplace_back("rename");
  return next<int(const char*, const char*)>("rename")(from, to);
}

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

TEST(File, NewFileReplacesNothing) {
  const auto path = scratch() / "deep" / "file.txt";
  const auto first = write_new_file(path, "one");
  ASSERT_TRUE(first.ok());
  EXPECT_TRUE(*first);
  const auto second = write_new_file(path, "two");
  ASSERT_TRUE(second.ok());
  EXPECT_FALSE(*second);
  EXPECT_EQ(*read_file(path), "one");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path.parent_path()), {}), 1);
}

TEST(File, ReadErrorsAreTold) {
  const auto folder = scratch();
  EXPECT_EQ(read_file(folder / "none").error().code, ErrorCode::kNotFound);
  std::filesystem::create_directories(folder);
  EXPECT_EQ(read_file(folder).error().code, ErrorCode::kIo);
  std::ofstream(folder / "big") << "12345";
  EXPECT_EQ(read_file(folder / "big", 4).error().code, ErrorCode::kOutOfRange);
}

TEST(File, IsOnTheDiskBeforeItReplacesTheOldOneAndSoIsItsName) {
  const auto path = scratch() / "file.txt";
  calls.clear();
  ASSERT_TRUE(write_file_atomically(path, "one").ok());
  EXPECT_EQ(calls, (std::vector<std::string>{"sync file", "rename", "sync folder"}));
}

TEST(File, AFailedSyncLeavesTheOldFile) {
  const auto path = scratch() / "file.txt";
  ASSERT_TRUE(write_file_atomically(path, "old").ok());
  fail_file_sync = EIO;
  const Status status = write_file_atomically(path, "new");
  fail_file_sync = 0;
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kIo);
  EXPECT_EQ(*read_file(path), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path.parent_path()), {}), 1);
}

TEST(File, IsReadToItsEndWhateverItsSizeSays) {
  // The kernel gives the files of /proc a size of 0.
  const auto status = read_file("/proc/self/status");
  ASSERT_TRUE(status.ok());
  EXPECT_NE(status->find("VmRSS"), std::string::npos);
  EXPECT_EQ(read_file("/proc/self/status", 10).error().code, ErrorCode::kOutOfRange);
}

TEST(File, OfTheGreatestSizeAllowedIsRead) {
  const auto path = scratch() / "file.txt";
  ASSERT_TRUE(write_file_atomically(path, "12345").ok());
  EXPECT_EQ(*read_file(path, 5), "12345");
  EXPECT_FALSE(read_file(path, 4).ok());
  ASSERT_TRUE(write_file_atomically(path, "").ok());
  EXPECT_EQ(*read_file(path, 0), "");
}

}  // namespace
}  // namespace furrow
