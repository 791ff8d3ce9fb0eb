#include "shared_memory.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <fstream>
#include <set>
#include <string>

namespace furrow::dds {
namespace {

namespace fs = std::filesystem;
using eprosima::fastdds::rtps::LocatorList;
using eprosima::fastdds::rtps::SharedMemTransportDescriptor;

TEST(SharedMemory, EveryReaderGetsItsOwnPort) {
  const SharedMemTransportDescriptor transport;
  std::set<std::uint32_t> ports;
  for (int i = 0; i < 100; ++i) {
    const LocatorList own = own_shm_locators(transport);
    ASSERT_EQ(own.size(), 1U);
    EXPECT_EQ(own.begin()->kind, LOCATOR_KIND_SHM);
    EXPECT_GE(own.begin()->port, kFirstOwnShmPort);
    ports.insert(own.begin()->port);
  }
  EXPECT_GT(ports.size(), 95U);
}

class DeadSharedMemory : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / ("dead_shared_memory_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void make(const std::string& name) const {
    for (const std::string& file : {name, name + "_el"}) {
      std::ofstream(folder_ / file) << "memory";
      fs::last_write_time(folder_ / file,
                          fs::file_time_type::clock::now() - std::chrono::minutes(5));
    }
  }
  [[nodiscard]] std::set<std::string> left() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

  fs::path folder_;
};

TEST_F(DeadSharedMemory, RemovesOnlyUnlockedFiles) {
  make("fastrtps_0123456789abcdef");  // of a killed process
  make("fastrtps_port200000");
  std::ofstream(folder_ / "sem.fastrtps_port200000_mutex") << "mutex";
  make("fastrtps_port300000");  // created by a writer, without a lock
  fs::remove(folder_ / "fastrtps_port300000_el");
  make("fastrtps_00000000000000aa");  // a segment before its lock
  fs::remove(folder_ / "fastrtps_00000000000000aa_el");
  make("fastrtps_fedcba9876543210");  // held below
  make("fastrtps_port400000");        // held below
  make("fastrtps_port7411");          // a port of the RTPS standard: may be used again
  make("fastrtps_port200000x");
  make("fastrtps_0123");
  make("other_0123456789abcdef");
  make("fastrtps_aaaaaaaaaaaaaaaa");
  fs::last_write_time(folder_ / "fastrtps_aaaaaaaaaaaaaaaa_el", fs::file_time_type::clock::now());

  const int held = ::open((folder_ / "fastrtps_fedcba9876543210_el").c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_GE(held, 0);
  ASSERT_EQ(::flock(held, LOCK_EX | LOCK_NB), 0);
  const int port = ::open((folder_ / "fastrtps_port400000_el").c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_GE(port, 0);
  ASSERT_EQ(::flock(port, LOCK_EX | LOCK_NB), 0);

  std::set<std::string> expected = left();
  for (const char* gone :
       {"fastrtps_0123456789abcdef", "fastrtps_0123456789abcdef_el", "fastrtps_port200000",
        "fastrtps_port200000_el", "sem.fastrtps_port200000_mutex", "fastrtps_port300000"}) {
    expected.erase(gone);
  }
  EXPECT_EQ(remove_dead_shared_memory(folder_, std::chrono::seconds(60)), 3U);
  EXPECT_EQ(left(), expected);
  ::close(held);
  ::close(port);
}

TEST_F(DeadSharedMemory, AMissingFolderHoldsNothing) {
  EXPECT_EQ(remove_dead_shared_memory(folder_ / "nothing", std::chrono::seconds(0)), 0U);
}

}  // namespace
}  // namespace furrow::dds
