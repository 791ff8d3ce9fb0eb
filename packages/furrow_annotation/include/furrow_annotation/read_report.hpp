#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace furrow::annotation {

/// Annotations that were left out for one reason.
struct SkippedAnnotations {
  std::string reason;       ///< "polygon of fewer than three corners"
  std::size_t count = 0;    ///< annotations, or parts of one
  std::string first_entry;  ///< "annotations[12].segmentation"
};

/// What a reader left out of a data set or assumed about it. A command shows describe() to its
/// user: nothing is left out in silence.
struct ReadReport {
  std::size_t annotations = 0;  ///< listed in the file
  std::vector<SkippedAnnotations> skipped;
  std::size_t box_only = 0;        ///< annotations whose mask is their box
  std::size_t ignore_regions = 0;  ///< annotations that are regions to ignore (iscrowd)
  /// Annotations with keypoints of a category that has none of the stem's name: no stem was read.
  std::size_t without_stem_keypoint = 0;
  /// Categories in use that say neither "crop" nor "weed", and are read as weeds.
  std::vector<std::string> assumed_weeds;

  void skip(std::string_view reason, std::string_view entry);
  [[nodiscard]] std::size_t skipped_count() const;
};

/// One line for each finding, "FILE: 3 of 120 annotations left out: ..."; nothing to say: no line.
[[nodiscard]] std::vector<std::string> describe(const ReadReport& report, const std::string& file);

}  // namespace furrow::annotation
