#include "furrow_simulation/photo_ground.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "check.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/parallel.hpp"
#include "furrow_core/random.hpp"
#include "view.hpp"

namespace furrow::simulation {
namespace {

constexpr int kMaxCells = 100'000;
constexpr int kMinLevel_px = 16;

GroundPhoto turned(const GroundPhoto& photo, int quarter_turns) {
  GroundPhoto out = photo;
  out.bgr = photo.bgr.clone();
  out.instance_id = photo.instance_id.clone();
  for (int turn = 0; turn < quarter_turns; ++turn) {
    const double last_x = out.bgr.cols - 1.0;
    cv::rotate(cv::Mat(out.bgr), out.bgr, cv::ROTATE_90_COUNTERCLOCKWISE);
    cv::rotate(cv::Mat(out.instance_id), out.instance_id, cv::ROTATE_90_COUNTERCLOCKWISE);
    for (auto& plant : out.plants) {
      if (plant.stem_px)
        plant.stem_px = Eigen::Vector2d(plant.stem_px->y(), last_x - plant.stem_px->x());
    }
  }
  return out;
}

void check(const GroundPhoto& photo, std::size_t number, const cv::Size& size) {
  const std::string name = "photo " + std::to_string(number);
  if (photo.bgr.empty() || photo.bgr.type() != CV_8UC3) {
    throw ConfigError(name + ": the picture must hold 8-bit BGR pixels");
  }
  if (photo.instance_id.type() != CV_32SC1 || photo.instance_id.size() != photo.bgr.size()) {
    throw ConfigError(name + ": the instances must be 32-bit integers of the picture's size");
  }
  if (photo.bgr.size() != size) {
    throw ConfigError(name + ": all photos must have the same size");
  }
  double low = 0.0;
  double high = 0.0;
  cv::minMaxLoc(photo.instance_id, &low, &high);
  if (low < -1.0 || high >= static_cast<double>(photo.plants.size())) {
    throw ConfigError(name + ": an instance has no plant");
  }
  for (const auto& plant : photo.plants) {
    if (plant.stem_px && !plant.stem_px->allFinite()) {
      throw ConfigError(name + ": a stem's place is not finite");
    }
  }
}

}  // namespace

void PhotoGroundParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "photo_resolution_mm_per_px",
           .unit = "mm",
           .description = "assumed ground resolution of the photos",
           .min = 0.02,
           .max = 20.0},
          photo_resolution_mm_per_px);
  v.visit({.name = "length_m",
           .unit = "m",
           .description = "length of the scene",
           .min = 0.1,
           .max = 1000.0},
          length_m);
  v.visit({.name = "width_m",
           .unit = "m",
           .description = "width of the scene",
           .min = 0.1,
           .max = 50.0},
          width_m);
  v.visit({.name = "quarter_turns",
           .description = "turns every photo counter-clockwise",
           .min = 0,
           .max = 3},
          quarter_turns);
  v.visit({.name = "vary_repeats", .description = "mirror and turn copies of a photo by half"},
          vary_repeats);
  v.visit({.name = "threads",
           .description = "threads that share a frame; they change the time, not the bytes",
           .min = 1,
           .max = 16},
          threads);
  camera.visit(v);
}

// The mask of a plant, in pixels of its photo.
struct PhotoGround::MaskedPlant {
  std::int64_t pixels = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Vector2d stem = Eigen::Vector2d::Zero();
  double radius = 0.0;
};

// The annotation that a plant of the field comes from.
struct PhotoGround::PlantOrigin {
  std::size_t cell;
  std::size_t instance;
};

std::vector<PhotoGround::MaskedPlant> PhotoGround::measure(const GroundPhoto& photo) {
  std::vector<MaskedPlant> masks(photo.plants.size());
  const auto each = [&](const auto& use) {
    for (int v = 0; v < photo.instance_id.rows; ++v) {
      const auto* row = photo.instance_id.ptr<std::int32_t>(v);
      for (int u = 0; u < photo.instance_id.cols; ++u) {
        if (row[u] >= 0) use(masks[static_cast<std::size_t>(row[u])], Eigen::Vector2d(u, v));
      }
    }
  };
  each([](MaskedPlant& mask, const Eigen::Vector2d& pixel) {
    ++mask.pixels;
    mask.sum += pixel;
  });
  for (std::size_t i = 0; i < masks.size(); ++i) {
    if (masks[i].pixels == 0) continue;
    masks[i].stem =
        photo.plants[i].stem_px.value_or(masks[i].sum / static_cast<double>(masks[i].pixels));
  }
  each([](MaskedPlant& mask, const Eigen::Vector2d& pixel) {
    mask.radius = std::max(mask.radius, (pixel - mask.stem).norm());
  });
  return masks;
}

PhotoGround::Photo PhotoGround::with_levels(const GroundPhoto& photo) {
  Photo result{.levels = {photo.bgr}, .instance_id = photo.instance_id};
  while (std::min(result.levels.back().cols, result.levels.back().rows) >= 2 * kMinLevel_px) {
    const cv::Mat& finer = result.levels.back();
    cv::Mat coarser;
    cv::resize(finer, coarser, {finer.cols / 2, finer.rows / 2}, 0.0, 0.0, cv::INTER_AREA);
    result.levels.push_back(coarser);
  }
  return result;
}

PhotoGround::PhotoGround(const std::vector<GroundPhoto>& photos,
                         const PhotoGroundParameters& parameters, std::uint64_t seed)
    : parameters_(checked(parameters)), effects_(parameters.camera, seed) {
  if (photos.empty()) throw ConfigError("photo ground: no photo");
  const int turns = static_cast<int>(std::clamp<std::int64_t>(parameters.quarter_turns, 0, 3));
  std::vector<GroundPhoto> upright;
  std::vector<std::vector<MaskedPlant>> masks;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    check(photos[i], i, photos.front().bgr.size());
    upright.push_back(turned(photos[i], turns));
    masks.push_back(measure(upright.back()));
    photos_.push_back(with_levels(upright.back()));
  }
  const cv::Size size = upright.front().bgr.size();
  lay_out(size, 1e-3 * parameters.photo_resolution_mm_per_px);

  std::vector<PlantOrigin> origins;
  Random random(seed, "photo layout");
  const auto cell_count = static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_);
  for (std::size_t i = 0; i < cell_count; ++i) {
    Cell cell;
    cell.photo = i % photos_.size();
    if (parameters.vary_repeats && i >= photos_.size()) {
      cell.half_turn = random.bernoulli(0.5);
      cell.mirror = random.bernoulli(0.5);
    }
    const GroundPhoto& photo = upright[cell.photo];
    cell.plant_index.assign(photo.plants.size(), -1);
    cells_.push_back(std::move(cell));
    for (std::size_t k = 0; k < photo.plants.size(); ++k) {
      const MaskedPlant& mask = masks[cells_.back().photo][k];
      if (mask.pixels == 0) continue;
      const field::Plant plant = plant_on_ground(photo.plants[k], mask, i, size);
      const bool inside = plant.p_F_m.x() >= 0.0 && plant.p_F_m.x() <= parameters.length_m &&
                          std::abs(plant.p_F_m.y()) <= 0.5 * parameters.width_m;
      if (!inside) continue;
      origins.push_back({i, k});
      field_.plants.push_back(plant);
    }
  }
  sort_plants(origins);
}

void PhotoGround::lay_out(const cv::Size& photo_size, double pixel_m) {
  cell_length_m_ = photo_size.height * pixel_m;
  cell_width_m_ = photo_size.width * pixel_m;
  const double rows = std::ceil(parameters_.length_m / cell_length_m_);
  const double columns = std::ceil(parameters_.width_m / cell_width_m_);
  if (!(rows * columns <= kMaxCells)) {
    throw ConfigError("photo ground: length and width need more than 100000 photos");
  }
  rows_ = static_cast<int>(rows);
  columns_ = static_cast<int>(columns);

  field_.name = "photos";
  field_.source = "photographs: " + std::to_string(photos_.size()) + " laid on " +
                  std::to_string(rows_ * columns_) + " places";
  field_.length_m = parameters_.length_m;
  field_.width_m = parameters_.width_m;
}

field::Plant PhotoGround::plant_on_ground(const PhotoPlant& annotated, const MaskedPlant& mask,
                                          std::size_t cell_number,
                                          const cv::Size& photo_size) const {
  const double pixel_m = 1e-3 * parameters_.photo_resolution_mm_per_px;
  const Cell& cell = cells_[cell_number];
  Eigen::Vector2d at = mask.stem;
  if (cell.half_turn) at = Eigen::Vector2d(photo_size.width - 1.0, photo_size.height - 1.0) - at;
  if (cell.mirror) at.x() = photo_size.width - 1.0 - at.x();
  const int row = static_cast<int>(cell_number) / columns_;
  const int column = static_cast<int>(cell_number) % columns_;
  field::Plant plant;
  plant.kind = annotated.kind;
  plant.species = annotated.species;
  plant.p_F_m = {(row + 1) * cell_length_m_ - (at.y() + 0.5) * pixel_m,
                 (column + 1 - 0.5 * columns_) * cell_width_m_ - (at.x() + 0.5) * pixel_m};
  plant.radius_m = std::max(mask.radius, 0.5) * pixel_m;
  plant.area_mm2 = 1e6 * static_cast<double>(mask.pixels) * pixel_m * pixel_m;
  return plant;
}

// Sorts the plants along x, numbers them, and notes their numbers in the cells.
void PhotoGround::sort_plants(const std::vector<PlantOrigin>& origins) {
  std::vector<std::size_t> order(field_.plants.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return field_.plants[a].p_F_m.x() < field_.plants[b].p_F_m.x();
  });
  std::vector<field::Plant> sorted;
  for (std::size_t n = 0; n < order.size(); ++n) {
    sorted.push_back(field_.plants[order[n]]);
    sorted.back().id = static_cast<std::int64_t>(n);
    const PlantOrigin& origin = origins[order[n]];
    cells_[origin.cell].plant_index[origin.instance] = static_cast<std::int32_t>(n);
  }
  field_.plants = std::move(sorted);
}

Frame PhotoGround::render(const geometry::PinholeCamera& camera, const Eigen::Isometry3d& X_FC,
                          std::uint64_t frame_index) {
  const auto& intrinsics = camera.intrinsics();
  Frame frame;
  frame.bgr.create(intrinsics.height_px, intrinsics.width_px, CV_8UC3);
  frame.bgr.setTo(cv::Scalar(0, 0, 0));
  frame.depth_m = cv::Mat::zeros(frame.bgr.size(), CV_32FC1);
  frame.plant_index.create(frame.bgr.size(), CV_32SC1);
  frame.plant_index.setTo(-1);
  if (!X_FC.matrix().allFinite() || X_FC.translation().z() < 0.02) return frame;
  const View view(intrinsics, X_FC);
  const int threads = static_cast<int>(std::clamp<std::int64_t>(parameters_.threads, 1, 16));
  const int level = level_for(intrinsics, X_FC.translation().z());
  parallel_bands(intrinsics.height_px, threads, [&](int first, int end) {
    for (int v = first; v < end; ++v) draw_row(view, level, v, frame);
  });
  list_plants(camera, view, frame);
  const Eigen::Vector3d travel_C = X_FC.linear().transpose() * Eigen::Vector3d::UnitX();
  effects_.apply(frame.bgr, frame.depth_m, frame_index,
                 std::abs(travel_C.y()) >= std::abs(travel_C.x()), threads);
  return frame;
}

// The level whose pixels on the ground are nearest in size to the view's, without being much
// coarser.
int PhotoGround::level_for(const geometry::CameraIntrinsics& intrinsics, double height_m) const {
  const double pixel_m = 1e-3 * parameters_.photo_resolution_mm_per_px;
  const double seen_m = height_m / std::max(intrinsics.fx_px, intrinsics.fy_px);
  const double finest = std::log2(1.25 * seen_m / pixel_m);
  const auto level_count = static_cast<int>(photos_.front().levels.size());
  return finest > 0.0 ? std::min(static_cast<int>(finest), level_count - 1) : 0;
}

void PhotoGround::draw_row(const View& view, int level, int v, Frame& frame) const {
  auto* bgr = frame.bgr.ptr<std::uint8_t>(v);
  auto* depth = frame.depth_m.ptr<float>(v);
  auto* index = frame.plant_index.ptr<std::int32_t>(v);
  const Eigen::Vector3d row_ray = view.ray({0.0, static_cast<double>(v)});
  const Eigen::Vector3d step = view.ray_step();
  for (int u = 0; u < frame.bgr.cols; ++u) {
    const Eigen::Vector3d ray = row_ray + u * step;
    if (!(ray.z() < -1e-6)) continue;
    const double distance = -view.position().z() / ray.z();
    const double x = view.position().x() + distance * ray.x();
    const double y = view.position().y() + distance * ray.y();
    if (!(x >= 0.0 && x < parameters_.length_m && std::abs(y) < 0.5 * parameters_.width_m)) {
      continue;
    }
    draw_pixel(x, y, level, bgr + 3 * static_cast<std::ptrdiff_t>(u), index[u]);
    depth[u] = static_cast<float>(distance);
  }
}

// Colour, interpolated between four pixels of the photo, and plant of a point of the ground.
void PhotoGround::draw_pixel(double x_m, double y_m, int level, std::uint8_t* bgr,
                             std::int32_t& index) const {
  const double left_m = 0.5 * columns_ * cell_width_m_;
  // Cells count along +x and +y; photos upwards along +x, to the right along -y.
  const double cells_x = x_m * (1.0 / cell_length_m_);
  const double cells_y = (y_m + left_m) * (1.0 / cell_width_m_);
  const int row = std::min(static_cast<int>(cells_x), rows_ - 1);
  const int column = std::clamp(static_cast<int>(cells_y), 0, columns_ - 1);
  const Cell& cell = cells_[static_cast<std::size_t>(row) * columns_ + column];
  double from_left = (column + 1) - cells_y;
  double from_top = (row + 1) - cells_x;
  if (cell.mirror) from_left = 1.0 - from_left;
  if (cell.half_turn) {
    from_left = 1.0 - from_left;
    from_top = 1.0 - from_top;
  }
  const cv::Mat& source = photos_[cell.photo].levels[static_cast<std::size_t>(level)];
  const int w = source.cols;
  const int h = source.rows;
  const double px = std::clamp(from_left * w - 0.5, 0.0, w - 1.0);
  const double py = std::clamp(from_top * h - 0.5, 0.0, h - 1.0);
  const auto x0 = static_cast<int>(px);
  const auto y0 = static_cast<int>(py);
  const int x1 = std::min(x0 + 1, w - 1);
  const auto part_x = static_cast<int>((px - x0) * 256.0);
  const auto part_y = static_cast<int>((py - y0) * 256.0);
  const auto* top = source.ptr<std::uint8_t>(y0);
  const auto* bottom = source.ptr<std::uint8_t>(std::min(y0 + 1, h - 1));
  for (int k = 0; k < 3; ++k) {
    const int high = top[3 * x0 + k] * (256 - part_x) + top[3 * x1 + k] * part_x;
    const int low = bottom[3 * x0 + k] * (256 - part_x) + bottom[3 * x1 + k] * part_x;
    bgr[k] = static_cast<std::uint8_t>((high * (256 - part_y) + low * part_y + 32768) >> 16);
  }
  const cv::Mat& instances = photos_[cell.photo].instance_id;
  const int ix = std::clamp(static_cast<int>(from_left * instances.cols), 0, instances.cols - 1);
  const int iy = std::clamp(static_cast<int>(from_top * instances.rows), 0, instances.rows - 1);
  const std::int32_t instance = instances.ptr<std::int32_t>(iy)[ix];
  if (instance >= 0) index = cell.plant_index[static_cast<std::size_t>(instance)];
}

void PhotoGround::list_plants(const geometry::PinholeCamera& camera, const View& view,
                              Frame& frame) const {
  std::map<std::int32_t, std::int64_t> visible;
  for (int v = 0; v < frame.plant_index.rows; ++v) {
    const auto* index = frame.plant_index.ptr<std::int32_t>(v);
    for (int u = 0; u < frame.plant_index.cols; ++u) {
      if (index[u] >= 0) ++visible[index[u]];
    }
  }
  for (const auto& [index, pixels] : visible) {
    const field::Plant& plant = field_.plants[static_cast<std::size_t>(index)];
    const auto stem = camera.project(view.pose_inverse() *
                                     Eigen::Vector3d(plant.p_F_m.x(), plant.p_F_m.y(), 0.0));
    if (!stem) continue;
    frame.plants.push_back({.plant_index = static_cast<std::size_t>(index),
                            .id = plant.id,
                            .visible_px = pixels,
                            .area_mm2 = plant.area_mm2,
                            .stem_px = *stem});
  }
}

}  // namespace furrow::simulation
