#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "furrow_dds/dds_parameters.hpp"

namespace furrow::dds {

/// What the user is told when `available_bytes` of shared memory are too few for so many more
/// processes of these parameters. Empty: they are enough, or the parameters need none.
[[nodiscard]] std::string shared_memory_shortage(const DdsParameters& parameters,
                                                 std::size_t processes,
                                                 std::uint64_t available_bytes);

/// Free bytes of /dev/shm; nullopt where it is not known.
[[nodiscard]] std::optional<std::uint64_t> shared_memory_available_bytes();

/// Call before processes start. Removes the shared memory of killed processes first. A process that
/// writes to shared memory which the system does not have ends by SIGBUS, without a word. Throws
/// ConfigError for a shortage.
void check_shared_memory(const DdsParameters& parameters, std::size_t processes);

}  // namespace furrow::dds
