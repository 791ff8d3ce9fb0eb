#include "furrow_annotation/carrot_weed.hpp"

#include <opencv2/imgproc.hpp>

#include "folder_listing.hpp"

namespace furrow::annotation {
namespace {

void add_components(const cv::Mat& labels, int label, SubClassKind kind, int min_area_px,
                    std::vector<AnnotatedInstance>& into) {
  cv::Mat components, stats, centroids;
  const int count =
      cv::connectedComponentsWithStats(labels == label, components, stats, centroids, 8, CV_32S);
  for (int i = 1; i < count; ++i) {
    if (stats.at<int>(i, cv::CC_STAT_AREA) < min_area_px) continue;
    AnnotatedInstance instance;
    instance.kind = kind;
    instance.category = kind == SubClassKind::kCrop ? "carrot" : "weed";
    instance.box_px = {stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                       stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT)};
    instance.mask = components(instance.box_px) == i;
    into.push_back(std::move(instance));
  }
}

}  // namespace

Result<Dataset> read_carrot_weed(const std::filesystem::path& folder, const MaskReader& read_mask,
                                 int min_area_px) {
  const auto masks = list_files(folder / "plant_masks", ".png");
  if (!masks) return masks.error();
  if (masks->empty()) {
    return Error{ErrorCode::kNotFound, (folder / "plant_masks").string() + ": holds no masks"};
  }
  Dataset dataset;
  dataset.name = "carrot_weed";
  dataset.classes = {{"carrot", SubClassKind::kCrop}, {"weed", SubClassKind::kWeed}};
  for (const auto& file : *masks) {
    const auto labels = read_mask(file);
    if (!labels) return labels.error();
    double greatest = 0.0;
    cv::minMaxLoc(*labels, nullptr, &greatest);
    if (greatest > 2.0) {
      return Error{ErrorCode::kParse, file.string() + ": holds the label " +
                                          std::to_string(static_cast<int>(greatest)) +
                                          "; known are 0, 1 and 2"};
    }
    AnnotatedImage image;
    image.path = folder / "images" / file.stem().concat(".jpg");
    if (!std::filesystem::exists(image.path)) {
      return Error{ErrorCode::kNotFound, image.path.string() + ": no image for its mask"};
    }
    image.width_px = labels->cols;
    image.height_px = labels->rows;
    image.vegetation = *labels > 0;
    add_components(*labels, 1, SubClassKind::kWeed, min_area_px, image.instances);
    add_components(*labels, 2, SubClassKind::kCrop, min_area_px, image.instances);
    dataset.images.push_back(std::move(image));
  }
  return dataset;
}

}  // namespace furrow::annotation
