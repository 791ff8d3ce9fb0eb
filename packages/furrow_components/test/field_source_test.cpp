#include "furrow_components/field_source.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace furrow::components {
namespace {

class FieldSource : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    const auto path = folder_ / name;
    std::filesystem::create_directories(folder_);
    std::ofstream(path) << text;
    return path;
  }
  std::string error(const std::filesystem::path& path) {
    try {
      (void)load_field(path, load_species({}), 2.0, 1);
    } catch (const ConfigError& failure) {
      return failure.what();
    }
    return "";
  }
  std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "field_source";
};

TEST_F(FieldSource, PresetIsGeneratedFromTheSeed) {
  const auto path = write("p.yaml", "name: test\nweeds_per_m2: 50\n");
  const auto species = load_species({});
  const auto a = load_field(path, species, 2.0, 7);
  const auto b = load_field(path, species, 2.0, 7);
  const auto c = load_field(path, species, 2.0, 8);
  EXPECT_EQ(a.length_m, 2.0);
  ASSERT_FALSE(a.plants.empty());
  ASSERT_EQ(a.plants.size(), b.plants.size());
  EXPECT_EQ(a.plants.front().p_F_m, b.plants.front().p_F_m);
  EXPECT_NE(a.plants.front().p_F_m, c.plants.front().p_F_m);
}

TEST_F(FieldSource, ErrorsNameTheFile) {
  EXPECT_NE(error(folder_ / "none.csv").find("none.csv: no such file"), std::string::npos);
  EXPECT_NE(error(write("f.txt", "x")).find("is not a field"), std::string::npos);
  EXPECT_NE(error(write("bad.csv", "id,kind\n1,tree\n")).find("bad.csv"), std::string::npos);
  EXPECT_NE(error(write("bad.geojson", "{")).find("bad.geojson"), std::string::npos);
  EXPECT_NE(error(write("p2.yaml", "\nweed_per_m2: 3\n"))
                .find("p2.yaml:2: weed_per_m2: unknown parameter; did you mean 'weeds_per_m2'?"),
            std::string::npos);
}

TEST_F(FieldSource, ShippedFilesLoad) {
  const auto params = std::filesystem::path(FURROW_TEST_DATA_DIR) / "../../../params";
  const auto species = load_species(params / "species.yaml");
  EXPECT_GE(species.all().size(), 13u);
  int presets = 0;
  for (const auto& entry : std::filesystem::directory_iterator(params / "fields")) {
    EXPECT_NO_THROW((void)load_field(entry.path(), species, 2.0, 1)) << entry.path();
    ++presets;
  }
  EXPECT_GE(presets, 5);
}

}  // namespace
}  // namespace furrow::components
