#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"

namespace furrow::vision {

/// The maps that a one-stage network gives, one value for each cell of stride x stride pixels of
/// its input; CV_32F, all of one size. Pixel (0, 0) of the input is the centre of its upper left
/// one, and cell (i, j) has its centre at ((i + 0.5) stride - 0.5, (j + 0.5) stride - 0.5).
struct OneStageMaps {
  cv::Mat plant_logit;
  cv::Mat stem_logit;                 ///< high at stems
  cv::Mat offset_u;                   ///< from the cell's centre to its plant's stem, in
  cv::Mat offset_v;                   ///< units of offset_unit_px
  std::vector<cv::Mat> class_logits;  ///< one a class
};

/// Views into the network's output, 1 x (4 + classes) x rows x columns of CV_32F; not copied.
/// kInvalidArgument: another shape, or values that are not finite.
[[nodiscard]] Result<OneStageMaps> split_one_stage_output(const cv::Mat& output,
                                                          std::size_t classes);

/// Lengths on the ground; what visit() declares says each.
struct OneStageDecodingParameters {
  double stem_threshold = 0.25;
  double stem_separation_mm = 8.0;
  double stem_evidence = 1.5;
  double vote_radius_mm = 14.0;
  double vote_radius_factor = 0.35;
  double min_plant_area_mm2 = 10.0;
  void visit(ParameterVisitor& v);
};

/// The grid's scale.
struct CellGrid {
  double stride_px = 4.0;
  double offset_unit_px = 32.0;
  double mm_per_px = 1.15;  ///< of the network's input, on the ground
};

struct StemPeak {
  Eigen::Vector2d stem_px = Eigen::Vector2d::Zero();  ///< in the input
  double probability = 0.0;
};

/// Local maxima of the stem map from the threshold on, strongest first, at most kMaxStems. No two
/// are nearer than the separation. The weighted mean of the points to which the 3 x 3 cells around
/// a maximum point gives the place within the cell.
constexpr int kMaxStems = 4000;
[[nodiscard]] std::vector<StemPeak> find_stems(const OneStageMaps& maps, const CellGrid& grid,
                                               const OneStageDecodingParameters& parameters);

/// Log-odds of a plant in each cell: those of the plant map or, where they are greater, those of
/// the stem map plus stem_evidence. Of a seedling the size of a cell the network often knows the
/// stem, and is undecided about the leaves.
[[nodiscard]] cv::Mat plant_evidence(const OneStageMaps& maps,
                                     const OneStageDecodingParameters& parameters);

struct DecodedPlant {
  Eigen::Vector2d stem_px = Eigen::Vector2d::Zero();  ///< in the input; may lie outside
  double stem_probability = 0.0;     ///< of its peak; of the map at the stem where there was none
  double plant_probability = 0.0;    ///< mean over its cells, by plant_evidence()
  std::vector<double> class_scores;  ///< sum to 1
  int cells = 0;
};

struct DecodedPlants {
  cv::Mat labels;  ///< CV_32S, one value a cell: 0 no plant, i + 1 the i-th plant
  std::vector<DecodedPlant> plants;
};

/// Assigns each cell of vegetation to a plant.
///
/// A cell votes for its centre plus its offset. The nearest stem within vote_radius_mm +
/// vote_radius_factor x |offset| takes it. A stem in vegetation without a vote takes the cell that
/// it stands in. Each connected group of the remaining cells is assigned by the first rule that
/// holds:
/// 1. It points to a stem within three times that radius and touches that stem's plant: it is a
/// part
///    of that plant.
/// 2. It has min_plant_area_mm2: it is a plant, its stem the median vote.
/// 3. It touches a plant: it is a part of that plant.
/// 4. It is dropped.
///
/// Class scores are the softmax of the mean class logits over the cells, weighted by the plant's
/// probability. @pre vegetation is CV_8U of the maps' size.
[[nodiscard]] DecodedPlants decode_one_stage(const OneStageMaps& maps, const cv::Mat& vegetation,
                                             const CellGrid& grid,
                                             const OneStageDecodingParameters& parameters);

}  // namespace furrow::vision
