#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_simulation/camera_effects.hpp"
#include "furrow_simulation/scene.hpp"

namespace furrow::simulation {

class View;

/// One annotated plant of a photograph.
struct PhotoPlant {
  field::PlantKind kind = field::PlantKind::kWeed;
  std::string species;
  std::optional<Eigen::Vector2d> stem_px;  ///< nullopt: unknown, the mask's centroid is used
};

/// A photograph of the ground from above, with its plants.
struct GroundPhoto {
  cv::Mat bgr;          ///< 8UC3
  cv::Mat instance_id;  ///< 32SC1 of the same size: index into `plants`, -1 where there is none
  std::vector<PhotoPlant> plants;
};

struct PhotoGroundParameters {
  double photo_resolution_mm_per_px = 1.0;
  double length_m = 10.0;
  double width_m = 1.0;
  std::int64_t quarter_turns = 0;
  bool vary_repeats = true;
  std::int64_t threads = 1;
  CameraEffectParameters camera = CameraEffectParameters::none();

  void visit(ParameterVisitor& v);
};

/// Photographs laid side by side on the flat ground z = 0, so that a camera flies over real pixels.
/// The upper edge of a photo points along +x, after `quarter_turns` counter-clockwise. Photos
/// repeat in their order until they fill length and width. With `vary_repeats`, copies are mirrored
/// and turned by half at random. Length and width crop the photos; a plant with its stem outside is
/// left out. Outside them the depth is 0.
class PhotoGround final : public Scene {
 public:
  /// Throws ConfigError: no photo, sizes or types that do not match, an instance without its
  /// plant, a scene of more than 100 000 photos.
  PhotoGround(const std::vector<GroundPhoto>& photos, const PhotoGroundParameters& parameters,
              std::uint64_t seed);

  [[nodiscard]] const field::FieldModel& field() const override { return field_; }
  [[nodiscard]] Frame render(const geometry::PinholeCamera& camera, const Eigen::Isometry3d& X_FC,
                             std::uint64_t frame_index) override;

 private:
  struct MaskedPlant;
  struct PlantOrigin;
  struct Photo {
    std::vector<cv::Mat> levels;  ///< each half the size of the one before
    cv::Mat instance_id;          ///< of the first level
  };
  struct Cell {
    std::size_t photo = 0;
    bool half_turn = false;
    bool mirror = false;
    std::vector<std::int32_t> plant_index;  ///< by instance; -1 where it is left out
  };

  [[nodiscard]] static std::vector<MaskedPlant> measure(const GroundPhoto& photo);
  [[nodiscard]] static Photo with_levels(const GroundPhoto& photo);
  void lay_out(const cv::Size& photo_size, double pixel_m);
  [[nodiscard]] field::Plant plant_on_ground(const PhotoPlant& annotated, const MaskedPlant& mask,
                                             std::size_t cell, const cv::Size& photo_size) const;
  void sort_plants(const std::vector<PlantOrigin>& origins);
  [[nodiscard]] int level_for(const geometry::CameraIntrinsics& intrinsics, double height_m) const;
  void draw_row(const View& view, int level, int v, Frame& frame) const;
  void draw_pixel(double x_m, double y_m, int level, std::uint8_t* bgr, std::int32_t& index) const;
  void list_plants(const geometry::PinholeCamera& camera, const View& view, Frame& frame) const;

  PhotoGroundParameters parameters_;
  CameraEffects effects_;
  std::vector<Photo> photos_;
  std::vector<Cell> cells_;  ///< row by row along x, `columns_` in each from the right (-y)
  int rows_ = 0;
  int columns_ = 0;
  double cell_length_m_ = 0.0;
  double cell_width_m_ = 0.0;
  field::FieldModel field_;
};

}  // namespace furrow::simulation
