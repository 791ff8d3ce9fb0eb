#include "furrow_components/track_field.hpp"
#include "furrow_configuration/parameter_file.hpp"
#include "furrow_evaluation/tracking_experiment.hpp"
#include "furrow_launch/installation.hpp"

namespace furrow::evaluation {
namespace {

/// What stands in the parameter files of the shipped components.
struct TrackerFile {
  components::ObservationParameters observation;
  components::TrackFieldParameters field;
  tracking::TrackerParameters tracker;
  void visit(ParameterVisitor& v) {
    observation.visit(v);
    field.visit(v);
    tracker.visit(v);
  }
};
struct LocalizationFile {
  std::string estimator;
  localization::PoseFilterParameters filter;
  components::GeoreferenceParameters georeference;
  void visit(ParameterVisitor& v) {
    v.visit({.name = "estimator", .description = "odometry or filter"}, estimator);
    PrefixedVisitor filter_visitor(v, "filter_");
    filter.visit(filter_visitor);
    georeference.visit(v);
  }
};

}  // namespace

ReplayOptions shipped_replay_options() {
  ReplayOptions replay;
  const auto tracker = configuration::load_parameter_file<TrackerFile>(
      launch::find_shipped("tracker", "components"));
  replay.observation = tracker.observation;
  replay.tracker = tracker.tracker;
  const auto localization = configuration::load_parameter_file<LocalizationFile>(
      launch::find_shipped("localization_rtk", "components"));
  replay.filter = localization.filter;
  replay.georeference = localization.georeference;
  return replay;
}

}  // namespace furrow::evaluation
