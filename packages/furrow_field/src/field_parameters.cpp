#include "furrow_field/generator.hpp"

namespace furrow::field {

void FieldParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "name", .description = "the field's name"}, name);
  v.visit({.name = "length_m",
           .unit = "m",
           .description = "along the row",
           .min = 0.1,
           .max = kMaxFieldLength_m},
          length_m);
  v.visit({.name = "width_m",
           .unit = "m",
           .description = "across the row",
           .min = 0.05,
           .max = kMaxFieldWidth_m},
          width_m);
  v.visit({.name = "weeds_per_m2",
           .unit = "1/m2",
           .description = "expected density",
           .min = 0.0,
           .max = 10'000.0},
          weeds_per_m2);
  v.visit({.name = "pattern",
           .description = "how weeds are spread: evenly at random, or in clusters",
           .choices = {"poisson", "clusters"}},
          pattern);
  v.visit({.name = "cluster_weeds",
           .description = "mean number of weeds of a cluster",
           .min = 0.1,
           .max = 10'000.0},
          cluster_weeds);
  v.visit({.name = "cluster_sd_m",
           .unit = "m",
           .description = "standard deviation of a weed from its cluster's middle, along x and y",
           .min = 0.001,
           .max = 10.0},
          cluster_sd_m);
  v.visit({.name = "weed_species", .description = "names; empty: every weed of the table"},
          weed_species);
  v.visit({.name = "weed_shares",
           .description = "weight of each of weed_species; empty: equal",
           .min = 0.0,
           .max = 1e6},
          weed_shares);
  v.visit({.name = "weed_leaves_min",
           .description = "least growth stage, in leaves",
           .min = 2,
           .max = 20},
          weed_leaves_min);
  v.visit({.name = "weed_leaves_max", .description = "greatest growth stage", .min = 2, .max = 20},
          weed_leaves_max);
  v.visit({.name = "crop", .description = "false: weeds only"}, crop);
  v.visit({.name = "crop_species", .description = "a crop of the species table"}, crop_species);
  v.visit({.name = "row_spacing_m",
           .unit = "m",
           .description = "between crop rows",
           .min = 0.05,
           .max = 10.0},
          row_spacing_m);
  v.visit({.name = "row_offset_m",
           .unit = "m",
           .description = "y of a row; the others follow",
           .min = -10.0,
           .max = 10.0},
          row_offset_m);
  v.visit({.name = "plant_spacing_m",
           .unit = "m",
           .description = "between crops in a row",
           .min = 0.02,
           .max = 10.0},
          plant_spacing_m);
  v.visit({.name = "plant_spacing_sd_m",
           .unit = "m",
           .description = "its standard deviation",
           .min = 0.0,
           .max = 1.0},
          plant_spacing_sd_m);
  v.visit({.name = "row_sd_m",
           .unit = "m",
           .description = "standard deviation of a crop across its row",
           .min = 0.0,
           .max = 1.0},
          row_sd_m);
  v.visit({.name = "missing_probability",
           .description = "that a crop did not come up",
           .min = 0.0,
           .max = 1.0},
          missing_probability);
  v.visit({.name = "crop_leaves_min",
           .description = "least growth stage, in leaves",
           .min = 2,
           .max = 20},
          crop_leaves_min);
  v.visit({.name = "crop_leaves_max", .description = "greatest growth stage", .min = 2, .max = 20},
          crop_leaves_max);
  v.visit({.name = "size_sd",
           .description = "standard deviation of the logarithm of a canopy's radius",
           .min = 0.0,
           .max = 1.0},
          size_sd);
  v.visit({.name = "weed_to_crop_min_m",
           .unit = "m",
           .description = "least distance between the stems of a weed and a crop",
           .min = 0.0,
           .max = 1.0},
          weed_to_crop_min_m);
  v.visit({.name = "weed_to_weed_min_m",
           .unit = "m",
           .description = "least distance between the stems of two weeds",
           .min = 0.0,
           .max = 1.0},
          weed_to_weed_min_m);
}

}  // namespace furrow::field
