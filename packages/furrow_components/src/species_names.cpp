#include "furrow_components/species_names.hpp"

#include <algorithm>

namespace furrow::components {

std::vector<float> SpeciesNames::take(std::span<const furrow_msgs::msg::SpeciesProbability> species,
                                      bool& overflow) {
  overflow = false;
  std::vector<float> probability;
  for (const auto& seen : species) {
    auto entry = std::ranges::find_if(entries_, [&](const Entry& known) {
      return known.crop == seen.crop() && known.name == seen.species();
    });
    if (entry == entries_.end()) {
      if (entries_.size() == kMost) {
        overflow = true;
        continue;
      }
      entry = entries_.insert(entries_.end(), {seen.species(), seen.crop()});
    }
    probability.resize(entries_.size(), 0.0F);
    probability[static_cast<std::size_t>(entry - entries_.begin())] += seen.probability();
  }
  return probability;
}

std::optional<std::string> SpeciesNames::of_kind(const tracking::Track& track) const {
  const bool crop = track.plant_class() == tracking::PlantClass::kCrop;
  const auto& probability = track.species_probability;
  const Entry* best = nullptr;
  float highest = 0.0F;
  for (std::size_t i = 0; i < std::min(entries_.size(), probability.size()); ++i) {
    if (entries_[i].crop != crop || !(probability[i] > highest)) continue;
    highest = probability[i];
    best = &entries_[i];
  }
  return best == nullptr ? std::nullopt : std::optional(best->name);
}

}  // namespace furrow::components
