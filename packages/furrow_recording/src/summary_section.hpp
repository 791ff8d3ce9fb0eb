#pragma once

#include <optional>
#include <string>

#include "data_section.hpp"
#include "furrow_core/result.hpp"
#include "furrow_recording/mcap_types.hpp"

namespace furrow::mcap {

/// The Footer record and what stands before it.
struct Tail {
  Footer footer;
  std::uint64_t footer_offset = 0;
};

/// None when the file does not end with a footer and the magic bytes.
[[nodiscard]] Result<std::optional<Tail>> read_tail(const Source& source);

/// kParse when the CRC does not fit, or a record is malformed or out of place.
[[nodiscard]] Result<Summary> read_summary(const Source& source, const Tail& tail,
                                           const ReaderLimits& limits);

}  // namespace furrow::mcap
