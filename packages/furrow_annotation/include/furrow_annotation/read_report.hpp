#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace furrow::annotation {

/// Annotations that were skipped for one reason.
struct SkippedAnnotations {
  std::string reason;       ///< "polygon of fewer than three corners"
  std::size_t count = 0;    ///< annotations, or parts of one
  std::string first_entry;  ///< "annotations[12].segmentation"
};

/// Annotations that a reader skipped, and its assumptions. Commands must show describe() to the
/// user: nothing is skipped silently.
struct ReadReport {
  std::size_t annotations = 0;  ///< listed in the file
  std::vector<SkippedAnnotations> skipped;
  std::size_t box_only = 0;        ///< annotations whose mask is their box
  std::size_t ignore_regions = 0;  ///< annotations that are regions to ignore (iscrowd)
  /// Annotations with keypoints whose category names none "stem": they have no stem.
  std::size_t without_stem_keypoint = 0;
  /// Categories in use that are neither crop nor weed; they are read as weeds.
  std::vector<std::string> assumed_weeds;

  void skip(std::string_view reason, std::string_view entry);
  [[nodiscard]] std::size_t skipped_count() const;
};

/// One line for each finding: "FILE: 3 of 120 annotations skipped: ...".
[[nodiscard]] std::vector<std::string> describe(const ReadReport& report, const std::string& file);

}  // namespace furrow::annotation
