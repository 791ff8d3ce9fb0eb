#include "furrow_annotation/read_dataset.hpp"

#include "furrow_annotation/carrot_weed.hpp"
#include "furrow_annotation/cwfid.hpp"

namespace furrow::annotation {
namespace {

namespace fs = std::filesystem;

// Neither set carries its ground resolution. Carrot-Weed was taken by hand: its own varies.
constexpr double kCwfidResolution_mm = 0.11;
constexpr double kCarrotWeedResolution_mm = 0.3;

Result<Dataset> named(Result<Dataset> dataset, const fs::path& name) {
  if (dataset) dataset->name = name.string();
  return dataset;
}

Result<Dataset> with_resolution(Result<Dataset> dataset, double resolution_mm) {
  if (dataset) dataset->resolution_mm_per_px = resolution_mm;
  return dataset;
}

}  // namespace

Result<Dataset> read_dataset(const fs::path& path, const MaskReader& read_mask,
                             const CocoOptions& options) {
  std::error_code failure;
  if (!fs::exists(path, failure)) {
    return Error{ErrorCode::kNotFound, path.string() + ": no such file or folder"};
  }
  if (!fs::is_directory(path, failure)) return named(read_coco(path, options), path.stem());
  if (fs::is_directory(path / "plant_masks", failure)) {
    return with_resolution(read_carrot_weed(path, read_mask), kCarrotWeedResolution_mm);
  }
  if (fs::is_directory(path / "annotations", failure) ||
      fs::is_directory(path / "masks", failure)) {
    return with_resolution(read_cwfid(path, read_mask), kCwfidResolution_mm);
  }
  if (fs::exists(path / "evaluation.json", failure)) {
    return named(read_coco(path / "evaluation.json", options),
                 fs::weakly_canonical(path, failure).filename());
  }
  return Error{ErrorCode::kNotFound, path.string() +
                                         ": no data set that Furrow reads: no COCO file, no "
                                         "plant_masks/ (Carrot-Weed), no annotations/ (CWFID), no "
                                         "evaluation.json (COCO)"};
}

}  // namespace furrow::annotation
