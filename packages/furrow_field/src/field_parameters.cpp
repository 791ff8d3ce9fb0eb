#include "furrow_field/generator.hpp"

namespace furrow::field {

namespace {

void visit_weeds(FieldParameters& p, ParameterVisitor& v) {
  v.visit({.name = "name", .description = "the field's name"}, p.name);
  v.visit({.name = "length_m",
           .unit = "m",
           .description = "along the row",
           .min = 0.1,
           .max = kMaxFieldLength_m},
          p.length_m);
  v.visit({.name = "width_m",
           .unit = "m",
           .description = "across the row",
           .min = 0.05,
           .max = kMaxFieldWidth_m},
          p.width_m);
  v.visit({.name = "weeds_per_m2",
           .unit = "1/m2",
           .description = "expected density",
           .min = 0.0,
           .max = 10'000.0},
          p.weeds_per_m2);
  v.visit({.name = "pattern",
           .description = "how weeds are spread: evenly at random, or in clusters",
           .choices = {"poisson", "clusters"}},
          p.pattern);
  v.visit({.name = "cluster_weeds",
           .description = "mean number of weeds of a cluster",
           .min = 0.1,
           .max = 10'000.0},
          p.cluster_weeds);
  v.visit({.name = "cluster_sd_m",
           .unit = "m",
           .description = "standard deviation of a weed from its cluster's middle, along x and y",
           .min = 0.001,
           .max = 10.0},
          p.cluster_sd_m);
  v.visit({.name = "weed_species", .description = "names; empty: every weed of the table"},
          p.weed_species);
  v.visit({.name = "weed_shares",
           .description = "weight of each of weed_species; empty: equal",
           .min = 0.0,
           .max = 1e6},
          p.weed_shares);
  v.visit({.name = "weed_leaves_min",
           .description = "least growth stage, in leaves",
           .min = 2,
           .max = 20},
          p.weed_leaves_min);
  v.visit({.name = "weed_leaves_max", .description = "greatest growth stage", .min = 2, .max = 20},
          p.weed_leaves_max);
}

void visit_crop(FieldParameters& p, ParameterVisitor& v) {
  v.visit({.name = "crop", .description = "false: weeds only"}, p.crop);
  v.visit({.name = "crop_species", .description = "a crop of the species table"}, p.crop_species);
  v.visit({.name = "row_spacing_m",
           .unit = "m",
           .description = "between crop rows",
           .min = 0.05,
           .max = 10.0},
          p.row_spacing_m);
  v.visit({.name = "row_offset_m",
           .unit = "m",
           .description = "y of a row; the others follow",
           .min = -10.0,
           .max = 10.0},
          p.row_offset_m);
  v.visit({.name = "plant_spacing_m",
           .unit = "m",
           .description = "between crops in a row",
           .min = 0.02,
           .max = 10.0},
          p.plant_spacing_m);
  v.visit({.name = "plant_spacing_sd_m",
           .unit = "m",
           .description = "its standard deviation",
           .min = 0.0,
           .max = 1.0},
          p.plant_spacing_sd_m);
  v.visit({.name = "row_sd_m",
           .unit = "m",
           .description = "standard deviation of a crop across its row",
           .min = 0.0,
           .max = 1.0},
          p.row_sd_m);
  v.visit({.name = "missing_probability",
           .description = "that a crop did not come up",
           .min = 0.0,
           .max = 1.0},
          p.missing_probability);
  v.visit({.name = "crop_leaves_min",
           .description = "least growth stage, in leaves",
           .min = 2,
           .max = 20},
          p.crop_leaves_min);
  v.visit({.name = "crop_leaves_max", .description = "greatest growth stage", .min = 2, .max = 20},
          p.crop_leaves_max);
}

void visit_sizes_and_distances(FieldParameters& p, ParameterVisitor& v) {
  v.visit({.name = "size_sd",
           .description = "standard deviation of the logarithm of a canopy's radius",
           .min = 0.0,
           .max = 1.0},
          p.size_sd);
  v.visit({.name = "weed_to_crop_min_m",
           .unit = "m",
           .description = "least distance between the stems of a weed and a crop",
           .min = 0.0,
           .max = 1.0},
          p.weed_to_crop_min_m);
  v.visit({.name = "weed_to_weed_min_m",
           .unit = "m",
           .description = "least distance between the stems of two weeds",
           .min = 0.0,
           .max = 1.0},
          p.weed_to_weed_min_m);
}

}  // namespace

void FieldParameters::visit(ParameterVisitor& v) {
  visit_weeds(*this, v);
  visit_crop(*this, v);
  visit_sizes_and_distances(*this, v);
}

}  // namespace furrow::field
