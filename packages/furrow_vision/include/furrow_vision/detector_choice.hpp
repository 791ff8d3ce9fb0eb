#pragma once

#include <memory>
#include <string>

#include "furrow_core/parameters.hpp"
#include "furrow_vision/index_detector.hpp"
#include "furrow_vision/mask_rcnn_detector.hpp"
#include "furrow_vision/one_stage_detector.hpp"

namespace furrow::vision {

/// Which detector, and the parameters of each: the index's under their own names, the others'
/// behind "one_stage_" and "mask_rcnn_".
struct DetectorParameters {
  std::string detector = "index";
  std::string model_file;  ///< of what was trained; unused by the index
  IndexDetectorParameters index;
  OneStageParameters one_stage;
  MaskRcnnParameters mask_rcnn;
  void visit(ParameterVisitor& v);
};

/// Throws ConfigError as the detectors' constructors do, and when a detector that needs a model
/// file is given none.
[[nodiscard]] std::unique_ptr<Detector> make_detector(const DetectorParameters& parameters);

}  // namespace furrow::vision
