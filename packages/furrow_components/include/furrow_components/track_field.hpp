#pragma once

#include <span>
#include <string>

#include "furrow_components/species_names.hpp"
#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"
#include "furrow_field/field_model.hpp"
#include "furrow_tracking/track.hpp"

namespace furrow::components {

/// Parameters of the field model that a run's tracks are saved as.
struct TrackFieldParameters {
  std::string field_model_file;  ///< .csv or .geojson; empty: none is saved
  double length_m = 20.0;
  std::string field_model_crop_species = "sugar_beet";
  std::string field_model_weed_species;

  void visit(ParameterVisitor& v);
};

/// The field as the robot saw it: each confirmed track with x in [0, length_m] is a plant. The
/// width is the least that holds them all. Crop rows are groups of at least five crops, more than
/// 0.2 m across from the next crop. A track without a species gets the parameters' name for its
/// kind. `species` is the table of the tracks' species.
[[nodiscard]] field::FieldModel field_of_tracks(std::span<const tracking::Track> tracks,
                                                const SpeciesNames& species,
                                                const TrackFieldParameters& parameters);

/// Writes the field whole or not at all, by the extension of the file.
[[nodiscard]] Status write_field(const field::FieldModel& field, const std::string& file);

}  // namespace furrow::components
