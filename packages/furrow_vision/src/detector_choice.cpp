#include "furrow_vision/detector_choice.hpp"

#include "furrow_core/error.hpp"

namespace furrow::vision {

void DetectorParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "detector",
           .description = "index: vegetation index and row position, without learning; one_stage: "
                          "a light network; mask_rcnn: a slower one of three parts",
           .choices = {"index", "one_stage", "mask_rcnn"}},
          detector);
  v.visit({.name = "model_file", .description = "of a trained detector; not used by the index"},
          model_file);
  index.visit(v);
  PrefixedVisitor one_stage_visitor(v, "one_stage_");
  one_stage.visit(one_stage_visitor);
  PrefixedVisitor mask_rcnn_visitor(v, "mask_rcnn_");
  mask_rcnn.visit(mask_rcnn_visitor);
}

std::unique_ptr<Detector> make_detector(const DetectorParameters& parameters) {
  if (parameters.detector == "index") return std::make_unique<IndexDetector>(parameters.index);
  if (parameters.model_file.empty()) {
    throw ConfigError("model_file: detector '" + parameters.detector + "' needs one");
  }
  if (parameters.detector == "one_stage") {
    return std::make_unique<OneStageDetector>(parameters.one_stage, parameters.model_file);
  }
  if (parameters.detector == "mask_rcnn") {
    return std::make_unique<MaskRcnnDetector>(parameters.mask_rcnn, parameters.model_file);
  }
  throw ConfigError("detector: '" + parameters.detector + "' is not known");
}

}  // namespace furrow::vision
