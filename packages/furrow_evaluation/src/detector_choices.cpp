#include "furrow_evaluation/detector_choices.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "furrow_core/error.hpp"
#include "furrow_launch/installation.hpp"
#include "furrow_launch/settings.hpp"
#include "furrow_vision/model_file.hpp"

namespace furrow::evaluation {
namespace {

namespace fs = std::filesystem;

struct Choice {
  std::string detector;
  fs::path model;  ///< empty: the detector has none
};

std::string kind_of(const fs::path& model_file) {
  const auto model = vision::read_model_file(model_file);
  if (!model.ok()) throw ConfigError(model.error().message);
  return model->kind == vision::ModelFile::Kind::kOneStage ? "one_stage" : "mask_rcnn";
}

fs::path shipped_model(const std::string& detector) {
  return launch::share_folder() / "models" / (detector + ".yaml");
}

bool has_model(const std::vector<Choice>& models, const std::string& detector) {
  return std::ranges::find(models, detector, &Choice::detector) != models.end();
}

/// The given models, and the shipped one of each kind that was not given.
std::vector<Choice> known_models(const std::vector<std::string>& given) {
  std::vector<Choice> models;
  for (const std::string& file : given) models.push_back({kind_of(file), file});
  for (const char* detector : {"one_stage", "mask_rcnn"}) {
    if (!has_model(models, detector) && fs::exists(shipped_model(detector))) {
      models.push_back({detector, shipped_model(detector)});
    }
  }
  return models;
}

std::vector<Choice> chosen(const DetectorChoices& choices) {
  const std::vector<Choice> models = known_models(choices.models);
  std::vector<Choice> result;
  if (choices.detectors.empty()) {
    result.push_back({"index", {}});
    result.insert(result.end(), models.begin(), models.end());
  }
  for (const std::string& name : choices.detectors) {
    if (name == "index") {
      result.push_back({name, {}});
    } else if (!has_model(models, name)) {
      throw ConfigError("--detector " + name + ": there is no model; give one with --model");
    }
    std::ranges::copy_if(models, std::back_inserter(result),
                         [&](const Choice& model) { return model.detector == name; });
  }
  return result;
}

}  // namespace

std::vector<NamedDetector> make_detectors(const DetectorChoices& choices) {
  const auto given = launch::given_parameters(choices.settings);
  const std::vector<Choice> all = chosen(choices);
  std::vector<NamedDetector> detectors;
  for (const Choice& choice : all) {
    vision::DetectorParameters parameters;
    ParameterLoader::load(given, parameters);
    parameters.detector = choice.detector;
    parameters.model_file = choice.model.string();
    // Two models of one kind are told apart by their files.
    const bool several = std::ranges::count(all, choice.detector, &Choice::detector) > 1;
    detectors.push_back(
        {several ? choice.detector + " " + choice.model.stem().string() : choice.detector,
         vision::make_detector(parameters)});
  }
  return detectors;
}

}  // namespace furrow::evaluation
