#include "vision_options.hpp"

#include <algorithm>
#include <filesystem>

#include "furrow_core/statistics.hpp"
#include "furrow_graph/parameter_file.hpp"
#include "furrow_vision/image_file.hpp"
#include "furrow_vision/model_file.hpp"
#include "share.hpp"

namespace furrow::cli {
namespace {

namespace fs = std::filesystem;

std::string kind_of(const fs::path& model_file) {
  const auto model = vision::read_model_file(model_file);
  if (!model.ok()) throw ConfigError(model.error().message);
  return model->kind == vision::ModelFile::Kind::kOneStage ? "one_stage" : "mask_rcnn";
}

fs::path shipped_model(const std::string& detector) {
  return share_folder() / "models" / (detector + ".yaml");
}

std::vector<GivenParameter> given_parameters(const std::vector<std::string>& settings) {
  std::vector<GivenParameter> given;
  for (const std::string& setting : settings) {
    const auto equals = setting.find('=');
    const SourceLocation where{"--set " + setting, 0};
    if (equals == std::string::npos) throw ConfigError(where, "", "is not KEY=VALUE");
    given.push_back({setting.substr(0, equals),
                     graph::parse_parameter_value(setting.substr(equals + 1)), where});
  }
  return given;
}

/// Half of the pixels that have a depth are nearer.
std::optional<double> median_depth_m(const cv::Mat& depth_m) {
  std::vector<float> depths;
  constexpr int kStep = 4;  // a sample is enough
  for (int v = 0; v < depth_m.rows; v += kStep) {
    for (int u = 0; u < depth_m.cols; u += kStep) {
      const float depth = depth_m.at<float>(v, u);
      if (depth > 0.0f) depths.push_back(depth);
    }
  }
  if (depths.empty()) return std::nullopt;
  return median_element(std::span(depths));
}

}  // namespace

void add_vision_options(CLI::App* command, VisionOptions& options) {
  command
      ->add_option("--detector,--detectors", options.detectors,
                   "which; default: index and every model that is there")
      ->check(CLI::IsMember({"index", "one_stage", "mask_rcnn"}));
  command->add_option("--model", options.models, "model file, instead of the shipped one");
  command->add_option("--resolution", options.resolution_mm_per_px, "on the ground, mm per px")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--set", options.settings, "KEY=VALUE of the perception's detector parameters")
      ->take_all();
}

std::vector<NamedDetector> make_detectors(const VisionOptions& options) {
  struct Choice {
    std::string detector;
    fs::path model;
  };
  std::vector<Choice> models;
  for (const std::string& file : options.models) models.push_back({kind_of(file), file});
  for (const char* detector : {"one_stage", "mask_rcnn"}) {
    const bool given = std::any_of(models.begin(), models.end(), [&](const Choice& choice) {
      return choice.detector == detector;
    });
    if (!given && fs::exists(shipped_model(detector))) {
      models.push_back({detector, shipped_model(detector)});
    }
  }
  std::vector<Choice> choices;
  if (options.detectors.empty()) {
    choices.push_back({"index", {}});
    choices.insert(choices.end(), models.begin(), models.end());
  }
  for (const std::string& name : options.detectors) {
    if (name == "index") {
      choices.push_back({name, {}});
      continue;
    }
    const std::size_t before = choices.size();
    std::copy_if(models.begin(), models.end(), std::back_inserter(choices),
                 [&](const Choice& model) { return model.detector == name; });
    if (choices.size() == before) {
      throw ConfigError("--detector " + name + ": no model; give one with --model");
    }
  }
  const auto given = given_parameters(options.settings);
  std::vector<NamedDetector> detectors;
  for (const Choice& choice : choices) {
    vision::DetectorParameters parameters;
    ParameterLoader::load(given, parameters);
    parameters.detector = choice.detector;
    parameters.model_file = choice.model.string();
    const auto alike = std::count_if(choices.begin(), choices.end(), [&](const Choice& other) {
      return other.detector == choice.detector;
    });
    // Two models of one kind are told apart by their files.
    detectors.push_back(
        {alike > 1 ? choice.detector + " " + choice.model.stem().string() : choice.detector,
         vision::make_detector(parameters)});
  }
  return detectors;
}

Result<LoadedImage> load_image(annotation::AnnotatedImage& image, double resolution_mm_per_px) {
  if (const Status loaded = vision::load_pixels(image); !loaded.ok()) return loaded.error();
  const double focal_px = 1000.0 / resolution_mm_per_px;
  LoadedImage result{
      .bgr = image.bgr,
      .depth_m = {},
      .camera = geometry::PinholeCamera({image.bgr.cols, image.bgr.rows, focal_px, focal_px,
                                         0.5 * (image.bgr.cols - 1), 0.5 * (image.bgr.rows - 1)})};
  if (image.depth_path.empty()) return result;
  const auto read = vision::read_image(image.depth_path, vision::ImageChannels::kAsStored);
  if (!read.ok()) return read.error();
  const cv::Mat& depth = *read;
  if (depth.type() != CV_16UC1 || depth.size() != image.bgr.size()) {
    return Error{ErrorCode::kParse,
                 image.depth_path.string() + ": is not a 16-bit depth image of the picture's size"};
  }
  constexpr double kUnit_m = 1e-4;
  depth.convertTo(result.depth_m, CV_32F, kUnit_m);
  result.ground_distance_m = median_depth_m(result.depth_m).value_or(1.0);
  return result;
}

}  // namespace furrow::cli
