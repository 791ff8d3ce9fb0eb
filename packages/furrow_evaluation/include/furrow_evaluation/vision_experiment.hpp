#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "furrow_evaluation/detector_choices.hpp"
#include "furrow_evaluation/vision_report.hpp"

namespace furrow::evaluation {

/// Detectors on data sets, scored against the annotations.
struct VisionExperiment {
  DetectorChoices detectors;
  std::vector<std::string> datasets = {"rendered"};  ///< "rendered", or see open_evaluation_set()
  std::optional<double> resolution_mm_per_px;        ///< nothing: that of the data set
  std::int64_t images = 40;                          ///< of the rendered set
  std::int64_t limit = 0;                            ///< images of each set; 0: all
  std::uint64_t seed = 900001;                       ///< of the rendered set
  std::filesystem::path species_file;                ///< see RenderedSet
  bool pictures = false;                             ///< whether the report shows some images
};

/// `progress` gets what is being done, and the share of it that is done, 0 to 1. Throws ConfigError
/// for what the user must mend, std::runtime_error when an image or a detector fails.
[[nodiscard]] VisionReport run(
    const VisionExperiment& experiment,
    const std::function<void(const std::string& stage, double share)>& progress);

}  // namespace furrow::evaluation
