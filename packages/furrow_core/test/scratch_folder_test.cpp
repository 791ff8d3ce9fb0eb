#include "furrow_core/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace furrow {
namespace {

TEST(ScratchFolder, ExistsUntilTheObjectIsDestroyedAndTakesItsFilesAlong) {
  std::filesystem::path path;
  {
    const ScratchFolder scratch;
    path = scratch.path();
    std::ofstream(path / "file") << "text";
    EXPECT_TRUE(std::filesystem::exists(path / "file"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(ScratchFolder, IsAnotherOneEachTime) {
  const ScratchFolder first;
  const ScratchFolder second;
  EXPECT_NE(first.path(), second.path());
}

}  // namespace
}  // namespace furrow
