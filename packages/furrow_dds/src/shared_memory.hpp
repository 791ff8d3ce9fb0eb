#pragma once

#include <fastdds/rtps/common/Locator.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace furrow::dds {

/// Where a reader listens in shared memory: on a port that no other one ever had. Fast DDS
/// takes away the memory of a port whose last owner has died, and makes it anew for the next owner,
/// but processes that had it open go on to write into what was taken away: on a port of its own
/// nobody has such a past. Empty where the host has no shared memory.
[[nodiscard]] eprosima::fastdds::rtps::LocatorList own_shm_locators(
    const eprosima::fastdds::rtps::SharedMemTransportDescriptor& transport);

/// The smallest port that own_shm_locators() gives; below are those of the RTPS standard.
inline constexpr std::uint32_t kFirstOwnShmPort = 0x10000;

/// Removes what processes left in `folder` when they were killed: segments whose lock file nobody
/// holds, and ports of own_shm_locators() that no reader holds; older than `age`, so that nobody is
/// just making them. Returns how many. What cannot be read or removed stays.
std::size_t remove_dead_shared_memory(const std::filesystem::path& folder,
                                      std::chrono::seconds age);

}  // namespace furrow::dds
