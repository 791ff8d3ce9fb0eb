#pragma once

#include <fastdds/rtps/common/Locator.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace furrow::dds {

/// A shared-memory port for one reader that no other reader ever used. Fast DDS replaces the memory
/// of a port whose owner died; a process with the port open goes on writing into the old memory. No
/// process has an unused port open. Empty if the host has no shared memory.
[[nodiscard]] eprosima::fastdds::rtps::LocatorList own_shm_locators(
    const eprosima::fastdds::rtps::SharedMemTransportDescriptor& transport);

/// The smallest port of own_shm_locators(). Smaller ones belong to the RTPS standard.
inline constexpr std::uint32_t kFirstOwnShmPort = 0x10000;

/// Removes the shared memory of killed processes from `folder`: segments, and ports of
/// own_shm_locators(), without a locked file. They must be older than `age`, so that no process is
/// just creating them. Returns their number. Files that cannot be read or removed stay.
std::size_t remove_dead_shared_memory(const std::filesystem::path& folder,
                                      std::chrono::seconds age);

}  // namespace furrow::dds
