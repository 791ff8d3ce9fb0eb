#include "furrow_evaluation/image_detection.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "furrow_core/scratch_folder.hpp"

namespace furrow::evaluation {
namespace {

namespace fs = std::filesystem;

TEST(PicturePath, IsNamedAfterTheImage) {
  const ScratchFolder scratch;
  EXPECT_EQ(picture_path(scratch.path(), "in/plant.jpg", {}, Overwrite::kNo),
            scratch.path() / "plant.png");
}

TEST(PicturePath, IsNeverAnImageThatIsStillToBeRead) {
  const ScratchFolder scratch;
  const std::vector<fs::path> images = {scratch.path() / "plant.png",
                                        scratch.path() / "plant-2.png"};
  for (const fs::path& image : images) std::ofstream(image) << "pixels";
  for (const Overwrite overwrite : {Overwrite::kNo, Overwrite::kYes}) {
    EXPECT_EQ(picture_path(scratch.path(), images[0], images, overwrite),
              scratch.path() / "plant-3.png");
  }
}

TEST(PicturePath, KnowsAFileByAnyOfItsNames) {
  const ScratchFolder scratch;
  std::ofstream(scratch.path() / "plant.png") << "pixels";
  fs::create_directory_symlink(scratch.path(), scratch.path() / "link");
  EXPECT_EQ(picture_path(scratch.path() / "link", "plant.png", {scratch.path() / "plant.png"},
                         Overwrite::kYes),
            scratch.path() / "link" / "plant-2.png");
}

TEST(PicturePath, ReplacesAnOtherFileOnlyWhenAskedTo) {
  const ScratchFolder scratch;
  std::ofstream(scratch.path() / "plant.png") << "pixels";
  EXPECT_EQ(picture_path(scratch.path(), "in/plant.jpg", {}, Overwrite::kNo),
            scratch.path() / "plant-2.png");
  EXPECT_EQ(picture_path(scratch.path(), "in/plant.jpg", {}, Overwrite::kYes),
            scratch.path() / "plant.png");
}

}  // namespace
}  // namespace furrow::evaluation
