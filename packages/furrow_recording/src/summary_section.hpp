#pragma once

#include <optional>
#include <string>

#include "furrow_core/result.hpp"
#include "furrow_recording/byte_stream.hpp"
#include "furrow_recording/mcap_reader.hpp"
#include "furrow_recording/mcap_types.hpp"
#include "records.hpp"

namespace furrow::mcap {

/// The Footer record and its place.
struct Tail {
  Footer footer;
  std::uint64_t footer_offset = 0;
};

/// None when the file does not end with a footer and the magic bytes.
[[nodiscard]] Result<std::optional<Tail>> read_tail(const Source& source);

/// Reads the summary. kParse when its CRC does not match, or a record is malformed or out of place.
/// Empty when the file has none: every part of a summary is optional.
[[nodiscard]] Result<Summary> read_summary(const Source& source, const Tail& tail,
                                           const ReaderLimits& limits);

/// The end of a file, from DataEnd to the magic bytes. `position`: where it will stand; `data_crc`:
/// of all bytes before it. `summary.statistics` must be set.
[[nodiscard]] Bytes put_end_of_file(const Summary& summary, std::uint64_t position,
                                    std::uint32_t data_crc);

}  // namespace furrow::mcap
