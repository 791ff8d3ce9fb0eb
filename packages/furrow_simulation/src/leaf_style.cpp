#include "leaf_style.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace furrow::simulation {
namespace {

using field::LeafForm;

/// A factor with a median of 1 whose logarithm has this standard deviation, cut at two of them.
float log_normal_factor(double deviation, Random& random) {
  return static_cast<float>(std::exp(deviation * std::clamp(random.normal(0.0, 1.0), -2.0, 2.0)));
}

LeafStyle beet_style() {
  return {.outline = Outline::kOval,
          .cotyledon = Outline::kOval,
          .cotyledon_length = 0.42f,
          .cotyledon_width = 0.15f,
          .length = 0.76f,
          .width = 0.40f,
          .petiole = 0.26f,
          .petiole_width = 0.055f,
          .pitch = 0.55f,
          .droop = 0.95f,
          .fold = 0.22f,
          .wave = 0.035f,
          .waves = 2.3f,
          .rows = 14};
}

LeafStyle round_style() {
  return {.outline = Outline::kRound,
          .cotyledon = Outline::kRound,
          .cotyledon_length = 0.3f,
          .cotyledon_width = 0.22f,
          .length = 0.42f,
          .width = 0.36f,
          .petiole = 0.5f,
          .petiole_width = 0.045f,
          .pitch = 0.12f,
          .droop = 0.3f,
          .fold = 0.1f,
          .wave = 0.01f,
          .waves = 2.0f,
          .rows = 8};
}

LeafStyle thistle_style() {
  return {.outline = Outline::kToothed,
          .cotyledon = Outline::kObovate,
          .cotyledon_length = 0.3f,
          .cotyledon_width = 0.18f,
          .length = 0.92f,
          .width = 0.32f,
          .petiole = 0.05f,
          .petiole_width = 0.06f,
          .pitch = 0.3f,
          .droop = 0.55f,
          .fold = 0.25f,
          .wave = 0.03f,
          .waves = 5.0f,
          .rows = 30};
}

LeafStyle broadleaf_style() {
  return {.outline = Outline::kPointed,
          .cotyledon = Outline::kOval,
          .cotyledon_length = 0.5f,
          .cotyledon_width = 0.13f,
          .length = 0.62f,
          .width = 0.34f,
          .petiole = 0.26f,
          .petiole_width = 0.04f,
          .pitch = 0.3f,
          .droop = 0.55f,
          .fold = 0.2f,
          .wave = 0.015f,
          .waves = 2.0f,
          .node = 0.16f,
          .rows = 12};
}

LeafStyle lobed_style() {
  return {.outline = Outline::kRhombic,
          .cotyledon = Outline::kStrap,
          .cotyledon_length = 0.45f,
          .cotyledon_width = 0.10f,
          .length = 0.60f,
          .width = 0.44f,
          .petiole = 0.30f,
          .petiole_width = 0.035f,
          .pitch = 0.35f,
          .droop = 0.5f,
          .fold = 0.12f,
          .wave = 0.012f,
          .waves = 3.0f,
          .node = 0.17f,
          .rows = 20};
}

}  // namespace

LeafStyle leaf_style(LeafForm form) {
  switch (form) {
    case LeafForm::kBeet:
      return beet_style();
    case LeafForm::kRosette:
      return round_style();
    case LeafForm::kThistle:
      return thistle_style();
    case LeafForm::kBroadleaf:
      return broadleaf_style();
    case LeafForm::kLobed:
      return lobed_style();
    default:
      return {};
  }
}

LeafColors leaf_colors(LeafForm form) {
  switch (form) {
    case LeafForm::kBeet:
      return {{0.38f, 0.56f, 0.22f}, {0.50f, 0.66f, 0.28f}, {0.60f, 0.68f, 0.42f}};
    case LeafForm::kBroadleaf:
      return {{0.42f, 0.58f, 0.26f}, {0.52f, 0.66f, 0.30f}, {0.58f, 0.52f, 0.36f}};
    case LeafForm::kLobed:
      return {{0.44f, 0.56f, 0.36f}, {0.60f, 0.68f, 0.50f}, {0.56f, 0.60f, 0.40f}};
    case LeafForm::kGrass:
      return {{0.46f, 0.62f, 0.26f}, {0.56f, 0.68f, 0.30f}, {0.56f, 0.58f, 0.36f}};
    case LeafForm::kFeathery:
      return {{0.36f, 0.56f, 0.24f}, {0.46f, 0.64f, 0.28f}, {0.48f, 0.60f, 0.32f}};
    case LeafForm::kTrifoliate:
      return {{0.36f, 0.58f, 0.28f}, {0.46f, 0.66f, 0.32f}, {0.50f, 0.58f, 0.34f}};
    case LeafForm::kRosette:
      return {{0.42f, 0.60f, 0.28f}, {0.52f, 0.68f, 0.30f}, {0.54f, 0.58f, 0.34f}};
    case LeafForm::kThistle:
      return {{0.38f, 0.54f, 0.30f}, {0.52f, 0.64f, 0.40f}, {0.58f, 0.62f, 0.46f}};
    case LeafForm::kWhorled:
      return {{0.36f, 0.54f, 0.24f}, {0.46f, 0.62f, 0.28f}, {0.46f, 0.54f, 0.30f}};
  }
  return {};
}

LeafStyle varied(LeafStyle style, LeafForm form, double amount, Random& random) {
  if (amount <= 0.0) return style;
  const auto vary = [&](float& value, double deviation) {
    value *= log_normal_factor(deviation * amount, random);
  };
  const bool beet = form == LeafForm::kBeet;
  vary(style.width, beet ? 0.28 : 0.4);
  vary(style.length, 0.15);
  vary(style.petiole, 0.45);
  vary(style.petiole_width, 0.25);
  vary(style.pitch, 0.4);
  vary(style.droop, 0.4);
  vary(style.fold, 0.5);
  vary(style.wave, 0.7);
  vary(style.waves, 0.4);
  vary(style.node, 0.35);
  vary(style.cotyledon_length, 0.25);
  vary(style.cotyledon_width, 0.3);
  if (beet) {
    constexpr Outline kRounded[] = {Outline::kOval, Outline::kOval, Outline::kObovate,
                                    Outline::kPointed};
    if (random.bernoulli(0.6 * amount)) {
      style.outline =
          kRounded[random.integer(0, static_cast<std::int64_t>(std::size(kRounded)) - 1)];
    }
  } else if (random.bernoulli(0.5 * amount)) {
    constexpr Outline kAny[] = {Outline::kOval,  Outline::kPointed, Outline::kPointed,
                                Outline::kStrap, Outline::kRhombic, Outline::kToothed,
                                Outline::kRound, Outline::kObovate};
    style.outline = kAny[random.integer(0, static_cast<std::int64_t>(std::size(kAny)) - 1)];
    if (style.outline == Outline::kToothed) style.rows = std::max(style.rows, 24);
    if (style.outline == Outline::kStrap) style.width *= 0.5f;
  }
  style.width = std::clamp(style.width, 0.05f, 0.9f);
  style.petiole = std::min(style.petiole, 0.8f);
  style.wave = std::min(style.wave, 0.09f);
  style.fold = std::min(style.fold, 0.6f);
  return style;
}

PlantHabit varied_habit(LeafForm form, int leaves, double amount, Random& random) {
  PlantHabit habit{.form = form, .leaves = leaves};
  if (amount <= 0.0) return habit;
  if (random.bernoulli(0.4 * amount)) {
    habit.stalk_red_gain = static_cast<float>(random.uniform(1.1, 1.5));
  }
  if (form == LeafForm::kBeet) {
    constexpr int kMostLeaves = 16;
    if (random.bernoulli(0.5 * amount)) {
      habit.leaves = std::min(leaves + static_cast<int>(random.integer(1, 6)), kMostLeaves);
    }
    habit.missing_leaf_probability = 0.12 * amount;
    return habit;
  }
  if (form == LeafForm::kGrass || !random.bernoulli(0.5 * amount)) return habit;
  constexpr LeafForm kHabits[] = {LeafForm::kBroadleaf, LeafForm::kBroadleaf, LeafForm::kLobed,
                                  LeafForm::kRosette, LeafForm::kThistle};
  habit.form = kHabits[random.integer(0, static_cast<std::int64_t>(std::size(kHabits)) - 1)];
  habit.sprawls = random.bernoulli(0.6);
  return habit;
}

}  // namespace furrow::simulation
