#include "furrow_core/output_path.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <optional>

#include "furrow_core/file.hpp"
#include "furrow_core/scratch_folder.hpp"

namespace furrow {
namespace {

namespace fs = std::filesystem;

void put(const fs::path& path, const std::string& text = "kept") {
  std::ofstream(path) << text;
}

Result<OutputFolder> claim(const fs::path& wanted, Overwrite overwrite = Overwrite::kNo) {
  return OutputFolder::claim(wanted, {"summary.json", "report.html"}, overwrite);
}

TEST(OutputFolder, IsTheOneAskedForWhereNothingIsYet) {
  const ScratchFolder scratch;
  const auto folder = claim(scratch.path() / "out" / "demo");
  ASSERT_TRUE(folder.ok()) << folder.error().message;
  EXPECT_EQ(folder->path(), scratch.path() / "out" / "demo");
  EXPECT_FALSE(folder->numbered());
  EXPECT_TRUE(fs::is_directory(folder->path()));
}

TEST(OutputFolder, WithEarlierResultsGetsTheNextFreeNumber) {
  const ScratchFolder scratch;
  for (const char* name : {"demo", "demo-2"}) {
    fs::create_directory(scratch.path() / name);
    put(scratch.path() / name / "report.html");
  }
  put(scratch.path() / "demo-3");  // a file of that name is passed over
  const auto folder = claim(scratch.path() / "demo");
  ASSERT_TRUE(folder.ok());
  EXPECT_EQ(folder->path(), scratch.path() / "demo-4");
  EXPECT_TRUE(folder->numbered());
  EXPECT_EQ(*read_file(scratch.path() / "demo" / "report.html"), "kept");
}

TEST(OutputFolder, WithOtherFilesIsNotTaken) {
  const ScratchFolder scratch;
  put(scratch.path() / "notes.txt");
  const auto folder = claim(scratch.path());
  ASSERT_TRUE(folder.ok());
  EXPECT_EQ(folder->path(), scratch.path());
}

TEST(OutputFolder, TrailingSlashIsNumberedAsTheFolder) {
  const ScratchFolder scratch;
  fs::create_directory(scratch.path() / "demo");
  put(scratch.path() / "demo" / "summary.json");
  const auto folder = claim((scratch.path() / "demo").string() + "/");
  ASSERT_TRUE(folder.ok());
  EXPECT_EQ(folder->path(), scratch.path() / "demo-2");
}

TEST(OutputFolder, IsOverwrittenWhenAskedTo) {
  const ScratchFolder scratch;
  put(scratch.path() / "summary.json");
  const auto folder = claim(scratch.path(), Overwrite::kYes);
  ASSERT_TRUE(folder.ok());
  EXPECT_EQ(folder->path(), scratch.path());
}

TEST(OutputFolder, ClaimedByAnotherProcessIsNotUsed) {
  const ScratchFolder scratch;
  const fs::path wanted = scratch.path() / "demo";
  const auto mine = claim(wanted);
  ASSERT_TRUE(mine.ok());
  const pid_t other = fork();
  if (other == 0) {
    const auto theirs = claim(wanted);
    const bool next = theirs.ok() && theirs->path() == scratch.path() / "demo-2";
    const bool refused = !claim(wanted, Overwrite::kYes).ok();
    _exit(next && refused ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(other, &status, 0), other);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(OutputFolder, ThatStayedEmptyIsRemoved) {
  const ScratchFolder scratch;
  std::optional<OutputFolder> folder = claim(scratch.path() / "demo").value();
  folder.reset();
  EXPECT_FALSE(fs::exists(scratch.path() / "demo"));
  fs::create_directory(scratch.path() / "own");
  folder = claim(scratch.path() / "own").value();
  folder.reset();
  EXPECT_TRUE(fs::exists(scratch.path() / "own"));
}

TEST(OutputFolder, ThatCannotBeWrittenIsRefused) {
  const ScratchFolder scratch;
  put(scratch.path() / "file");
  EXPECT_NE(claim(scratch.path() / "file").error().message.find("is not a folder"),
            std::string::npos);
  EXPECT_FALSE(claim(scratch.path() / "file" / "out").ok());
  EXPECT_FALSE(claim("/proc/self/furrow").ok());
  EXPECT_FALSE(claim("").ok());
}

TEST(OutputFile, DoesNotReplaceAnEarlierOne) {
  const ScratchFolder scratch;
  put(scratch.path() / "rows.json");
  auto file = OutputFile::claim(scratch.path() / "rows.json", Overwrite::kNo).value();
  EXPECT_EQ(file.path(), scratch.path() / "rows-2.json");
  EXPECT_TRUE(file.numbered());
  ASSERT_TRUE(file.write("new").ok());
  EXPECT_EQ(*read_file(scratch.path() / "rows.json"), "kept");
  EXPECT_EQ(*read_file(scratch.path() / "rows-2.json"), "new");
}

TEST(OutputFile, DoesNotReplaceOneThatCameSinceTheClaim) {
  const ScratchFolder scratch;
  auto file = OutputFile::claim(scratch.path() / "rows.json", Overwrite::kNo).value();
  EXPECT_FALSE(file.numbered());
  put(scratch.path() / "rows.json");
  ASSERT_TRUE(file.write("new").ok());
  EXPECT_EQ(file.path(), scratch.path() / "rows-2.json");
  EXPECT_EQ(*read_file(scratch.path() / "rows.json"), "kept");
}

TEST(OutputFile, ReplacesWhenAskedTo) {
  const ScratchFolder scratch;
  put(scratch.path() / "rows.json");
  auto file = OutputFile::claim(scratch.path() / "rows.json", Overwrite::kYes).value();
  ASSERT_TRUE(file.write("new").ok());
  EXPECT_EQ(*read_file(scratch.path() / "rows.json"), "new");
}

TEST(OutputFile, ClaimLeavesNothingBehind) {
  const ScratchFolder scratch;
  (void)OutputFile::claim(scratch.path() / "rows.json", Overwrite::kNo).value();
  EXPECT_TRUE(fs::is_empty(scratch.path()));
}

TEST(OutputFile, ThatCannotBeWrittenIsRefusedAtTheClaim) {
  const ScratchFolder scratch;
  put(scratch.path() / "file");
  for (const fs::path& path : {scratch.path(), scratch.path() / "file" / "rows.json",
                               fs::path("/proc/self/rows.json"), fs::path("")}) {
    EXPECT_FALSE(OutputFile::claim(path, Overwrite::kNo).ok()) << path;
  }
}

TEST(OutputFile, WritesADeviceAsItIs) {
  auto null = OutputFile::claim("/dev/null", Overwrite::kNo).value();
  ASSERT_TRUE(null.write("text").ok());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  auto full = OutputFile::claim("/dev/full", Overwrite::kNo).value();
  EXPECT_FALSE(full.write("text").ok());
}

}  // namespace
}  // namespace furrow
