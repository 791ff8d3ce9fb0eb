#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "furrow_vision/evaluation.hpp"

namespace furrow::evaluation {

struct VisionRow {
  std::string dataset;
  std::string detector;
  vision::VisionScores scores;
  vision::ScoreIntervals intervals;  ///< 95 %, by bootstrap over images
  double ms_per_frame = 0.0;
};

/// One picture of the detections, beside the annotations.
struct VisionPicture {
  std::string dataset;
  std::string detector;
  std::string file;
  double miou = 0.0;  ///< of this image
  std::string jpeg;   ///< bytes
};

struct VisionReport {
  std::vector<VisionRow> rows;
  std::vector<VisionPicture> pictures;
  std::vector<std::pair<std::string, std::string>> parameters;
  std::uint64_t seed = 0;
  std::vector<std::string> notes = {};  ///< of the data sets, for the user; a line each
};

[[nodiscard]] std::string to_json(const VisionReport& report);
[[nodiscard]] std::string to_html(const VisionReport& report);
[[nodiscard]] std::string to_table(const VisionReport& report);

/// RFC 4648.
[[nodiscard]] std::string base64(const std::string& bytes);

}  // namespace furrow::evaluation
