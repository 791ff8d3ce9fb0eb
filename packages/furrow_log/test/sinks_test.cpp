#include "furrow_log/sinks.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>

#include "furrow_core/file.hpp"

namespace furrow::log {
namespace {

namespace fs = std::filesystem;

class FileSink : public testing::Test {
 protected:
  FileSink() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~FileSink() override { fs::remove_all(folder_); }

  fs::path folder_ = fs::path(testing::TempDir()) / "furrow_log_sinks";
  fs::path file_ = folder_ / "run.log";
};

TEST_F(FileSink, SimulatedTimeIsInSeconds) {
  auto sink = make_file_sink(file_, Clock::kSimulated);
  ASSERT_TRUE(sink.ok()) << sink.error().message;
  EXPECT_TRUE((*sink)->write({Time::from_seconds(12.3456), Level::kWarn, "planner", "no pose", 0}));
  EXPECT_TRUE((*sink)->write({Time::from_seconds(12345.0), Level::kInfo, "a", "b", 3}));
  (*sink)->flush();
  EXPECT_EQ(*read_file(file_),
            "   12.346 s WARN  planner: no pose\n"
            "12345.000 s INFO  a: b (3 more of these)\n");
}

TEST_F(FileSink, UnixTimeIsLocalDateAndTime) {
  ::setenv("TZ", "UTC", 1);
  ::tzset();
  auto sink = make_file_sink(file_, Clock::kUnix);
  ASSERT_TRUE(sink.ok());
  // 2001-09-09 01:46:40 UTC is 10^9 s.
  EXPECT_TRUE((*sink)->write({Time::from_seconds(1e9 + 0.25), Level::kError, "axis", "x", 0}));
  (*sink)->flush();
  EXPECT_EQ(*read_file(file_), "2001-09-09 01:46:40.250 ERROR axis: x\n");
}

TEST_F(FileSink, ReplacesTheFileOfAnEarlierRun) {
  ASSERT_TRUE(write_file_atomically(file_, "old\n").ok());
  auto sink = make_file_sink(file_, Clock::kSimulated);
  ASSERT_TRUE(sink.ok());
  (*sink)->flush();
  EXPECT_EQ(*read_file(file_), "");
}

TEST_F(FileSink, AppendsAfterARestart) {
  ASSERT_TRUE(write_file_atomically(file_, "old\n").ok());
  auto sink = make_file_sink(file_, Clock::kSimulated, FileStart::kAppend);
  ASSERT_TRUE(sink.ok());
  EXPECT_TRUE((*sink)->write({Time::from_seconds(1.0), Level::kInfo, "a", "b"}));
  (*sink)->flush();
  EXPECT_EQ(*read_file(file_), "old\n    1.000 s INFO  a: b\n");
}

TEST_F(FileSink, ReplacesTheOlderFileToo) {
  EXPECT_EQ(older_log(file_).filename(), file_.stem().string() + ".1.log");
  ASSERT_TRUE(write_file_atomically(older_log(file_), "old\n").ok());
  ASSERT_TRUE(make_file_sink(file_, Clock::kSimulated).ok());
  EXPECT_FALSE(fs::exists(older_log(file_)));
}

TEST_F(FileSink, IsBounded) {
  auto sink = make_file_sink(file_, Clock::kSimulated);
  ASSERT_TRUE(sink.ok());
  const Line line{Time(), Level::kInfo, "a", std::string(1'000'000, 'x'), 0};
  for (int i = 0; i < 35; ++i) EXPECT_TRUE((*sink)->write(line));
  std::uintmax_t bytes = 0;
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    bytes += entry.file_size();
    ++files;
  }
  EXPECT_EQ(files, 2);
  EXPECT_LE(bytes, 2 * (10U << 20) + 1'000'100);
}

TEST_F(FileSink, FileThatCannotBeOpenedIsAnError) {
  const auto sink = make_file_sink("/proc/no_such_folder/run.log", Clock::kUnix);
  ASSERT_FALSE(sink.ok());
  EXPECT_EQ(sink.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace furrow::log
