#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "furrow_vision/annotated_image.hpp"

namespace furrow::cli {

/// A data set to be evaluated on.
struct EvaluationSet {
  std::string name;  ///< "rendered", "cwfid", "carrot_weed", or that of the file
  double resolution_mm_per_px = 1.15;
  annotation::Dataset dataset;
};

/// `images` pictures of this size with depth, drawn from `seed` with the plants of a species file
/// (empty: params/species_evaluation.yaml) in a mix of their own, written into `folder`. Throws.
[[nodiscard]] EvaluationSet render_evaluation_set(const std::filesystem::path& folder,
                                                  std::int64_t images, cv::Size size,
                                                  std::uint64_t seed,
                                                  const std::filesystem::path& species_file = {});

/// A folder of CWFID, of Carrot-Weed, or with a COCO file evaluation.json; or a COCO file. Throws
/// ConfigError.
[[nodiscard]] EvaluationSet open_evaluation_set(const std::filesystem::path& path);

}  // namespace furrow::cli
