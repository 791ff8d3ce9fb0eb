#include "furrow_components/rendered_dataset.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "furrow_annotation/coco.hpp"
#include "furrow_core/random.hpp"
#include "furrow_field/generator.hpp"
#include "furrow_geometry/camera.hpp"
#include "furrow_simulation/renderer.hpp"
#include "furrow_vision/image_file.hpp"

namespace furrow::components {
namespace {

struct Shot {
  geometry::PinholeCamera camera;
  geometry::Pose2 X_FB;
  Eigen::Isometry3d X_FC;
};

geometry::CameraIntrinsics intrinsics(const RenderedDatasetParameters& p) {
  // The camera of the tool: 1 m above the ground.
  const double focal_px = 1000.0 / p.resolution_mm_per_px;
  return {static_cast<int>(p.width_px),
          static_cast<int>(p.height_px),
          focal_px,
          focal_px,
          0.5 * static_cast<double>(p.width_px - 1),
          0.5 * static_cast<double>(p.height_px - 1)};
}

Shot draw_shot(const RenderedDatasetParameters& p, double length_m, Random& random) {
  const double height_m = 1.0 + random.uniform(-p.scale_variation, p.scale_variation);
  Shot shot{geometry::PinholeCamera(intrinsics(p)), {}, Eigen::Isometry3d::Identity()};
  shot.X_FB = {0.5 * length_m + random.uniform(-0.1, 0.1), random.uniform(-0.3, 0.3),
               random.uniform(-p.yaw_max_rad, p.yaw_max_rad)};
  // Optical axis down, image up along the travel.
  Eigen::Matrix3d R_BC;
  R_BC << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  shot.X_FC = geometry::to_isometry(shot.X_FB);
  shot.X_FC.translation().z() = height_m;
  shot.X_FC.linear() =
      shot.X_FC.linear() *
      Eigen::AngleAxisd(random.uniform(-p.tilt_max_rad, p.tilt_max_rad), Eigen::Vector3d::UnitX()) *
      Eigen::AngleAxisd(random.uniform(-p.tilt_max_rad, p.tilt_max_rad), Eigen::Vector3d::UnitY()) *
      R_BC;
  return shot;
}

field::FieldParameters draw_field(const RenderedDatasetParameters& p,
                                  const field::SpeciesTable& species, Random& random) {
  field::FieldParameters field;
  field.weed_species = species.names(field::PlantKind::kWeed);
  field.weed_shares = p.weed_shares;
  if (const auto crops = species.names(field::PlantKind::kCrop); !crops.empty()) {
    field.crop_species = crops.front();
  }
  field.length_m = 2.4;
  field.width_m = 2.4;
  // Densities spread evenly over the orders of magnitude.
  field.weeds_per_m2 = std::exp(random.uniform(
      std::log(p.weeds_per_m2_min), std::log(std::max(p.weeds_per_m2_max, p.weeds_per_m2_min))));
  field.pattern = random.bernoulli(0.3) ? "clusters" : "poisson";
  field.crop = random.bernoulli(p.crop_share);
  field.row_spacing_m = random.uniform(0.45, 0.55);
  field.row_offset_m = random.uniform(-0.25, 0.25);
  field.plant_spacing_m = random.uniform(0.15, 0.25);
  field.row_sd_m = random.uniform(0.004, 0.02);
  field.missing_probability = random.uniform(0.0, 0.25);
  field.crop_leaves_min = random.integer(2, 6);
  field.crop_leaves_max = std::min<std::int64_t>(8, field.crop_leaves_min + random.integer(0, 3));
  field.weed_leaves_min = 2;
  field.weed_leaves_max = random.integer(2, 8);
  field.size_sd = random.uniform(0.1, 0.25);
  field.weed_to_crop_min_m = 0.01;
  if (p.variety > 0.0) {
    field.crop_leaves_max =
        std::min<std::int64_t>(14, field.crop_leaves_max + random.integer(0, 6));
    field.weed_leaves_max =
        std::min<std::int64_t>(14, field.weed_leaves_max + random.integer(0, 6));
    field.size_sd = random.uniform(0.1, 0.1 + 0.3 * p.variety);
  }
  return field;
}

/// The same species of other sizes in each image: how large a beet is beside its weeds depends on
/// the weather and on when each came up.
field::SpeciesTable varied_sizes(const field::SpeciesTable& species, double variety,
                                 std::uint64_t seed) {
  if (variety <= 0.0) return species;
  Random random(seed, "species sizes");
  std::vector<field::Species> varied = species.all();
  // Labelled beets on real fields reach a radius of 150 mm, their weeds 100 mm; both follow the
  // season.
  const double season = random.uniform(-0.5, 0.6);
  for (field::Species& entry : varied) {
    const double size = std::exp(variety * (season + random.uniform(-0.3, 0.3)));
    entry.radius_two_leaves_m *= size;
    entry.radius_eight_leaves_m *= size;
    entry.leaf_cover =
        std::clamp(entry.leaf_cover * std::exp(variety * random.uniform(-0.3, 0.2)), 0.1, 0.7);
  }
  return field::SpeciesTable(std::move(varied));
}

std::vector<annotation::AnnotatedInstance> instances_of(const simulation::Frame& frame,
                                                        const field::FieldModel& field) {
  std::vector<cv::Rect> boxes(frame.plants.size());
  std::vector<int> order(field.plants.size(), -1);
  for (std::size_t i = 0; i < frame.plants.size(); ++i) {
    order[frame.plants[i].plant_index] = static_cast<int>(i);
  }
  struct Extent {
    int left = INT32_MAX, top = INT32_MAX, right = -1, bottom = -1;
  };
  std::vector<Extent> extents(frame.plants.size());
  for (int v = 0; v < frame.plant_index.rows; ++v) {
    const auto* row = frame.plant_index.ptr<std::int32_t>(v);
    for (int u = 0; u < frame.plant_index.cols; ++u) {
      if (row[u] < 0) continue;
      Extent& extent = extents[static_cast<std::size_t>(order[static_cast<std::size_t>(row[u])])];
      extent = {std::min(extent.left, u), std::min(extent.top, v), std::max(extent.right, u),
                std::max(extent.bottom, v)};
    }
  }
  std::vector<annotation::AnnotatedInstance> instances;
  for (std::size_t i = 0; i < frame.plants.size(); ++i) {
    const simulation::VisiblePlant& visible = frame.plants[i];
    const Extent& e = extents[i];
    if (visible.visible_px < kLeastVisible_px || e.right < 0) continue;
    const field::Plant& plant = field.plants[visible.plant_index];
    annotation::AnnotatedInstance instance;
    instance.kind = plant.kind == field::PlantKind::kCrop ? annotation::SubClassKind::kCrop
                                                          : annotation::SubClassKind::kWeed;
    instance.category = plant.species;
    instance.box_px = {e.left, e.top, e.right - e.left + 1, e.bottom - e.top + 1};
    instance.mask = frame.plant_index(instance.box_px) == static_cast<int>(visible.plant_index);
    instance.stem_px = visible.stem_px;
    instance.area_mm2 = visible.area_mm2;
    instances.push_back(std::move(instance));
  }
  return instances;
}

/// The frames of one sequence; the last one is labelled.
Result<std::vector<annotation::AnnotatedImage>> render_sequence(
    const RenderedDatasetParameters& p, const field::SpeciesTable& table, std::uint64_t seed,
    std::int64_t index, const std::filesystem::path& folder) {
  Random random(seed, "dataset", static_cast<std::uint64_t>(index));
  const std::uint64_t image_seed = random.next();
  const field::SpeciesTable species = varied_sizes(table, p.variety, image_seed);
  auto field = field::generate_field(draw_field(p, species, random), species, image_seed);
  if (!field.ok()) return field.error();
  const Shot last = draw_shot(p, field->length_m, random);
  // The generator centres the field on y = 0 already; x runs from 0.
  auto appearance = simulation::random_appearance(image_seed, p.variety);
  appearance.threads = p.threads;
  simulation::Renderer renderer(std::move(field).value(), appearance, image_seed, species);

  std::vector<annotation::AnnotatedImage> images;
  for (std::int64_t before = p.sequence_frames - 1; before >= 0; --before) {
    Shot shot = last;
    const double back_s = static_cast<double>(before) / p.frame_rate_hz;
    const double back_m = back_s * p.velocity_mps;
    const Eigen::Vector2d travel(std::cos(last.X_FB.heading_rad), std::sin(last.X_FB.heading_rad));
    shot.X_FB.x_m -= back_m * travel.x();
    shot.X_FB.y_m -= back_m * travel.y();
    shot.X_FC.translation().head<2>() -= back_m * travel;
    const simulation::Frame frame =
        renderer.render(shot.camera, shot.X_FC, static_cast<std::uint64_t>(before));

    char name[32];
    std::snprintf(name, sizeof name, "%06lld", static_cast<long long>(index));
    std::string file = name;
    annotation::AnnotatedImage image;
    image.width_px = frame.bgr.cols;
    image.height_px = frame.bgr.rows;
    image.X_FB = shot.X_FB;
    image.velocity_mps = p.sequence_frames > 1 ? p.velocity_mps : 0.0;
    image.labelled = before == 0;
    if (image.labelled) image.instances = instances_of(frame, renderer.field());
    if (p.sequence_frames > 1) {
      image.sequence = name;
      const double last_s = static_cast<double>(p.sequence_frames - 1) / p.frame_rate_hz;
      image.stamp = Time::from_seconds(last_s - back_s);
      if (!image.labelled) file += "_before_" + std::to_string(before);
    }
    image.path = folder / "images" / (file + ".png");
    if (const Status written = vision::write_image(image.path, frame.bgr); !written.ok()) {
      return written.error();
    }
    if (p.depth) {
      cv::Mat depth;
      frame.depth_m.convertTo(depth, CV_16U, 1e4);
      image.depth_path = folder / "depth" / (file + ".png");
      if (const Status written = vision::write_image(image.depth_path, depth); !written.ok()) {
        return written.error();
      }
    }
    images.push_back(std::move(image));
  }
  return images;
}

void visit_images(RenderedDatasetParameters& p, ParameterVisitor& v) {
  v.visit({.name = "images",
           .description = "number of images in all three parts",
           .min = 1,
           .max = 100000},
          p.images);
  v.visit({.name = "width_px",
           .unit = "px",
           .description = "width of an image",
           .min = 64,
           .max = 4096},
          p.width_px);
  v.visit({.name = "height_px",
           .unit = "px",
           .description = "height of an image",
           .min = 64,
           .max = 4096},
          p.height_px);
  v.visit({.name = "resolution_mm_per_px",
           .unit = "mm/px",
           .description = "ground resolution before the scale varies",
           .min = 0.1,
           .max = 10.0},
          p.resolution_mm_per_px);
  v.visit({.name = "scale_variation",
           .description = "camera height varies by a factor of 1 +- this",
           .min = 0.0,
           .max = 0.5},
          p.scale_variation);
  v.visit({.name = "tilt_max_rad",
           .unit = "rad",
           .description = "largest tilt of the camera",
           .min = 0,
           .max = 0.3},
          p.tilt_max_rad);
  v.visit({.name = "yaw_max_rad",
           .unit = "rad",
           .description = "largest angle between camera and row",
           .min = 0.0,
           .max = 3.2},
          p.yaw_max_rad);
}

void visit_content(RenderedDatasetParameters& p, ParameterVisitor& v) {
  v.visit({.name = "weeds_per_m2_min",
           .unit = "1/m2",
           .description = "least density",
           .min = 0.01,
           .max = 1000},
          p.weeds_per_m2_min);
  v.visit({.name = "weeds_per_m2_max",
           .unit = "1/m2",
           .description = "greatest density",
           .min = 0.01,
           .max = 1000},
          p.weeds_per_m2_max);
  v.visit({.name = "weed_shares",
           .description = "share of each weed, in the order of the species table; empty: equal",
           .min = 0.0,
           .max = 1e6},
          p.weed_shares);
  v.visit({.name = "crop_share",
           .description = "share of the images with a crop row",
           .min = 0,
           .max = 1},
          p.crop_share);
  v.visit({.name = "variety",
           .description = "0 to 1: wider ranges of light, soil, sizes and forms, as in real fields",
           .min = 0.0,
           .max = 1.0},
          p.variety);
}

void visit_parts_and_sequences(RenderedDatasetParameters& p, ParameterVisitor& v) {
  v.visit({.name = "validation_share", .description = "share of the images", .min = 0, .max = 0.5},
          p.validation_share);
  v.visit({.name = "evaluation_share", .description = "share of the images", .min = 0, .max = 0.5},
          p.evaluation_share);
  v.visit({.name = "sequence_frames",
           .description = "images of a sequence, of which the last is labelled; 1: single images",
           .min = 1,
           .max = 100},
          p.sequence_frames);
  v.visit({.name = "velocity_mps",
           .unit = "m/s",
           .description = "speed of the robot within a sequence",
           .min = 0.0,
           .max = 5.0},
          p.velocity_mps);
  v.visit({.name = "frame_rate_hz",
           .unit = "Hz",
           .description = "images per second within a sequence",
           .min = 0.1,
           .max = 100.0},
          p.frame_rate_hz);
  v.visit({.name = "depth", .description = "write depth images too"}, p.depth);
  v.visit({.name = "threads", .description = "threads of the renderer", .min = 1, .max = 256},
          p.threads);
}

}  // namespace

void RenderedDatasetParameters::visit(ParameterVisitor& v) {
  visit_images(*this, v);
  visit_content(*this, v);
  visit_parts_and_sequences(*this, v);
}

Status render_dataset(const RenderedDatasetParameters& parameters,
                      const field::SpeciesTable& species, std::uint64_t seed,
                      const std::filesystem::path& folder,
                      const std::function<void(std::int64_t)>& progress) {
  std::error_code failure;
  std::filesystem::create_directories(folder / "images", failure);
  if (parameters.depth && !failure) std::filesystem::create_directories(folder / "depth", failure);
  if (failure) {
    return Error{ErrorCode::kIo,
                 folder.string() + ": cannot make the folder: " + failure.message()};
  }
  annotation::Dataset whole;
  whole.name = "rendered";
  whole.resolution_mm_per_px = parameters.resolution_mm_per_px;
  for (const field::Species& entry : species.all()) {
    whole.classes.push_back({entry.name, entry.kind == field::PlantKind::kCrop
                                             ? annotation::SubClassKind::kCrop
                                             : annotation::SubClassKind::kWeed});
  }
  std::array<annotation::Dataset, 3> parts = {whole, whole, whole};
  const double images = static_cast<double>(parameters.images);
  const auto validation = static_cast<std::int64_t>(images * parameters.validation_share);
  const auto evaluation = static_cast<std::int64_t>(images * parameters.evaluation_share);
  for (std::int64_t i = 0; i < parameters.images; ++i) {
    auto sequence = render_sequence(parameters, species, seed, i, folder);
    if (!sequence.ok()) return sequence.error();
    const std::size_t part = i < evaluation ? 2 : i < evaluation + validation ? 1 : 0;
    for (auto& image : *sequence) parts[part].images.push_back(std::move(image));
    progress(i + 1);
  }
  constexpr std::array kNames = {"train.json", "validation.json", "evaluation.json"};
  for (std::size_t part = 0; part < parts.size(); ++part) {
    if (const Status written = annotation::write_coco(folder / kNames[part], parts[part]);
        !written.ok()) {
      return written;
    }
  }
  return {};
}

}  // namespace furrow::components
