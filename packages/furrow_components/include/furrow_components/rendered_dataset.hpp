#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"
#include "furrow_field/species.hpp"

namespace furrow::components {

/// Least number of visible pixels of an annotated plant. A person cannot tell a blade below 3 x 4
/// pixels from a crumb of soil.
inline constexpr std::int64_t kLeastVisible_px = 12;

/// Ranges of a rendered data set. Each image draws its field, light, soil and camera pose from
/// them.
struct RenderedDatasetParameters {
  std::int64_t images = 100;
  std::int64_t width_px = 640;
  std::int64_t height_px = 480;
  double resolution_mm_per_px = 1.15;  ///< on the ground, before the scale varies
  double scale_variation = 0.2;        ///< camera height varies by 1 +- this
  double tilt_max_rad = 0.03;
  double yaw_max_rad = 0.08;
  double weeds_per_m2_min = 3.0;
  double weeds_per_m2_max = 80.0;
  std::vector<double> weed_shares;  ///< in the order of the species table's weeds; empty: equal
  double crop_share = 0.85;         ///< share of the images with a crop row
  double variety = 0.0;             ///< of light, soil, sizes and forms; see random_appearance
  std::int64_t sequence_frames = 1;
  double velocity_mps = 0.5;  ///< within a sequence
  double frame_rate_hz = 5.0;
  double validation_share = 0.15;
  double evaluation_share = 0.15;
  bool depth = false;  ///< also write depth images
  std::int64_t threads = 2;

  void visit(ParameterVisitor& v);
};

/// Renders a data set of the structure of SB21 (Ahmadi et al. 2024): images/, and COCO annotations
/// with stems and robot pose in train.json, validation.json and evaluation.json. With
/// sequence_frames above 1 each labelled image is the last of a sequence. The frames before it have
/// pose and velocity but no labels. Images and their order depend on parameters, species and seed
/// only. `progress` gets the number of labelled images done. Fails with kIo, or with the error of
/// the field generator.
[[nodiscard]] Status render_dataset(const RenderedDatasetParameters& parameters,
                                    const field::SpeciesTable& species, std::uint64_t seed,
                                    const std::filesystem::path& folder,
                                    const std::function<void(std::int64_t)>& progress);

}  // namespace furrow::components
