#pragma once

#include <memory>
#include <string>
#include <vector>

#include "furrow_vision/detector_choice.hpp"

namespace furrow::evaluation {

/// Which detectors to run.
struct DetectorChoices {
  std::vector<std::string> detectors;  ///< "index", "one_stage", "mask_rcnn"; empty: all there are
  std::vector<std::string> models;     ///< model files; empty: the shipped ones
  std::vector<std::string> settings;   ///< "KEY=VALUE" of vision::DetectorParameters
};

struct NamedDetector {
  std::string name;
  std::unique_ptr<vision::Detector> detector;
};

/// The detectors that were chosen; without a choice the index detector and one for every given or
/// shipped model. A given model goes to the detector of its kind. Throws ConfigError.
[[nodiscard]] std::vector<NamedDetector> make_detectors(const DetectorChoices& choices);

}  // namespace furrow::evaluation
