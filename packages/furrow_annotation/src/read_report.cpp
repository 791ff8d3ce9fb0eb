#include "furrow_annotation/read_report.hpp"

#include <algorithm>

namespace furrow::annotation {

void ReadReport::skip(std::string_view reason, std::string_view entry) {
  const auto found = std::find_if(skipped.begin(), skipped.end(),
                                  [&](const auto& known) { return known.reason == reason; });
  if (found != skipped.end()) {
    ++found->count;
  } else {
    skipped.push_back({std::string(reason), 1, std::string(entry)});
  }
}

std::size_t ReadReport::skipped_count() const {
  std::size_t count = 0;
  for (const SkippedAnnotations& reason : skipped) count += reason.count;
  return count;
}

std::vector<std::string> describe(const ReadReport& report, const std::string& file) {
  std::vector<std::string> lines;
  const auto add = [&](std::size_t count, const std::string& text) {
    lines.push_back(file + ": " + std::to_string(count) + " of " +
                    std::to_string(report.annotations) + " annotations " + text);
  };
  for (const SkippedAnnotations& skipped : report.skipped) {
    add(skipped.count, "skipped: " + skipped.reason + " (first: " + skipped.first_entry + ")");
  }
  if (report.box_only > 0) add(report.box_only, "have a box only: the box is taken as the mask");
  if (report.without_stem_keypoint > 0) {
    add(report.without_stem_keypoint,
        "have keypoints, but their category names none \"stem\": no stem was read");
  }
  for (const std::string& category : report.assumed_weeds) {
    lines.push_back(file + ": category '" + category +
                    "' is read as a weed: its \"supercategory\" is neither crop nor weed");
  }
  return lines;
}

}  // namespace furrow::annotation
