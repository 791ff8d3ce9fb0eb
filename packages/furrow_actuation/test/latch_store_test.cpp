#include "furrow_actuation/latch_store.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "furrow_core/error.hpp"

namespace furrow::actuation {
namespace {

class LatchStoreTest : public ::testing::Test {
 protected:
  LatchStoreTest() { std::filesystem::remove_all(folder_); }
  ~LatchStoreTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("furrow_latches_" + std::to_string(::getpid()));
  std::filesystem::path file_ = folder_ / "axis_1.latches";
};

CauseSet set_of(std::initializer_list<SafetyCause> causes) {
  CauseSet set;
  for (const SafetyCause cause : causes) set.insert(cause);
  return set;
}

TEST_F(LatchStoreTest, ARestartFindsWhatWasLatched) {
  const CauseSet latched = set_of({SafetyCause::kValveFault, SafetyCause::kEmergencyStop});
  {
    LatchStore store(file_);
    EXPECT_TRUE(store.loaded().empty());
    store.keep(set_of({SafetyCause::kPeerLost}));
    store.keep(latched);
  }
  {
    LatchStore store(file_);
    EXPECT_EQ(store.loaded(), latched);
    store.keep({});
  }
  EXPECT_TRUE(LatchStore(file_).loaded().empty());
}

TEST_F(LatchStoreTest, EveryCauseIsKeptByItsName) {
  for (const SafetyRule& rule : safety_rules()) {
    { LatchStore(file_).keep(set_of({rule.cause})); }
    EXPECT_EQ(LatchStore(file_).loaded(), set_of({rule.cause})) << to_string(rule.cause);
  }
}

TEST_F(LatchStoreTest, ADamagedFileIsACauseOfItsOwn) {
  std::filesystem::create_directories(folder_);
  for (const char* text : {"", "furrow latches 1\n", "furrow latches 1\nno_such_cause\nend\n",
                           "furrow latches 2\nend\n", "furrow latches 1\nend\nmore\n"}) {
    std::ofstream(file_) << text;
    EXPECT_EQ(LatchStore(file_).loaded(), set_of({SafetyCause::kLatchesUnknown})) << text;
  }
}

TEST_F(LatchStoreTest, AFolderThatCannotBeWrittenIsAConfigurationError) {
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / "a_file") << "";
  EXPECT_THROW(LatchStore(folder_ / "a_file" / "axis_1.latches"), ConfigError);
}

}  // namespace
}  // namespace furrow::actuation
