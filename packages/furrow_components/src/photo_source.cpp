#include "photo_source.hpp"

#include "furrow_annotation/read_dataset.hpp"
#include "furrow_core/error.hpp"
#include "furrow_vision/annotated_image.hpp"
#include "furrow_vision/image_file.hpp"

namespace furrow::components {
namespace {

simulation::GroundPhoto to_photo(const vision::AnnotatedImage& image) {
  simulation::GroundPhoto photo;
  photo.bgr = image.bgr;
  photo.instance_id = cv::Mat(image.bgr.size(), CV_32SC1, cv::Scalar(-1));
  for (const vision::AnnotatedInstance& instance : image.instances) {
    if (instance.crowd) continue;  // a region to ignore is no plant
    photo.instance_id(instance.box_px).setTo(static_cast<int>(photo.plants.size()), instance.mask);
    photo.plants.push_back({.kind = instance.kind == vision::SubClassKind::kCrop
                                        ? field::PlantKind::kCrop
                                        : field::PlantKind::kWeed,
                            .species = annotation::species_of({instance.category, instance.kind}),
                            .stem_px = instance.stem_px});
  }
  return photo;
}

}  // namespace

std::vector<simulation::GroundPhoto> load_ground_photos(const std::filesystem::path& folder,
                                                        int limit) {
  auto dataset = annotation::read_dataset(folder, vision::read_mask);
  if (!dataset.ok()) throw ConfigError(dataset.error().message);
  std::vector<simulation::GroundPhoto> photos;
  for (vision::AnnotatedImage& image : dataset->images) {
    if (static_cast<int>(photos.size()) == limit) break;
    if (const Status loaded = vision::load_pixels(image); !loaded.ok()) {
      throw ConfigError(loaded.error().message);
    }
    photos.push_back(to_photo(image));
  }
  if (photos.empty()) throw ConfigError({folder.string(), 0}, "", "has no photographs");
  return photos;
}

}  // namespace furrow::components
