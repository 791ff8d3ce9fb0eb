#pragma once

#include <cstddef>
#include <string>

#include "furrow_core/result.hpp"
#include "furrow_vision/annotated_image.hpp"

/// Which images show the same place. split_dataset keeps images of one sequence together:
/// neighbours show the same plants, so that a test on them says nothing about another row.
namespace furrow::vision {

/// Images whose paths have the same match of `pattern` (ECMAScript) become one sequence. The first
/// group of the pattern counts, or the whole match where it has none. Returns the number of
/// sequences. kInvalidArgument: not a pattern, or an image's path does not match.
[[nodiscard]] Result<std::size_t> group_by_path(const std::string& pattern, Dataset& dataset);

/// Images less than `gap_s` after the one before them become one sequence. The time is the image's
/// stamp, or else its file name: digits that are a Unix time in s, ms, us or ns. Returns the number
/// of sequences. kInvalidArgument: an image has neither.
[[nodiscard]] Result<std::size_t> group_by_time(double gap_s, Dataset& dataset);

}  // namespace furrow::vision
