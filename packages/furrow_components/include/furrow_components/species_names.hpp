#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "furrow_msgs/furrow_msgs.h"
#include "furrow_tracking/track.hpp"

namespace furrow::components {

/// The table of species to which the vectors of tracking::Observation and tracking::Track refer.
/// It holds the species that views have named, in the order of their first view.
class SpeciesNames {
 public:
  struct Entry {
    std::string name;
    bool crop = false;  ///< else a weed
  };
  static constexpr std::size_t kMost = 32;

  /// The distribution of one view by this table, which gets the species that are new. Empty where
  /// the view names none. A species beyond kMost is left out, so that its share counts as unknown;
  /// `overflow` is then true.
  [[nodiscard]] std::vector<float> take(
      std::span<const furrow_msgs::msg::SpeciesProbability> species, bool& overflow);

  /// The most probable species of the track's own kind (crop or weed); nullopt: none was seen.
  [[nodiscard]] std::optional<std::string> of_kind(const tracking::Track& track) const;

  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
};

}  // namespace furrow::components
