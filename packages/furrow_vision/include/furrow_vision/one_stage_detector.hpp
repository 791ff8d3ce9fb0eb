#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_vision/detector.hpp"
#include "furrow_vision/network_use.hpp"
#include "furrow_vision/one_stage_decoding.hpp"
#include "furrow_vision/plant_context.hpp"
#include "furrow_vision/vegetation_fusion.hpp"

namespace furrow::vision {

/// What visit() declares says each.
struct OneStageParameters {
  VegetationFusionParameters vegetation;
  OneStageDecodingParameters decoding;
  double cell_cover_min = 0.1;
  PlantContextParameters context;
  NetworkUse network;
  void visit(ParameterVisitor& v);
};

/// A network that gives plant, stem, offset and class maps in one pass (ONNX, run by OpenCV). The
/// image is scaled to the ground resolution that the model was trained for, as far as
/// network.input_area_max_px allows; the mask is made at the image's own resolution. The score is
/// the mean probability of a plant, held down where no stem is seen. Keeps no state over frames.
/// Detection uses OpenCV's global number of threads.
class OneStageDetector final : public Detector {
 public:
  /// Throws ConfigError for:
  /// - parameters out of range;
  /// - a model file that is missing, malformed, of another kind, or of other classes than
  ///   `parameters.network.classes`;
  /// - a network that is missing, truncated, damaged, or does not fit its model file.
  OneStageDetector(const OneStageParameters& parameters, const std::filesystem::path& model_file);
  ~OneStageDetector() override;

  [[nodiscard]] Result<std::vector<Instance>> detect(const RgbdView& view) override;
  [[nodiscard]] const std::vector<SubClass>& classes() const override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace furrow::vision
