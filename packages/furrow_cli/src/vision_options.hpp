#pragma once

#include <optional>

#include "command_line.hpp"
#include "furrow_evaluation/detector_choices.hpp"

namespace furrow::cli {

/// What the commands that look at images have in common.
struct VisionOptions {
  evaluation::DetectorChoices choices;
  std::optional<double> resolution_mm_per_px;
};

void add_vision_options(Command command, VisionOptions& options);

}  // namespace furrow::cli
