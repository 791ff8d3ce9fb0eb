#pragma once

#include <cstdint>
#include <string>

#include "referee.hpp"

namespace furrow::actuation::campaign {

/// One run of some seconds of simulated time with faults that follow from the seed. Returns the
/// violated invariant with what led to it, or empty.
[[nodiscard]] std::string run(std::uint64_t seed, Tally& tally);

}  // namespace furrow::actuation::campaign
