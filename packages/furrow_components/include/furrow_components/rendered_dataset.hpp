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

/// An image's annotations hold the plants that it shows this many pixels of and more: less than a
/// blade of 3 x 4 pixels nobody tells from a crumb of soil.
inline constexpr std::int64_t kLeastVisible_px = 12;

/// How a rendered data set is drawn. Every image has a field, a light, a soil and a camera pose of
/// its own, within these ranges.
struct RenderedDatasetParameters {
  std::int64_t images = 100;
  std::int64_t width_px = 640;
  std::int64_t height_px = 480;
  double resolution_mm_per_px = 1.15;  ///< on the ground, before the scale varies
  double scale_variation = 0.2;        ///< camera height, 1 +-
  double tilt_max_rad = 0.03;
  double yaw_max_rad = 0.08;
  double weeds_per_m2_min = 3.0;
  double weeds_per_m2_max = 80.0;
  std::vector<double> weed_shares;  ///< beside the weeds of the species table; empty: equal
  double crop_share = 0.85;         ///< images with a crop row
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

/// Renders a data set of the structure of SB21 (Ahmadi et al. 2024): images/, annotations as COCO
/// with stems and robot pose, split into train.json, validation.json and evaluation.json. With
/// sequence_frames above 1 each labelled image is the last of a sequence, whose frames before it
/// carry pose and velocity and no labels. The pictures and their order depend only on parameters,
/// species and seed. `progress` is called with the number of labelled images done. Fails with kIo,
/// or with what the field generator refuses.
[[nodiscard]] Status render_dataset(const RenderedDatasetParameters& parameters,
                                    const field::SpeciesTable& species, std::uint64_t seed,
                                    const std::filesystem::path& folder,
                                    const std::function<void(std::int64_t)>& progress);

}  // namespace furrow::components
