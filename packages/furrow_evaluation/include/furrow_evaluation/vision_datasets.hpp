#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

#include "furrow_annotation/dataset.hpp"

namespace furrow::evaluation {

/// A data set to evaluate detectors on.
struct EvaluationSet {
  std::string name;                    ///< "rendered", "cwfid", "carrot_weed", or that of the file
  double resolution_mm_per_px = 1.15;  ///< on the ground
  bool resolution_known = true;        ///< false: assumed, as nothing says it
  annotation::Dataset dataset;
  std::vector<std::string> notes = {};  ///< skipped annotations and assumptions, a line each
};

/// Rendered images with depth, in a mix of species of their own.
struct RenderedSet {
  std::int64_t images = 100;
  cv::Size size_px = {640, 480};
  std::uint64_t seed = 1;
  std::filesystem::path species_file;  ///< empty: params/species_evaluation.yaml
};

/// Renders the images into `folder`; `progress` gets the share that is done, 0 to 1. Throws
/// ConfigError for a bad species file, std::runtime_error when a file cannot be written.
[[nodiscard]] EvaluationSet render_evaluation_set(const RenderedSet& wanted,
                                                  const std::filesystem::path& folder,
                                                  const std::function<void(double)>& progress);

/// Opens a folder of CWFID or Carrot-Weed, a folder with a COCO file evaluation.json, or a COCO
/// file. Throws ConfigError.
[[nodiscard]] EvaluationSet open_evaluation_set(const std::filesystem::path& path);

}  // namespace furrow::evaluation
