// The MCAP project's conformance set, by its published rules: every file through every tool.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "furrow_recording/recording_copy.hpp"
#include "furrow_recording/recording_summary.hpp"
#include "recording_test_support.hpp"

namespace furrow::recording {
namespace {

struct Expected {
  std::string name;
  std::uint64_t messages = 0;
  std::uint64_t channels = 0;
  std::uint64_t schemas = 0;
  std::uint64_t attachments = 0;
  std::uint64_t metadata = 0;
  std::uint64_t chunks = 0;
};

class Conformance : public testing::Test {
 protected:
  void SetUp() override {
    const std::string script = std::string(FURROW_TEST_DATA_DIR) + "/conformance/generate.py";
    ASSERT_EQ(std::system(("python3 '" + script + "' '" + folder_.path().string() + "'").c_str()),
              0);
    std::ifstream lines(folder_.path() / "expected.tsv");
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      Expected file;
      words >> file.name >> file.messages >> file.channels >> file.schemas >> file.attachments >>
          file.metadata >> file.chunks;
      ASSERT_FALSE(words.fail()) << line;
      files_.push_back(file);
    }
    ASSERT_EQ(files_.size(), 416U);
  }

  [[nodiscard]] std::filesystem::path path(const Expected& file) const {
    return folder_.path() / (file.name + ".mcap");
  }

  static void expect_counts(const std::filesystem::path& file, const Expected& expected) {
    const auto reader = open_recording(file);
    ASSERT_TRUE(reader.ok()) << reader.error().message;
    const RecordingInfo& info = (*reader)->info();
    EXPECT_TRUE(info.whole()) << info.damage;
    EXPECT_EQ(info.statistics().message_count, expected.messages);
    EXPECT_EQ(info.summary.channels.size(), expected.channels);
    EXPECT_EQ(info.summary.schemas.size(), expected.schemas);
    EXPECT_EQ(info.summary.attachments.size(), expected.attachments);
    EXPECT_EQ(info.summary.metadata.size(), expected.metadata);
    std::uint64_t read = 0;
    Time last;
    const auto stream = (*reader)->messages({});
    while (true) {
      const auto next = stream->next();
      ASSERT_TRUE(next.ok()) << next.error().message;
      if (!*next) {
        break;
      }
      EXPECT_LE(last, (*next)->log_time);
      last = (*next)->log_time;
      ++read;
    }
    EXPECT_EQ(read, expected.messages);
  }

  Folder folder_;
  std::vector<Expected> files_;
};

TEST_F(Conformance, InfoCountsEveryRecord) {
  for (const Expected& file : files_) {
    SCOPED_TRACE(file.name);
    expect_counts(path(file), file);
  }
}

TEST_F(Conformance, VerifyFindsNoFaults) {
  for (const Expected& file : files_) {
    SCOPED_TRACE(file.name);
    const auto report = verify_recording(path(file));
    ASSERT_TRUE(report.ok()) << report.error().message;
    EXPECT_EQ(report->faults, Lines());
    EXPECT_TRUE(report->closed);
    EXPECT_EQ(report->messages, file.messages);
    EXPECT_EQ(report->chunks, file.chunks);
  }
}

TEST_F(Conformance, CutAndRecoverKeepEverything) {
  for (const Expected& file : files_) {
    for (const bool scan : {false, true}) {
      SCOPED_TRACE(file.name + (scan ? " recover" : " cut"));
      CopyJob job;
      job.inputs = {path(file)};
      job.output = folder_.path() / "copy.mcap";
      job.open.scan = scan;
      const auto report = run_copy(job);
      ASSERT_TRUE(report.ok()) << report.error().message;
      EXPECT_TRUE(report->complete());
      EXPECT_EQ(report->messages, file.messages);
      EXPECT_EQ(report->attachments, file.attachments);
      EXPECT_EQ(report->metadata, file.metadata);
      EXPECT_EQ(verify_recording(job.output)->faults, Lines());
      expect_counts(job.output, file);
      std::filesystem::remove(job.output);
    }
  }
}

}  // namespace
}  // namespace furrow::recording
