#pragma once

#include <cstdint>
#include <filesystem>

#include "furrow_core/result.hpp"
#include "furrow_field/field_model.hpp"
#include "furrow_field/species.hpp"

namespace furrow::components {

/// The species table of a file (params/species.yaml), or Furrow's own where the path is empty.
/// Throws ConfigError.
[[nodiscard]] field::SpeciesTable load_species(const std::filesystem::path& path);

/// A field from a file: plants of a CSV or GeoJSON file, or a preset (YAML) generated from the
/// seed. `length_m` > 0 sets the length of a generated field, not that of plants from a file.
/// Throws ConfigError with file, line and key.
[[nodiscard]] field::FieldModel load_field(const std::filesystem::path& path,
                                           const field::SpeciesTable& species, double length_m,
                                           std::uint64_t seed);

}  // namespace furrow::components
