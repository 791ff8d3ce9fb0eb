#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "furrow_core/parameters.hpp"
#include "furrow_vision/annotated_image.hpp"

namespace furrow::vision {

/// What visit() declares says each.
struct ConversionParameters {
  double scale = 1.0;
  double validation_share = 0.1;
  double evaluation_share = 0.5;
  void visit(ParameterVisitor& v);
};

struct DatasetSplit {
  Dataset train, validation, evaluation;
};

/// Draws which image goes into which part; each stays in its order. At least one image in each part
/// whose share is not 0, as far as there are images; the evaluation comes first, then the training.
/// Frames of a sequence stay together.
[[nodiscard]] DatasetSplit split_dataset(const Dataset& dataset,
                                         const ConversionParameters& parameters,
                                         std::uint64_t seed);

/// Pixels, masks and stems at another size; instances of which nothing remains are dropped, and
/// depth, which is not scaled, is left out. @pre image.bgr is loaded; scale > 0.
void scale_image(AnnotatedImage& image, double scale);

/// Writes images/ and train.json, validation.json, evaluation.json (COCO) into `folder`. Training
/// and validation images are scaled; those of the evaluation stay as they are, and what vegetation
/// no instance covers becomes a crowd region there, of the last class. `progress` is called
/// with the number of images done. Fails with what reading and writing fail with, and with
/// kOutOfRange for parameters outside their range.
[[nodiscard]] Status convert_dataset(const Dataset& dataset, const ConversionParameters& parameters,
                                     std::uint64_t seed, const std::filesystem::path& folder,
                                     const std::function<void(std::size_t)>& progress);

}  // namespace furrow::vision
