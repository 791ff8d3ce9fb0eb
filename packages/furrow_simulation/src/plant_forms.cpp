#include "plant_forms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "leaf.hpp"
#include "leaf_style.hpp"

namespace furrow::simulation {
namespace {

using field::LeafForm;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kGoldenAngle = 2.39996323f;

class FormBuilder {
 public:
  FormBuilder(PlantMesh& mesh, const PlantShape& shape, const PlantParameters& parameters,
              Random& random)
      : mesh_(mesh), shape_(shape), parameters_(parameters), random_(random) {
    colors_ = leaf_colors(shape.form);
    plant_hue_ = noise(0.08f * variation());
    plant_gain_ = 1.0f + noise(0.16f * variation());
    yellow_ = random_.bernoulli(0.3 * parameters.leaf_damage) ? uniform(0.15f, 0.6f) : 0.0f;
    habit_ = varied_habit(shape.form, shape.leaves, parameters.form_variation, random_);
    colors_.stalk.x() *= habit_.stalk_red_gain;
  }

  void build() {
    const LeafStyle style =
        varied(leaf_style(habit_.form), habit_.form, parameters_.form_variation, random_);
    switch (habit_.form) {
      case LeafForm::kBeet:
      case LeafForm::kRosette:
      case LeafForm::kThistle:
        return rosette(style);
      case LeafForm::kBroadleaf:
      case LeafForm::kLobed:
        return habit_.sprawls ? sprawl(style) : pairs(style);
      case LeafForm::kGrass:
        return grass();
      case LeafForm::kFeathery:
        return feathery();
      case LeafForm::kTrifoliate:
        return trifoliate();
      case LeafForm::kWhorled:
        return whorls();
    }
  }

 private:
  [[nodiscard]] float variation() const { return static_cast<float>(parameters_.leaf_variation); }
  float uniform(float low, float high) { return static_cast<float>(random_.uniform(low, high)); }
  float noise(float deviation) {
    return deviation * static_cast<float>(std::clamp(random_.normal(0.0, 1.0), -2.5, 2.5));
  }

  Eigen::Vector3f color(const Eigen::Vector3f& seen) {
    const float hue =
        static_cast<float>(parameters_.leaf_hue) + plant_hue_ + noise(0.05f * variation());
    const float gain = static_cast<float>(parameters_.leaf_brightness) * plant_gain_ *
                       (1.0f + noise(0.08f * variation()));
    Eigen::Vector3f out(seen.x() * (1.0f + 0.35f * hue + 0.35f * yellow_), seen.y(),
                        seen.z() * (1.0f - 0.45f * hue));
    out *= std::clamp(gain, 0.4f, 1.7f);
    return out.cwiseMin(0.95f).cwiseMax(0.03f).cwiseAbs2();
  }
  Eigen::Vector3f leaf_color(float youth) {
    return color(colors_.leaf + (colors_.young - colors_.leaf) * std::clamp(youth, 0.0f, 1.0f));
  }

  Leaf blade(const LeafStyle& style, float size, float azimuth, float pitch) {
    Leaf leaf;
    leaf.azimuth_rad = azimuth;
    leaf.pitch_rad = pitch;
    leaf.droop_rad =
        style.droop * static_cast<float>(0.5 + parameters_.leaf_curl) * uniform(0.6f, 1.4f);
    leaf.turn_rad = noise(0.22f);
    leaf.length = style.length * size;
    leaf.width = style.width * size * shape_.blade_width * uniform(0.9f, 1.1f);
    leaf.fold = style.fold * uniform(0.5f, 1.5f);
    leaf.wave =
        style.wave * static_cast<float>(0.4 + 1.2 * parameters_.leaf_curl) * uniform(0.6f, 1.5f);
    leaf.waves = style.waves * uniform(0.8f, 1.2f);
    leaf.phase = uniform(0.0f, 2.0f * kPi);
    leaf.outline = style.outline;
    leaf.rows = style.rows;
    return leaf;
  }

  void stalk(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float width, float sag,
             const Eigen::Vector3f& albedo) {
    add_stalk(mesh_, from, to, std::max(width, shape_.stalk_width), sag, albedo);
  }

  void petiole_and_blade(const LeafStyle& style, Leaf leaf, const Eigen::Vector3f& from, float size,
                         float rise) {
    const float length = style.petiole * size;
    const Eigen::Vector3f to =
        from + length * Eigen::Vector3f(std::cos(leaf.azimuth_rad) * std::cos(rise),
                                        std::sin(leaf.azimuth_rad) * std::cos(rise),
                                        std::sin(rise));
    leaf.base = to;
    add_leaf(mesh_, leaf);
    // Above the blade's base: the petiole runs on into the midrib.
    stalk(from, to + Eigen::Vector3f(0.0f, 0.0f, 0.002f), style.petiole_width * size,
          0.08f * length, color(colors_.stalk));
  }

  void cotyledons(const LeafStyle& style, float azimuth, float size) {
    for (int side = 0; side < 2; ++side) {
      Leaf leaf = blade(style, 1.0f, azimuth + kPi * static_cast<float>(side) + noise(0.1f),
                        uniform(0.05f, 0.3f));
      leaf.outline = style.cotyledon;
      leaf.length = style.cotyledon_length * size * uniform(0.9f, 1.1f);
      leaf.width = style.cotyledon_width * size * shape_.blade_width;
      leaf.wave = 0.0f;
      leaf.rows = 8;
      leaf.albedo_rgb = leaf_color(0.6f);
      leaf.base = {0.02f * size * std::cos(leaf.azimuth_rad),
                   0.02f * size * std::sin(leaf.azimuth_rad), 0.05f * size};
      add_leaf(mesh_, leaf);
    }
  }

  // Leaves around a short stem, the oldest outside.
  void rosette(const LeafStyle& style) {
    const int leaves = habit_.leaves;
    const bool with_cotyledons = leaves <= 6;
    if (with_cotyledons) cotyledons(style, shape_.heading_rad, leaves <= 2 ? 2.2f : 1.1f);
    const int true_leaves = leaves - (with_cotyledons ? 2 : 0);
    float azimuth = shape_.heading_rad + 0.5f * kPi;
    for (int n = 0; n < true_leaves; ++n) {
      const float age = 1.0f - static_cast<float>(n) / static_cast<float>(std::max(true_leaves, 1));
      // Early leaves come in pairs, later ones in a spiral.
      if (n > 0) azimuth += n < 4 && n % 2 == 1 ? kPi : (n < 4 ? 0.5f * kPi : kGoldenAngle);
      if (habit_.missing_leaf_probability > 0.0 && true_leaves > 2 &&
          random_.bernoulli(habit_.missing_leaf_probability))
        continue;
      const float size = (0.52f + 0.48f * std::sqrt(age)) * uniform(0.86f, 1.08f);
      const float inner = 1.0f - age;
      const float pitch = style.pitch * (0.5f + 1.3f * inner) + noise(0.12f);
      Leaf leaf = blade(style, size, azimuth + noise(0.16f), pitch);
      leaf.albedo_rgb = leaf_color(inner * 0.9f);
      petiole_and_blade(style, leaf, {0.0f, 0.0f, 0.02f + 0.03f * inner}, size,
                        pitch + 0.15f + noise(0.05f));
    }
  }

  // Pairs of leaves on an upright stem, each turned by a right angle to the one below.
  void pairs(const LeafStyle& style) {
    cotyledons(style, shape_.heading_rad, shape_.leaves <= 2 ? 2.0f : 1.0f);
    const int true_leaves = shape_.leaves - 2;
    const int nodes = (true_leaves + 1) / 2;
    Eigen::Vector3f node(0.0f, 0.0f, 0.06f);
    const Eigen::Vector3f lean(noise(0.06f), noise(0.06f), 0.0f);
    for (int n = 0; n < nodes; ++n) {
      const float age = 1.0f - static_cast<float>(n) / static_cast<float>(nodes + 1);
      const Eigen::Vector3f next = node + Eigen::Vector3f(0, 0, style.node) * age + lean * age;
      stalk(node, next, 0.05f, 0.0f, color(colors_.stalk));
      node = next;
      const float azimuth =
          shape_.heading_rad + 0.5f * kPi * static_cast<float>(n + 1) + noise(0.2f);
      for (int side = 0; side < 2 && 2 * n + side < true_leaves; ++side) {
        const float size = (0.45f + 0.55f * age) * uniform(0.82f, 1.08f);
        const float pitch = style.pitch * (0.7f + 1.2f * (1.0f - age)) + noise(0.12f);
        Leaf leaf =
            blade(style, size, azimuth + kPi * static_cast<float>(side) + noise(0.15f), pitch);
        leaf.albedo_rgb = leaf_color(1.1f * (1.0f - age));
        petiole_and_blade(style, leaf, node, size, pitch + 0.1f);
      }
    }
  }

  // Shoots that lie on the ground around the stem, with leaves on alternate sides: knotweeds,
  // bindweeds.
  void sprawl(const LeafStyle& style) {
    if (habit_.leaves <= 4) cotyledons(style, shape_.heading_rad, habit_.leaves <= 2 ? 2.0f : 1.0f);
    const int shoots = std::clamp(1 + habit_.leaves / 3, 1, 5);
    for (int k = 0; k < shoots; ++k) {
      const float azimuth = shape_.heading_rad +
                            2.0f * kPi * static_cast<float>(k) / static_cast<float>(shoots) +
                            noise(0.35f);
      const int leaves = 2 + static_cast<int>(random_.integer(0, 2));
      const float reach = uniform(0.35f, 0.8f);
      float heading = azimuth;
      Eigen::Vector3f node(0.0f, 0.0f, 0.04f);
      for (int n = 0; n < leaves; ++n) {
        const float along = static_cast<float>(n) / static_cast<float>(leaves);
        heading += noise(0.25f);
        const Eigen::Vector3f next =
            node + reach / static_cast<float>(leaves) *
                       Eigen::Vector3f(std::cos(heading), std::sin(heading), 0.25f - 0.3f * along);
        stalk(node, next, 0.045f, 0.0f, color(colors_.stalk));
        node = next;
        const float size = (0.75f - 0.3f * along) * uniform(0.7f, 1.1f);
        const bool last = n + 1 == leaves;
        const float side = last ? noise(0.3f) : (n % 2 == 0 ? 1.0f : -1.0f) * uniform(0.5f, 1.2f);
        Leaf leaf = blade(style, size, heading + side, 0.5f * style.pitch + noise(0.15f));
        leaf.albedo_rgb = leaf_color(0.8f * along);
        petiole_and_blade(style, leaf, node, 0.6f * size, 0.1f);
      }
    }
  }

  void grass() {
    const int blades = std::max(shape_.leaves, 2);
    for (int n = 0; n < blades; ++n) {
      Leaf leaf;
      leaf.outline = Outline::kStrap;
      // Two ranks of leaves; tillers turn them.
      leaf.azimuth_rad = shape_.heading_rad + kPi * static_cast<float>(n % 2) +
                         0.25f * static_cast<float>(n - n % 2) + noise(0.35f);
      leaf.length = uniform(0.65f, 1.05f);
      leaf.width = 0.085f * shape_.blade_width * uniform(0.8f, 1.2f);
      leaf.pitch_rad = uniform(0.35f, 1.15f);
      leaf.droop_rad = uniform(0.4f, 1.5f) * static_cast<float>(0.6 + 0.8 * parameters_.leaf_curl);
      leaf.turn_rad = noise(0.35f);
      leaf.fold = uniform(0.1f, 0.5f);
      leaf.rows = 12;
      leaf.columns = 2;
      leaf.base = {0.0f, 0.0f, 0.03f + 0.02f * static_cast<float>(n)};
      leaf.albedo_rgb = leaf_color(uniform(0.0f, 1.0f));
      add_leaf(mesh_, leaf);
    }
  }

  // A rachis with pairs of forked, narrow pinnae.
  void feathery() {
    const int leaves = shape_.leaves;
    LeafStyle style{
        .cotyledon = Outline::kStrap, .cotyledon_length = 0.5f, .cotyledon_width = 0.07f};
    if (leaves <= 4) cotyledons(style, shape_.heading_rad, leaves <= 2 ? 2.0f : 1.1f);
    const int fronds = leaves <= 4 ? leaves - 2 : leaves;
    for (int n = 0; n < fronds; ++n) {
      const float age =
          1.0f - 0.55f * static_cast<float>(n) / static_cast<float>(std::max(fronds, 1));
      const float azimuth =
          shape_.heading_rad + 0.5f * kPi + kGoldenAngle * static_cast<float>(n) + noise(0.2f);
      const float size = age * uniform(0.85f, 1.1f);
      const float pitch = uniform(0.2f, 0.7f) + 0.4f * (1.0f - age);
      const float droop = uniform(0.4f, 1.0f);
      const Eigen::Vector3f albedo = leaf_color(1.0f - age);
      Eigen::Vector3f p(0.0f, 0.0f, 0.03f);
      constexpr int kPairs = 7;
      const float step = size / (kPairs + 2);
      for (int k = 0; k < kPairs + 2; ++k) {
        const float u = static_cast<float>(k) / (kPairs + 1);
        const float slope = pitch - droop * u;
        const Eigen::Vector3f next =
            p + step * Eigen::Vector3f(std::cos(slope) * std::cos(azimuth),
                                       std::cos(slope) * std::sin(azimuth), std::sin(slope));
        stalk(p, next, 0.028f * size, 0.0f, albedo);
        p = next;
        if (k < 2) continue;
        const float reach =
            0.42f * size * std::sin(kPi * (0.18f + 0.72f * u)) * uniform(0.85f, 1.15f);
        for (int side = -1; side <= 1; side += 2) {
          pinna(p, azimuth + static_cast<float>(side) * uniform(0.75f, 1.0f), slope, reach, albedo);
        }
        if (k == kPairs + 1) pinna(p, azimuth, slope, 0.7f * reach, albedo);
      }
    }
  }

  void pinna(const Eigen::Vector3f& base, float azimuth, float pitch, float length,
             const Eigen::Vector3f& albedo) {
    Leaf leaf;
    leaf.outline = Outline::kObovate;
    leaf.base = base;
    leaf.pitch_rad = pitch + noise(0.1f);
    leaf.droop_rad = 0.4f;
    leaf.rows = 4;
    leaf.columns = 2;
    leaf.albedo_rgb = albedo;
    leaf.azimuth_rad = azimuth;
    leaf.length = length;
    leaf.width = 0.24f * length * shape_.blade_width;
    add_leaf(mesh_, leaf);
    for (int side = -1; side <= 1; side += 2) {
      leaf.base =
          base + 0.35f * length * Eigen::Vector3f(std::cos(azimuth), std::sin(azimuth), 0.0f);
      leaf.azimuth_rad = azimuth + 0.75f * static_cast<float>(side) + noise(0.1f);
      leaf.length = 0.52f * length;
      leaf.width = 0.20f * length * shape_.blade_width;
      add_leaf(mesh_, leaf);
    }
  }

  void trifoliate() {
    const int leaves = shape_.leaves;
    LeafStyle style{
        .cotyledon = Outline::kRound, .cotyledon_length = 0.3f, .cotyledon_width = 0.2f};
    if (leaves <= 4) cotyledons(style, shape_.heading_rad, leaves <= 2 ? 2.2f : 1.2f);
    const int stalks = leaves <= 4 ? leaves - 2 : leaves;
    for (int n = 0; n < stalks; ++n) {
      const float size =
          uniform(0.6f, 1.05f) *
          (1.0f - 0.4f * static_cast<float>(n) / static_cast<float>(std::max(stalks, 1)));
      const float azimuth =
          shape_.heading_rad + 0.5f * kPi + kGoldenAngle * static_cast<float>(n) + noise(0.2f);
      const float rise = uniform(0.4f, 0.8f);
      const Eigen::Vector3f to =
          0.62f * size *
          Eigen::Vector3f(std::cos(azimuth) * std::cos(rise), std::sin(azimuth) * std::cos(rise),
                          std::sin(rise));
      stalk({0.0f, 0.0f, 0.01f}, to, 0.03f, 0.03f, color(colors_.stalk));
      const Eigen::Vector3f albedo = leaf_color(static_cast<float>(n) / static_cast<float>(stalks));
      for (int k = -1; k <= 1; ++k) {
        Leaf leaf;
        leaf.outline = Outline::kObovate;
        leaf.base = to;
        leaf.azimuth_rad = azimuth + 2.0f * static_cast<float>(k) + noise(0.1f);
        leaf.pitch_rad = uniform(0.0f, 0.3f);
        leaf.droop_rad = uniform(0.2f, 0.5f);
        leaf.length = 0.38f * size;
        leaf.width = 0.34f * size * shape_.blade_width;
        leaf.fold = uniform(0.05f, 0.3f);
        leaf.rows = 8;
        leaf.albedo_rgb = albedo;
        add_leaf(mesh_, leaf);
      }
    }
  }

  void whorls() {
    LeafStyle style{
        .cotyledon = Outline::kOval, .cotyledon_length = 0.42f, .cotyledon_width = 0.24f};
    cotyledons(style, shape_.heading_rad, shape_.leaves <= 2 ? 2.0f : 1.2f);
    const int whorl_count = std::min((shape_.leaves - 1) / 2, 5);
    Eigen::Vector3f node(0.0f, 0.0f, 0.05f);
    const float lean = uniform(0.0f, 2.0f * kPi);
    for (int n = 0; n < whorl_count; ++n) {
      const float size = 1.0f - 0.12f * static_cast<float>(n);
      const Eigen::Vector3f next =
          node + Eigen::Vector3f(0.22f * std::cos(lean), 0.22f * std::sin(lean), 0.13f) * size;
      stalk(node, next, 0.035f, 0.0f, color(colors_.stalk));
      node = next;
      const Eigen::Vector3f albedo = leaf_color(0.25f * static_cast<float>(n));
      const float turn = uniform(0.0f, kPi);
      constexpr int kLeaves = 6;
      for (int k = 0; k < kLeaves; ++k) {
        Leaf leaf;
        leaf.outline = Outline::kObovate;
        leaf.base = node;
        leaf.azimuth_rad = turn + 2.0f * kPi * static_cast<float>(k) / kLeaves + noise(0.1f);
        leaf.pitch_rad = 0.3f + noise(0.1f);
        leaf.droop_rad = 0.4f;
        leaf.length = 0.5f * size;
        leaf.width = 0.13f * size * shape_.blade_width;
        leaf.rows = 6;
        leaf.columns = 2;
        leaf.albedo_rgb = albedo;
        add_leaf(mesh_, leaf);
      }
    }
  }

  PlantMesh& mesh_;
  const PlantShape& shape_;
  const PlantParameters& parameters_;
  Random& random_;
  LeafColors colors_;
  PlantHabit habit_;
  float plant_hue_ = 0.0f;
  float plant_gain_ = 1.0f;
  float yellow_ = 0.0f;
};

}  // namespace

void build_form(PlantMesh& mesh, const PlantShape& shape, const PlantParameters& parameters,
                Random random) {
  mesh.vertices.clear();
  mesh.triangles.clear();
  FormBuilder(mesh, shape, parameters, random).build();
}

}  // namespace furrow::simulation
