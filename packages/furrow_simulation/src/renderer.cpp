#include "furrow_simulation/renderer.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <mutex>

#include "check.hpp"
#include "furrow_core/parallel.hpp"
#include "furrow_core/random.hpp"
#include "ground_atlas.hpp"
#include "plant_cache.hpp"
#include "plant_raster.hpp"
#include "view.hpp"

namespace furrow::simulation {
namespace {

constexpr double kMaxCoordinate_m = 4990.0;
constexpr double kMinHeight_m = 0.08;
// Half the side of the window, in blocks: it touches at most GroundAtlas::kMaxBlocks of them.
constexpr double kHalfWindow_blocks = 0.5 * GroundAtlas::kMaxBlocks - 0.6;
constexpr std::array<std::uint8_t, 3> kSky_bgr = {214, 205, 196};

bool is_usable(const Eigen::Isometry3d& X_FC) {
  return X_FC.matrix().allFinite() && X_FC.translation().cwiseAbs().maxCoeff() < kMaxCoordinate_m;
}

// A texel's channels in 16 bits each; from the lowest: blue, red, green, shade.
std::uint64_t spread(const GroundTexel& texel) {
  return (texel.bgrs & 0x00FF00FFu) | static_cast<std::uint64_t>(texel.bgrs & 0xFF00FF00u) << 24;
}

// The part of the ground that the camera sees, within reach.
GroundAtlas::Window visible_window(const View& view, double texel_m) {
  const double reach = kHalfWindow_blocks * GroundBlock::kSize * texel_m;
  const Eigen::Vector2d nadir = view.position().head<2>();
  const auto hit = [&](const Eigen::Vector2d& pixel) -> Eigen::Vector2d {
    const Eigen::Vector3d ray = view.ray(pixel);
    const double steepness = std::max(-ray.z(), 1e-3 * ray.head<2>().norm() + 1e-9);
    return nadir + ray.head<2>() * (view.position().z() / steepness);
  };
  const auto& camera = view.intrinsics();
  const double w = camera.width_px - 0.5;
  const double h = camera.height_px - 0.5;
  const Eigen::Vector3d middle_ray = view.ray({0.5 * (w - 0.5), 0.5 * (h - 0.5)});
  const Eigen::Vector2d centre = middle_ray.z() < -0.3 * middle_ray.head<2>().norm()
                                     ? hit({0.5 * (w - 0.5), 0.5 * (h - 0.5)})
                                     : nadir;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector2d high = -low;
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(w, -0.5),
                                       Eigen::Vector2d(-0.5, h), Eigen::Vector2d(w, h)}) {
    low = low.cwiseMin(hit(pixel));
    high = high.cwiseMax(hit(pixel));
  }
  // Ground above or below z = 0 is seen elsewhere, by the tangent of the ray's angle.
  low = (low.array() - 0.04).cwiseMax(centre.array() - reach).cwiseMin(centre.array() + reach);
  high = (high.array() + 0.04).cwiseMin(centre.array() + reach).cwiseMax(centre.array() - reach);
  const auto texel = [&](double v) { return static_cast<std::int32_t>(std::floor(v / texel_m)); };
  return {texel(low.x()), texel(low.y()), texel(high.x()), texel(high.y())};
}

}  // namespace

class Renderer::Implementation {
 public:
  Implementation(field::FieldModel field, const RendererParameters& parameters, std::uint64_t seed,
                 const field::SpeciesTable& species)
      : field_(std::move(field)),
        species_(species),
        parameters_(checked(parameters)),
        light_(parameters.light),
        ground_(parameters.ground, light_, seed),
        atlas_(ground_),
        plants_(field_, species_, parameters_.plants, light_, ground_, seed),
        texture_(seed, parameters.plants.leaf_damage),
        effects_(parameters.camera, seed),
        seed_(seed) {}

  [[nodiscard]] const field::FieldModel& field() const { return field_; }
  [[nodiscard]] const Ground& ground() const { return ground_; }
  [[nodiscard]] double plant_area_mm2(std::size_t plant_index) {
    return plants_.get(plant_index).mesh.top_area_mm2;
  }

  Frame render(const geometry::PinholeCamera& camera, const Eigen::Isometry3d& X_FC,
               std::uint64_t frame_index) {
    const auto& intrinsics = camera.intrinsics();
    Frame frame;
    // Drawn in buffers that are kept; the camera's effects write into the frame's own.
    bgr_.create(intrinsics.height_px, intrinsics.width_px, CV_8UC3);
    depth_m_.create(bgr_.size(), CV_32FC1);
    depth_m_.setTo(0.0);
    frame.bgr = bgr_;
    frame.depth_m = depth_m_;
    frame.plant_index.create(frame.bgr.size(), CV_32SC1);
    frame.plant_index.setTo(-1);
    if (!is_usable(X_FC)) {
      frame.bgr.setTo(cv::Scalar(kSky_bgr[0], kSky_bgr[1], kSky_bgr[2]));
      return owning(std::move(frame));
    }
    plants_.forget_unused();
    const View view(intrinsics, X_FC);
    const int threads = static_cast<int>(std::clamp<std::int64_t>(parameters_.threads, 1, 16));
    const RobotShadow shadow(parameters_.light, view);

    GroundAtlas::Window window;
    const bool above_ground = X_FC.translation().z() > kMinHeight_m;
    std::vector<PlacedPlant> placed;
    if (above_ground) {
      window = visible_window(view, ground_.texel_m());
      atlas_.prepare(
          window,
          [&](std::int32_t x, std::int32_t y, std::vector<ShadowTriangle>& casters) {
            gather_casters(x, y, casters);
          },
          threads);
      placed = place_plants(view, window, frame_index);
    }

    std::mutex merging;
    parallel_bands(intrinsics.height_px, threads, [&](int first, int end) {
      const std::vector<std::int64_t> visible =
          draw_rows(view, above_ground ? &window : nullptr, shadow, placed, first, end, frame);
      const std::lock_guard lock(merging);
      for (std::size_t i = 0; i < placed.size(); ++i) placed[i].visible_px += visible[i];
    });
    list_plants(placed, frame);
    const Eigen::Vector3d travel_C = X_FC.linear().transpose() * Eigen::Vector3d::UnitX();
    effects_.apply(frame.bgr, frame.depth_m, frame_index,
                   std::abs(travel_C.y()) >= std::abs(travel_C.x()), threads);
    return owning(std::move(frame));
  }

 private:
  // Draws rows [first, end) and returns the visible pixels of each plant. Without a window the
  // camera is below the ground and sees the sky.
  std::vector<std::int64_t> draw_rows(const View& view, const GroundAtlas::Window* window,
                                      const RobotShadow& shadow,
                                      const std::vector<PlacedPlant>& placed, int first, int end,
                                      Frame& frame) const {
    std::vector<std::int64_t> visible(placed.size(), 0);
    for (std::size_t i = 0; i < placed.size(); ++i) {
      draw_plant(placed[i], static_cast<std::int32_t>(i), texture_, shadow, frame, first, end);
    }
    RowHits hits(view.intrinsics().width_px);
    for (int v = first; v < end; ++v) {
      if (window) {
        finish_row(view, *window, shadow, placed, v, frame, hits, visible);
      } else {
        auto* row = frame.bgr.ptr<cv::Vec3b>(v);
        std::fill(row, row + frame.bgr.cols, cv::Vec3b(kSky_bgr[0], kSky_bgr[1], kSky_bgr[2]));
      }
    }
    return visible;
  }

  void list_plants(const std::vector<PlacedPlant>& placed, Frame& frame) const {
    for (const PlacedPlant& plant : placed) {
      if (plant.visible_px == 0) continue;
      frame.plants.push_back({.plant_index = plant.plant_index,
                              .id = field_.plants[plant.plant_index].id,
                              .visible_px = plant.visible_px,
                              .area_mm2 = plant.built->mesh.top_area_mm2,
                              .stem_px = plant.stem_px});
    }
  }

  // Copies what the frame still shares with the buffers.
  [[nodiscard]] Frame owning(Frame frame) const {
    if (frame.bgr.data == bgr_.data) frame.bgr = bgr_.clone();
    if (frame.depth_m.data == depth_m_.data) frame.depth_m = depth_m_.clone();
    return frame;
  }

  void gather_casters(std::int32_t block_x, std::int32_t block_y,
                      std::vector<ShadowTriangle>& casters) {
    const double side = GroundBlock::kSize * ground_.texel_m();
    const auto found = plants_.find(
        block_x * side, (block_x + 1) * side, block_y * side, (block_y + 1) * side,
        [&](double radius_m) { return radius_m + ground_.shadow_length_m(1.1 * radius_m); });
    for (const std::size_t index : found) {
      const BuiltPlant& plant = plants_.get(index);
      for (const auto& t : plant.mesh.triangles) {
        casters.push_back(
            {{plant.mesh.vertices[t[0]].p_P + plant.p_F, plant.mesh.vertices[t[1]].p_P + plant.p_F,
              plant.mesh.vertices[t[2]].p_P + plant.p_F}});
      }
    }
  }

  // Leaves swing faster than frames follow each other: each frame finds them anywhere.
  [[nodiscard]] Eigen::Vector2f sway(std::size_t plant_index, std::uint64_t frame_index) const {
    constexpr double kAt_m = 0.05;
    if (parameters_.plants.leaf_sway_m <= 0.0) return Eigen::Vector2f::Zero();
    const auto id = static_cast<std::uint64_t>(field_.plants[plant_index].id);
    Random random(Random(seed_, "leaf_sway", id).next(), "frame", frame_index);
    const double along = random.normal(0.0, parameters_.plants.leaf_sway_m / kAt_m);
    const double across = random.normal(0.0, parameters_.plants.leaf_sway_m / kAt_m);
    return Eigen::Vector2d(along, across).cast<float>();
  }

  std::vector<PlacedPlant> place_plants(const View& view, const GroundAtlas::Window& window,
                                        std::uint64_t frame_index) {
    const double texel = ground_.texel_m();
    // A leaf near the camera's height is seen far from its place on the ground.
    const auto found = plants_.find(window.first_x * texel, (window.last_x + 1) * texel,
                                    window.first_y * texel, (window.last_y + 1) * texel,
                                    [](double radius_m) { return 2.5 * radius_m + 0.05; });
    std::vector<PlacedPlant> placed;
    for (const std::size_t index : found) {
      auto plant = place_plant(view, plants_.get(index), index, sway(index, frame_index));
      if (plant) placed.push_back(std::move(*plant));
    }
    return placed;
  }

  // Where a row's rays meet level ground: depths, and 256ths of texels from the window's corner.
  struct RowHits {
    explicit RowHits(int width) : depth(width), x(width), y(width), rise_x(width), rise_y(width) {}
    std::vector<float> depth;
    std::vector<std::int32_t> x;
    std::vector<std::int32_t> y;
    std::vector<std::int32_t> rise_x;  // 1024ths of that, for a unit of the ground's height
    std::vector<std::int32_t> rise_y;
  };

  void intersect_row(const View& view, const GroundAtlas::Window& window, int v,
                     RowHits& hits) const {
    const auto height = static_cast<float>(view.position().z());
    const auto per_texel = static_cast<float>(1.0 / ground_.texel_m());
    const float unit = GroundBlock::kHeightUnit_m / height;
    // Relative to the window's corner single precision is enough.
    const auto start_x =
        static_cast<float>(view.position().x() / ground_.texel_m() - window.first_x - 0.5);
    const auto start_y =
        static_cast<float>(view.position().y() / ground_.texel_m() - window.first_y - 0.5);
    const Eigen::Vector3f ray = view.ray({0.0, static_cast<double>(v)}).cast<float>();
    const Eigen::Vector3f step = view.ray_step().cast<float>();
    const float rx = ray.x();
    const float ry = ray.y();
    const float rz = ray.z();
    const float sx = step.x();
    const float sy = step.y();
    const float sz = step.z();
    float* depth = hits.depth.data();
    std::int32_t* x = hits.x.data();
    std::int32_t* y = hits.y.data();
    std::int32_t* rise_x = hits.rise_x.data();
    std::int32_t* rise_y = hits.rise_y.data();
    // Keeps the product of a rise and any height within 32 bits; reached at flat angles only.
    constexpr float kMaxRise = 65536.0f;
    constexpr float kFar = 1e7f;
    const auto fixed = [](float value, float limit) {
      return static_cast<std::int32_t>(std::min(std::max(value, -limit), limit));
    };
    const int width = static_cast<int>(hits.depth.size());
    for (int u = 0; u < width; ++u) {
      const auto t = static_cast<float>(u);
      const float down = rz + t * sz;
      // Rays that do not fall are sent out of every window.
      const float distance = down < -1e-3f ? -height / down : 1e9f;
      const float step_x = distance * (rx + t * sx) * per_texel;
      const float step_y = distance * (ry + t * sy) * per_texel;
      depth[u] = distance;
      x[u] = fixed(256.0f * (start_x + step_x), kFar);
      y[u] = fixed(256.0f * (start_y + step_y), kFar);
      rise_x[u] = fixed(-262144.0f * unit * step_x, kMaxRise);
      rise_y[u] = fixed(-262144.0f * unit * step_y, kMaxRise);
    }
  }

  // Replaces inverse depths and indices into `placed` by the frame's values, and draws the ground.
  void finish_row(const View& view, const GroundAtlas::Window& window, const RobotShadow& shadow,
                  const std::vector<PlacedPlant>& placed, int v, Frame& frame, RowHits& hits,
                  std::vector<std::int64_t>& visible) const {
    intersect_row(view, window, v, hits);
    const GroundAtlas::Reader ground = atlas_.reader();
    auto* bgr = frame.bgr.ptr<std::uint8_t>(v);
    auto* depth = frame.depth_m.ptr<float>(v);
    auto* index = frame.plant_index.ptr<std::int32_t>(v);
    const float unit = GroundBlock::kHeightUnit_m / static_cast<float>(view.position().z());
    const bool shaded = shadow.enabled();
    const int width = frame.bgr.cols;
    for (int u = 0; u < width; ++u) {
      if (index[u] >= 0) {
        const auto local = static_cast<std::size_t>(index[u]);
        ++visible[local];
        index[u] = static_cast<std::int32_t>(placed[local].plant_index);
        depth[u] = 1.0f / depth[u];
        continue;
      }
      std::uint8_t* out = bgr + 3 * static_cast<std::ptrdiff_t>(u);
      std::int32_t height = 0;
      std::uint8_t shade = 0;
      if (!sample_ground(ground, window, hits, u, out, height, shade)) {
        std::copy(kSky_bgr.begin(), kSky_bgr.end(), out);
        continue;
      }
      depth[u] = hits.depth[u] * (1.0f - unit * static_cast<float>(height));
      if (shaded) {
        const float gain = shadow.gain(u, v, static_cast<float>(shade) * (1.0f / 255.0f));
        for (int k = 0; k < 3; ++k) {
          out[k] = static_cast<std::uint8_t>(static_cast<float>(out[k]) * gain);
        }
      }
    }
  }

  // The ground that pixel `u` of a row sees: colour, height in units of kHeightUnit_m, and shade.
  // false: the ray leaves the window. Inline, because the call would cost more than the sample.
  static inline bool sample_ground(const GroundAtlas::Reader& ground,
                                   const GroundAtlas::Window& window, const RowHits& hits, int u,
                                   std::uint8_t* bgr, std::int32_t& height, std::uint8_t& shade) {
    const std::int32_t limit_x = (window.last_x - window.first_x - 1) * 256;
    const std::int32_t limit_y = (window.last_y - window.first_y - 1) * 256;
    std::int32_t x = hits.x[u];
    std::int32_t y = hits.y[u];
    if (x < 256 || y < 256 || x >= limit_x || y >= limit_y) return false;
    // One step of the intersection with the uneven ground.
    const std::int32_t rise =
        ground.texel(window.first_x + ((x + 128) >> 8), window.first_y + ((y + 128) >> 8))
            .height_64um;
    x = std::clamp(x + (rise * hits.rise_x[u] >> 10), 0, limit_x);
    y = std::clamp(y + (rise * hits.rise_y[u] >> 10), 0, limit_y);
    const std::int32_t whole_x = x >> 8;
    const std::int32_t whole_y = y >> 8;
    const auto part_x = static_cast<std::uint32_t>(x & 255);
    const auto part_y = static_cast<std::uint32_t>(y & 255);
    const GroundTexel* near_row = ground.row(window.first_x + whole_x);
    const GroundTexel* far_row = ground.row(window.first_x + whole_x + 1);
    const std::ptrdiff_t left = ground.column(window.first_y + whole_y);
    const std::ptrdiff_t right = ground.column(window.first_y + whole_y + 1);
    const std::uint32_t weight_d = part_x * part_y >> 8;
    const std::uint32_t weight_c = part_x - weight_d;
    const std::uint32_t weight_b = part_y - weight_d;
    const std::uint32_t weight_a = 256 - part_x - weight_b;
    // Four channels at once, each in 16 bits: the weights sum to 256.
    const std::uint64_t sum = spread(near_row[left]) * weight_a +
                              spread(near_row[right]) * weight_b +
                              spread(far_row[left]) * weight_c + spread(far_row[right]) * weight_d;
    bgr[0] = static_cast<std::uint8_t>(sum >> 8);
    bgr[1] = static_cast<std::uint8_t>(sum >> 40);
    bgr[2] = static_cast<std::uint8_t>(sum >> 24);
    height = near_row[left].height_64um;
    shade = static_cast<std::uint8_t>(sum >> 56);
    return true;
  }

  const field::FieldModel field_;
  const field::SpeciesTable species_;
  const RendererParameters parameters_;
  const Light light_;
  const Ground ground_;
  GroundAtlas atlas_;
  PlantCache plants_;
  const LeafTexture texture_;
  const CameraEffects effects_;
  const std::uint64_t seed_;
  cv::Mat bgr_;
  cv::Mat depth_m_;
};

Renderer::Renderer(field::FieldModel field, const RendererParameters& parameters,
                   std::uint64_t seed, const field::SpeciesTable& species)
    : implementation_(
          std::make_unique<Implementation>(std::move(field), parameters, seed, species)) {}

Renderer::~Renderer() = default;

const field::FieldModel& Renderer::field() const {
  return implementation_->field();
}

Frame Renderer::render(const geometry::PinholeCamera& camera, const Eigen::Isometry3d& X_FC,
                       std::uint64_t frame_index) {
  return implementation_->render(camera, X_FC, frame_index);
}

double Renderer::plant_area_mm2(std::size_t plant_index) {
  return implementation_->plant_area_mm2(plant_index);
}

double Renderer::ground_height_m(double x_F_m, double y_F_m) const {
  return implementation_->ground().base_height_m(x_F_m, y_F_m);
}

}  // namespace furrow::simulation
