#include "furrow_dds/shared_memory_need.hpp"

#include <gtest/gtest.h>

namespace furrow::dds {
namespace {

DdsParameters segments_of(std::int64_t mb) {
  DdsParameters parameters;
  parameters.shm_segment_mb = mb;
  return parameters;
}

TEST(SharedMemoryNeed, IsASegmentAndThePortsOfEachProcess) {
  // Three processes of 32 and 1 MB.
  EXPECT_EQ(shared_memory_shortage(segments_of(32), 3, 99'000'000), "");
  const std::string text = shared_memory_shortage(segments_of(32), 3, 98'900'000);
  for (const char* part : {"/dev/shm has 98.9 MB free", "3 processes need 99 MB", "--shm-size=198m",
                           "shm_segment_mb=31", "udp"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
  }
}

TEST(SharedMemoryNeed, OffersNoSegmentWhereNoneFits) {
  const std::string text = shared_memory_shortage(segments_of(32), 1, 64'000);
  EXPECT_NE(text.find("1 process needs 33 MB"), std::string::npos) << text;
  EXPECT_EQ(text.find("shm_segment_mb"), std::string::npos) << text;
}

TEST(SharedMemoryNeed, IsNothingWithoutProcessesOrSharedMemory) {
  EXPECT_EQ(shared_memory_shortage(segments_of(32), 0, 0), "");
  DdsParameters udp = segments_of(32);
  udp.transports = {"udp"};
  EXPECT_EQ(shared_memory_shortage(udp, 5, 0), "");
}

}  // namespace
}  // namespace furrow::dds
