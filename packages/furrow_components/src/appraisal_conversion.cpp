#include "appraisal_conversion.hpp"

#include <algorithm>
#include <string>

namespace furrow::components {

void weed_species(const furrow_msgs::msg::Track& track,
                  std::vector<planning::SpeciesShare>& shares) {
  shares.clear();
  double of_crops = 0.0;
  for (const auto& species : track.species()) {
    if (species.crop()) of_crops += species.probability();
  }
  // The track is a weed by its class; its species may still say crop.
  const double of_weeds = std::max(1.0 - of_crops, 1e-6);
  for (const auto& species : track.species()) {
    if (species.crop()) continue;
    const double probability = species.probability() / of_weeds;
    // Rounding may exceed 1; what is not a probability is left for the check of the distribution.
    shares.push_back(
        {species.species(), probability > 1.0 && probability < 1.001 ? 1.0 : probability});
  }
  if (shares.empty()) shares.push_back({"", 1.0});
}

furrow_msgs::msg::Appraisal appraisal(const planning::Harmfulness& harmfulness,
                                      const furrow_msgs::msg::Track& track,
                                      const planning::HarmfulnessParameters& parameters) {
  furrow_msgs::msg::Appraisal message;
  message.valid(true);
  message.scheme(parameters.scheme);
  message.species(std::string(harmfulness.species));
  message.species_probability(harmfulness.species_probability);
  message.unknown_probability(harmfulness.unknown_probability);
  message.area_mm2(track.area_mm2());
  message.leaves(track.leaves());
  message.beta(harmfulness.beta);
  message.class_weight(harmfulness.class_weight);
  message.crop_distance_m(harmfulness.crop_distance_m);
  message.crop_proximity(harmfulness.crop_proximity);
  message.worth(harmfulness.weight);
  message.threshold(parameters.left_standing_below);
  return message;
}

}  // namespace furrow::components
