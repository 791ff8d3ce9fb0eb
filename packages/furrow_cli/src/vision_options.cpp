#include "vision_options.hpp"

namespace furrow::cli {

void add_vision_options(Command command, VisionOptions& options) {
  command
      .option("--detector,--detectors", options.choices.detectors,
              "default: index, and one for every model")
      .choices({"index", "one_stage", "mask_rcnn"});
  command.option("--model", options.choices.models,
                 "model file (.yaml) in place of the shipped one");
  command.option("--resolution", options.resolution_mm_per_px, "ground resolution, mm per pixel")
      .positive();
  command.option("--set", options.choices.settings,
                 "KEY=VALUE of the detector parameters of perception");
}

}  // namespace furrow::cli
