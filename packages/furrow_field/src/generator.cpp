#include "furrow_field/generator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <utility>

#include "distance_grid.hpp"
#include "furrow_core/random.hpp"

namespace furrow::field {
namespace {

constexpr int kPlacementTries = 200;
constexpr double kMaxDraws = 1e7;  ///< weeds drawn inside and around a field
constexpr double kLargestSizeDeviation = 2.5;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

Error out_of_range(const std::string& message) {
  return {ErrorCode::kOutOfRange, message};
}

/// The field under construction, with the occupied places.
class Generator {
 public:
  Generator(const FieldParameters& parameters, const SpeciesTable& species, std::uint64_t seed)
      : p_(parameters),
        species_(species),
        seed_(seed),
        crops_(std::max(p_.weed_to_crop_min_m, 0.01)),
        weeds_(std::max(p_.weed_to_weed_min_m, 0.01)) {}

  Result<FieldModel> run() {
    if (Status status = check(); !status.ok()) return status.error();
    field_.name = p_.name;
    field_.length_m = p_.length_m;
    field_.width_m = p_.width_m;
    field_.source = "generated: " + p_.pattern + ", " + number(p_.weeds_per_m2) + " weeds/m2, " +
                    (p_.crop ? "with crop" : "no crop") + ", seed " + std::to_string(seed_);
    if (p_.crop) place_crop();
    Status placed = p_.pattern == "clusters" ? place_clusters() : place_poisson();
    if (!placed.ok()) return placed.error();
    sort_plants(field_);
    std::int64_t id = 0;
    for (Plant& plant : field_.plants) plant.id = id++;
    return std::move(field_);
  }

 private:
  [[nodiscard]] Status check() {
    try {
      validate_parameters(p_);
    } catch (const ConfigError& error) {
      return out_of_range(error.what());
    }
    if (p_.weed_leaves_min > p_.weed_leaves_max || p_.crop_leaves_min > p_.crop_leaves_max) {
      return out_of_range("leaves_min must not exceed leaves_max");
    }
    const double weeds = p_.weeds_per_m2 * p_.length_m * p_.width_m;
    const double crops =
        p_.crop ? (p_.length_m / p_.plant_spacing_m + 1.0) * (p_.width_m / p_.row_spacing_m + 1.0)
                : 0.0;
    // Six standard deviations above the mean; 0.4: the least that spacing jitter leaves.
    if (weeds + 6.0 * std::sqrt(weeds) + crops / 0.4 > static_cast<double>(kMaxPlants)) {
      return out_of_range("the field would hold more than 1000000 plants");
    }
    return check_species();
  }

  [[nodiscard]] Status check_species() {
    if (p_.weed_species.empty()) p_.weed_species = species_.names(PlantKind::kWeed);
    if (p_.weed_species.empty() && p_.weeds_per_m2 > 0.0) {
      return Error{ErrorCode::kNotFound, "the species table has no weed"};
    }
    if (p_.weed_shares.empty()) p_.weed_shares.assign(p_.weed_species.size(), 1.0);
    if (p_.weed_shares.size() != p_.weed_species.size()) {
      return out_of_range("weed_shares must have one entry for each of weed_species");
    }
    share_sum_ = std::accumulate(p_.weed_shares.begin(), p_.weed_shares.end(), 0.0);
    if (!(share_sum_ > 0.0) && !p_.weed_species.empty()) {
      return out_of_range("weed_shares must not all be 0");
    }
    for (const std::string& name : p_.weed_species) {
      const Species* found = species_.find(name);
      if (found == nullptr || found->kind != PlantKind::kWeed) {
        return Error{ErrorCode::kNotFound, "weed_species: '" + name + "' is no weed of the table"};
      }
    }
    const Species* crop = species_.find(p_.crop_species);
    if (p_.crop && (crop == nullptr || crop->kind != PlantKind::kCrop)) {
      return Error{ErrorCode::kNotFound,
                   "crop_species: '" + p_.crop_species + "' is no crop of the table"};
    }
    return {};
  }

  void place_crop() {
    const double half_m = 0.5 * p_.width_m;
    const auto first = static_cast<int>(std::ceil((-half_m - p_.row_offset_m) / p_.row_spacing_m));
    const auto last = static_cast<int>(std::floor((half_m - p_.row_offset_m) / p_.row_spacing_m));
    std::uint64_t index = 0;
    for (int row = first; row <= last; ++row) {
      const double row_y_m = p_.row_offset_m + row * p_.row_spacing_m;
      field_.row_y_m.push_back(row_y_m);
      Random random(seed_, "crop_positions", field_.row_y_m.size());
      double x_m = random.uniform(0.0, p_.plant_spacing_m);
      while (x_m <= p_.length_m) {
        const double y_m = row_y_m + random.normal(0.0, p_.row_sd_m);
        const bool missing = random.bernoulli(p_.missing_probability);
        if (!missing) {
          add(*species_.find(p_.crop_species), {x_m, std::clamp(y_m, -half_m, half_m)},
              p_.crop_leaves_min, p_.crop_leaves_max, Random(seed_, "crop_traits", index));
          crops_.insert(field_.plants.back().p_F_m);
        }
        ++index;
        x_m += std::max(0.4 * p_.plant_spacing_m,
                        random.normal(p_.plant_spacing_m, p_.plant_spacing_sd_m));
      }
    }
  }

  Status place_poisson() {
    Random random(seed_, "weed_number");
    const std::int64_t weeds = random.poisson(p_.weeds_per_m2 * p_.length_m * p_.width_m);
    for (std::int64_t i = 0; i < weeds; ++i) {
      Random place(seed_, "weed_positions", i);
      const auto uniform = [&] {
        const double x_m = place.uniform(0.0, p_.length_m);
        return Eigen::Vector2d(x_m, place.uniform(-0.5 * p_.width_m, 0.5 * p_.width_m));
      };
      if (Status status = place_weed(uniform(), uniform); !status.ok()) return status;
    }
    return {};
  }

  /// Parents are also drawn in a border of four standard deviations: else the density would fall
  /// towards the edges. Weeds outside the field are dropped.
  Status place_clusters() {
    const double border_m = 4.0 * p_.cluster_sd_m;
    const double length_m = p_.length_m + 2.0 * border_m;
    const double width_m = p_.width_m + 2.0 * border_m;
    Random random(seed_, "clusters");
    const double mean_parents = p_.weeds_per_m2 / p_.cluster_weeds * length_m * width_m;
    if (mean_parents * std::max(1.0, p_.cluster_weeds) > kMaxDraws) {
      return out_of_range("too many clusters: cluster_sd_m is too large for this field");
    }
    const std::int64_t parents = random.poisson(mean_parents);
    for (std::int64_t i = 0; i < parents; ++i) {
      Random cluster(seed_, "cluster", i);
      const double x_m = cluster.uniform(-border_m, p_.length_m + border_m);
      const double y_m = cluster.uniform(-0.5 * width_m, 0.5 * width_m);
      const auto near_parent = [&] {
        const double weed_x_m = cluster.normal(x_m, p_.cluster_sd_m);
        return Eigen::Vector2d(weed_x_m, cluster.normal(y_m, p_.cluster_sd_m));
      };
      const std::int64_t weeds = cluster.poisson(p_.cluster_weeds);
      for (std::int64_t k = 0; k < weeds; ++k) {
        const Eigen::Vector2d p_m = near_parent();
        if (!inside(p_m)) continue;
        if (field_.plants.size() >= kMaxPlants) return out_of_range("more than 1000000 plants");
        if (Status status = place_weed(p_m, near_parent); !status.ok()) return status;
      }
    }
    return {};
  }

  template <class Draw>
  Status place_weed(Eigen::Vector2d p_m, const Draw& draw) {
    for (int attempt = 0; attempt < kPlacementTries; ++attempt) {
      if (inside(p_m) && !crops_.any_within(p_m, p_.weed_to_crop_min_m) &&
          !weeds_.any_within(p_m, p_.weed_to_weed_min_m)) {
        Random traits(seed_, "weed_traits", weeds_placed_++);
        const Species& kind = draw_species(traits);
        add(kind, p_m, p_.weed_leaves_min, p_.weed_leaves_max, traits);
        if (p_.weed_to_weed_min_m > 0.0) weeds_.insert(p_m);
        return {};
      }
      p_m = draw();
    }
    return Error{ErrorCode::kNoSolution,
                 "no room for a weed with weed_to_crop_min_m " + number(p_.weed_to_crop_min_m) +
                     " and weed_to_weed_min_m " + number(p_.weed_to_weed_min_m)};
  }

  [[nodiscard]] bool inside(const Eigen::Vector2d& p_m) const {
    return p_m.x() >= 0.0 && p_m.x() <= p_.length_m && std::abs(p_m.y()) <= 0.5 * p_.width_m;
  }

  [[nodiscard]] const Species& draw_species(Random& random) const {
    double left = random.uniform(0.0, share_sum_);
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < p_.weed_shares.size(); ++i) {
      if (p_.weed_shares[i] <= 0.0) continue;
      chosen = i;
      if (left < p_.weed_shares[i]) break;
      left -= p_.weed_shares[i];
    }
    return *species_.find(p_.weed_species[chosen]);
  }

  void add(const Species& kind, const Eigen::Vector2d& p_m, std::int64_t leaves_min,
           std::int64_t leaves_max, Random random) {
    Plant plant;
    plant.kind = kind.kind;
    plant.species = kind.name;
    plant.p_F_m = p_m;
    plant.leaves = static_cast<int>(random.integer(leaves_min, leaves_max));
    const double deviation =
        std::clamp(random.normal(0.0, 1.0), -kLargestSizeDeviation, kLargestSizeDeviation);
    plant.radius_m = canopy_radius_m(kind, plant.leaves) * std::exp(p_.size_sd * deviation);
    plant.area_mm2 = leaf_area_mm2(kind, plant.radius_m);
    plant.heading_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    field_.plants.push_back(std::move(plant));
  }

  FieldParameters p_;
  const SpeciesTable& species_;
  std::uint64_t seed_;
  DistanceGrid crops_;
  DistanceGrid weeds_;
  FieldModel field_;
  double share_sum_ = 0.0;
  std::uint64_t weeds_placed_ = 0;
};

}  // namespace

Result<FieldModel> generate_field(const FieldParameters& parameters, const SpeciesTable& species,
                                  std::uint64_t seed) {
  return Generator(parameters, species, seed).run();
}

}  // namespace furrow::field
