#pragma once

#include <Eigen/Core>

#include "furrow_core/random.hpp"
#include "furrow_field/species.hpp"
#include "leaf.hpp"

namespace furrow::simulation {

/// Proportions of a plant's leaves. Lengths are shares of the canopy's radius.
struct LeafStyle {
  Outline outline = Outline::kOval;
  Outline cotyledon = Outline::kOval;
  float cotyledon_length = 0.35f;
  float cotyledon_width = 0.12f;
  float length = 0.7f;  // of the blade
  float width = 0.4f;   // of the blade, both halves
  float petiole = 0.3f;
  float petiole_width = 0.05f;
  float pitch = 0.35f;
  float droop = 0.7f;
  float fold = 0.15f;
  float wave = 0.03f;
  float waves = 2.5f;
  float node = 0.14f;  // between pairs of leaves along the stem
  int rows = 12;
};

/// Colours as seen in pictures; squared they are linear.
struct LeafColors {
  Eigen::Vector3f leaf;
  Eigen::Vector3f young;
  Eigen::Vector3f stalk;
};

/// The usual proportions and colours of a form.
[[nodiscard]] LeafStyle leaf_style(field::LeafForm form);
[[nodiscard]] LeafColors leaf_colors(field::LeafForm form);

/// Draws other proportions around the usual ones. `amount` 0 changes nothing and draws nothing; at
/// 1 widths vary by a factor of about 1.5 in either direction (one standard deviation), and half of
/// the weeds get another outline. A beet keeps rounded outlines.
[[nodiscard]] LeafStyle varied(LeafStyle style, field::LeafForm form, double amount,
                               Random& random);

/// How a plant grows.
struct PlantHabit {
  field::LeafForm form = field::LeafForm::kBeet;
  int leaves = 2;
  bool sprawls = false;  ///< shoots lie on the ground; broadleaf and lobed forms only
  double missing_leaf_probability = 0.0;
  float stalk_red_gain = 1.0f;
};

/// Plants of one name differ in the field by more than proportions: weeds take another habit at
/// times, beets have more leaves than their growth stage says. `amount` 0 changes and draws
/// nothing.
[[nodiscard]] PlantHabit varied_habit(field::LeafForm form, int leaves, double amount,
                                      Random& random);

}  // namespace furrow::simulation
