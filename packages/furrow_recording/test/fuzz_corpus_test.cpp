// Runs the fuzz targets over their seeds and past findings.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <functional>

#include "../fuzz/targets.hpp"
#include "recording_test_support.hpp"

namespace furrow::recording {
namespace {

using Target = std::function<void(std::span<const std::uint8_t>)>;

class FuzzCorpus : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path script = fuzz_ / "make_seeds.py";
    const std::string command =
        "python3 '" + script.string() + "' '" + seeds_.path().string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
  }

  /// Runs the target over its seeds and the inputs that fuzzing found.
  void run(const std::string& name, const Target& target) const {
    EXPECT_GT(run_folder(seeds_.path() / name, target), 0);
    if (const auto findings = fuzz_ / "findings" / name; std::filesystem::exists(findings)) {
      EXPECT_GT(run_folder(findings, target), 0);
    }
  }

 private:
  static int run_folder(const std::filesystem::path& folder, const Target& target) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      SCOPED_TRACE(entry.path().string());
      std::ifstream file(entry.path(), std::ios::binary);
      const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
      target({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
      ++files;
    }
    return files;
  }

  std::filesystem::path fuzz_ = std::filesystem::path(FURROW_TEST_DATA_DIR) / ".." / "fuzz";
  Folder seeds_;
};

TEST_F(FuzzCorpus, OfMcapFiles) {
  run("mcap", fuzz::read_mcap);
}
TEST_F(FuzzCorpus, OfBags) {
  run("bag", fuzz::read_bag);
}
TEST_F(FuzzCorpus, OfSqliteFiles) {
  run("db3", fuzz::read_db3);
}
TEST_F(FuzzCorpus, OfMessages) {
  run("message", fuzz::read_message);
}
TEST_F(FuzzCorpus, OfYaml) {
  run("yaml", fuzz::read_yaml);
}

}  // namespace
}  // namespace furrow::recording
