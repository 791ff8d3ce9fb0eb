#include "photo_source.hpp"

#include "furrow_core/error.hpp"
#include "furrow_vision/dataset_carrot_weed.hpp"
#include "furrow_vision/dataset_cwfid.hpp"

namespace furrow::components {
namespace {

Result<vision::Dataset> read_dataset(const std::filesystem::path& folder) {
  if (std::filesystem::is_directory(folder / "annotations")) return vision::read_cwfid(folder);
  if (std::filesystem::is_directory(folder / "plant_masks"))
    return vision::read_carrot_weed(folder);
  return Error{
      ErrorCode::kNotFound,
      folder.string() + ": holds neither annotations/ (CWFID) nor plant_masks/ (Carrot-Weed)"};
}

simulation::GroundPhoto to_photo(const vision::AnnotatedImage& image) {
  simulation::GroundPhoto photo;
  photo.bgr = image.bgr;
  photo.instance_id = cv::Mat(image.bgr.size(), CV_32SC1, cv::Scalar(-1));
  for (const vision::AnnotatedInstance& instance : image.instances) {
    photo.instance_id(instance.box_px).setTo(static_cast<int>(photo.plants.size()), instance.mask);
    photo.plants.push_back({.kind = instance.kind == vision::SubClassKind::kCrop
                                        ? field::PlantKind::kCrop
                                        : field::PlantKind::kWeed,
                            .species = instance.category,
                            .stem_px = instance.stem_px});
  }
  return photo;
}

}  // namespace

std::vector<simulation::GroundPhoto> load_ground_photos(const std::filesystem::path& folder,
                                                        int limit) {
  auto dataset = read_dataset(folder);
  if (!dataset.ok()) throw ConfigError(dataset.error().message);
  std::vector<simulation::GroundPhoto> photos;
  for (vision::AnnotatedImage& image : dataset->images) {
    if (static_cast<int>(photos.size()) == limit) break;
    if (const Status loaded = vision::load_pixels(image); !loaded.ok()) {
      throw ConfigError(loaded.error().message);
    }
    photos.push_back(to_photo(image));
  }
  if (photos.empty()) throw ConfigError({folder.string(), 0}, "", "holds no photographs");
  return photos;
}

}  // namespace furrow::components
