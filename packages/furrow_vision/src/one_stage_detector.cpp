#include "furrow_vision/one_stage_detector.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "furrow_core/error.hpp"
#include "instance_cutting.hpp"
#include "network.hpp"

namespace furrow::vision {

class OneStageDetector::Implementation {
 public:
  Implementation(const OneStageParameters& parameters, const std::filesystem::path& model_file)
      : parameters_(checked(parameters)),
        model_(load_model(model_file, ModelFile::Kind::kOneStage, parameters.network.classes)),
        network_(load_network(model_, "network")) {
    // A network that does not fit its model file is found here and not in the field.
    constexpr int kProbe_px = 64;
    const auto maps = run(cv::Mat::zeros(kProbe_px, kProbe_px, CV_8UC3), {kProbe_px, kProbe_px});
    if (!maps.ok()) throw ConfigError(network_.file() + ": " + maps.error().message);
  }

  Result<std::vector<Instance>> detect(const RgbdView& view) {
    if (const Status status = check_view(view); !status) return status.error();
    const double mm_per_px = view.ground_mm_per_px();
    const cv::Size input =
        network_input_size(view.bgr.size(), mm_per_px, model_.ground_resolution_mm_per_px,
                           parameters_.network.input_area_max_px);
    const auto maps = run(view.bgr, input);
    if (!maps.ok()) return maps.error();
    const cv::Point2d input_per_px(input.width / static_cast<double>(view.bgr.cols),
                                   input.height / static_cast<double>(view.bgr.rows));
    const auto stride = static_cast<double>(model_.stride_px);
    const CellGrid grid{stride, model_.offset_unit_px,
                        mm_per_px / std::sqrt(input_per_px.x * input_per_px.y)};

    const Vegetation vegetation = segment_vegetation(view.bgr, parameters_.vegetation.index);
    const cv::Mat mask = fuse_vegetation(plant_evidence(*maps, parameters_.decoding), vegetation,
                                         parameters_.vegetation);
    cv::Mat cells;
    cv::resize(mask, cells, maps->plant_logit.size(), 0.0, 0.0,
               mask.cols >= maps->plant_logit.cols ? cv::INTER_AREA : cv::INTER_LINEAR);
    cells = cells >= 255.0 * parameters_.cell_cover_min;
    const DecodedPlants decoded = decode_one_stage(*maps, cells, grid, parameters_.decoding);

    std::vector<Instance> plants =
        cut_instances(mask, decoded.labels, {input_per_px.x / stride, input_per_px.y / stride},
                      decoded.plants.size());
    for (std::size_t i = 0; i < plants.size(); ++i) {
      if (!plants[i].mask.empty()) describe(decoded.plants[i], input_per_px, plants[i]);
    }
    std::erase_if(plants, [](const Instance& plant) { return plant.mask.empty(); });
    for (Instance& plant : plants) {
      measure_instance(view, plant);
      set_stem_depth_to_ground(view, mask, plant);
    }
    std::erase_if(plants, [&](const Instance& plant) {
      return plant.area_mm2 < parameters_.decoding.min_plant_area_mm2;
    });
    apply_plant_context(view, mask, vegetation.colour, model_.classes, parameters_.context, plants);
    return plants;
  }

  [[nodiscard]] const ModelFile& model() const { return model_; }

 private:
  static OneStageParameters checked(const OneStageParameters& parameters) {
    validate_parameters(parameters);
    return parameters;
  }

  Result<OneStageMaps> run(const cv::Mat& bgr, cv::Size input) {
    const cv::Mat blob = cv::dnn::blobFromImage(bgr, 1.0 / 255.0, input);
    auto outputs = network_.run(blob, {"output"});
    if (!outputs.ok()) return outputs.error();
    output_ = (*outputs)[0];  // the maps are views into it
    auto maps = split_one_stage_output(output_, model_.classes.size());
    if (!maps.ok()) return maps;
    const cv::Size expected(input.width / static_cast<int>(model_.stride_px),
                            input.height / static_cast<int>(model_.stride_px));
    if (maps->plant_logit.size() != expected) {
      return Error{ErrorCode::kInvalidArgument,
                   "the network's stride is not that of its model file"};
    }
    return maps;
  }

  void describe(const DecodedPlant& decoded, const cv::Point2d& input_per_px,
                Instance& plant) const {
    plant.stem_px = {(decoded.stem_px.x() + 0.5) / input_per_px.x - 0.5,
                     (decoded.stem_px.y() + 0.5) / input_per_px.y - 0.5};
    plant.stem_score = decoded.stem_probability;
    constexpr double kWithoutStem = 0.6;
    plant.score = decoded.plant_probability *
                  (kWithoutStem + (1.0 - kWithoutStem) * decoded.stem_probability);
    plant.class_scores = decoded.class_scores;
    shift_towards_crops(model_.crop_log_odds + parameters_.network.crop_log_odds, model_.classes,
                        plant.class_scores);
    plant.crop_probability = crop_probability(plant.class_scores, model_.classes);
  }

  OneStageParameters parameters_;
  ModelFile model_;
  Network network_;
  cv::Mat output_;
};

void OneStageParameters::visit(ParameterVisitor& v) {
  vegetation.visit(v);
  decoding.visit(v);
  v.visit({.name = "cell_cover_min",
           .description = "Share of a cell of the network that must be vegetation",
           .min = 0.0,
           .max = 1.0},
          cell_cover_min);
  context.visit(v);
  network.visit(v);
}

OneStageDetector::OneStageDetector(const OneStageParameters& parameters,
                                   const std::filesystem::path& model_file)
    : implementation_(std::make_unique<Implementation>(parameters, model_file)) {}

OneStageDetector::~OneStageDetector() = default;

Result<std::vector<Instance>> OneStageDetector::detect(const RgbdView& view) {
  return implementation_->detect(view);
}

const std::vector<SubClass>& OneStageDetector::classes() const {
  return implementation_->model().classes;
}

}  // namespace furrow::vision
