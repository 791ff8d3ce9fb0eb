#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "furrow_core/statistics.hpp"
#include "furrow_core/test_support/cpu_time.hpp"
#include "simulated_row.hpp"

namespace furrow::tracking {
namespace {

using namespace test;

struct Result {
  TrackingScores scores;
  std::vector<Track> plants;  ///< believed tracks, living or passed
  std::int64_t crops = 0;
  std::int64_t weeds = 0;
};

void collect(std::span<const Track> tracks, Result& result) {
  for (const Track& track : tracks) {
    if (!track.confirmed || track.end_reason == EndReason::kMerged) continue;
    result.plants.push_back(track);
    ++(track.plant_class() == PlantClass::kCrop ? result.crops : result.weeds);
  }
}

Result drive(const Row& row, const TrackerParameters& parameters = {}) {
  Tracker tracker(parameters);
  TrackingEvaluation evaluation(0.04);
  Result result;
  for (int i = 0; i < row.views(); ++i) {
    const View view = row.view(i);
    EXPECT_TRUE(tracker.update(view, row.observe(view)).ok());
    collect(tracker.ended(), result);
    EXPECT_TRUE(evaluation.add_frame(row.truth_in(view), tracked_in(tracker, view)).ok());
  }
  tracker.finish();
  collect(tracker.ended(), result);
  result.scores = evaluation.scores();
  return result;
}

TEST(TrackerOnARow, NeverSwitchesIdentitiesAtLowNoiseAndCountsEachPlantOnce) {
  for (const double density : {3.1, 22.3, 81.2}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      RowOptions options;
      options.weeds_per_m2 = density;
      options.stem_sigma_m = 0.001;
      options.detection_probability = 1.0;
      options.wrong_class_probability = 0.0;
      const Row row(seed, options);
      const Result result = drive(row);
      EXPECT_EQ(result.scores.id_switches, 0);
      const auto crops = std::count_if(row.plants().begin(), row.plants().end(), [](const auto& p) {
        return p.plant_class == PlantClass::kCrop;
      });
      EXPECT_EQ(result.crops, crops);
      EXPECT_EQ(result.weeds, static_cast<std::int64_t>(row.plants().size()) - crops);
    }
  }
}

TEST(TrackerOnARow, CountsWithinTwoPercentUnderNoiseMissesGhostsAndWrongClasses) {
  std::vector<std::int64_t> crops_true;
  std::vector<std::int64_t> crops_counted;
  std::vector<std::int64_t> weeds_true;
  std::vector<std::int64_t> weeds_counted;
  std::int64_t switches = 0;
  std::int64_t plants = 0;
  for (const double density : {3.1, 8.2, 22.3, 81.2}) {
    RowOptions options;
    options.weeds_per_m2 = density;
    options.stem_sigma_m = 0.003;
    options.detection_probability = 0.9;
    options.wrong_class_probability = 0.05;
    options.ghosts_per_view = 1.0;
    options.pose_sigma_m = 0.003;
    const Row row(21, options);
    const Result result = drive(row);
    const auto crops = std::count_if(row.plants().begin(), row.plants().end(), [](const auto& p) {
      return p.plant_class == PlantClass::kCrop;
    });
    crops_true.push_back(crops);
    crops_counted.push_back(result.crops);
    weeds_true.push_back(static_cast<std::int64_t>(row.plants().size()) - crops);
    weeds_counted.push_back(result.weeds);
    switches += result.scores.id_switches;
    plants += static_cast<std::int64_t>(row.plants().size());
    RecordProperty("hota_permille_at_" + std::to_string(static_cast<int>(density)),
                   static_cast<int>(1e3 * result.scores.hota));
    RecordProperty("idf1_permille_at_" + std::to_string(static_cast<int>(density)),
                   static_cast<int>(1e3 * result.scores.idf1));
  }
  const double crop_nae_pct = *count_nae_pct(crops_true, crops_counted);
  const double weed_nae_pct = *count_nae_pct(weeds_true, weeds_counted);
  RecordProperty("crop_nae_milli_pct", static_cast<int>(1e3 * crop_nae_pct));
  RecordProperty("weed_nae_milli_pct", static_cast<int>(1e3 * weed_nae_pct));
  RecordProperty("id_switches", static_cast<int>(switches));
  RecordProperty("plants", static_cast<int>(plants));
  EXPECT_LE(crop_nae_pct, 2.0);
  EXPECT_LE(weed_nae_pct, 2.0);
  EXPECT_LE(static_cast<double>(switches), 0.01 * static_cast<double>(plants));
}

TEST(TrackerOnARow, FusedClassesErrAsRarelyAsAMajorityOfTheViews) {
  RowOptions options;
  options.length_m = 20.0;
  options.weeds_per_m2 = 40.0;
  options.least_distance_m = 0.04;
  options.detection_probability = 1.0;
  options.wrong_class_probability = 0.15;
  const Row row(25, options);
  const Result result = drive(row);
  const auto crops = std::count_if(row.plants().begin(), row.plants().end(), [](const auto& p) {
    return p.plant_class == PlantClass::kCrop;
  });
  ASSERT_EQ(result.plants.size(), row.plants().size());
  // Of 11 views at least 6 are wrong with a probability of 0.3 %; weeds are ten times as many as
  // crops, so their errors show as crops too many.
  const auto count = static_cast<double>(row.plants().size());
  const double expected = 0.003 * count;
  EXPECT_LE(std::abs(static_cast<double>(result.crops - crops)),
            expected + 4.0 * std::sqrt(expected));
}

TEST(TrackerOnARow, PositionsAreRefinedAndTheirCovarianceIsHonest) {
  RowOptions options;
  options.stem_sigma_m = 0.004;
  options.least_distance_m = 0.05;
  options.detection_probability = 1.0;
  TrackerParameters parameters;
  parameters.drift_m_per_sqrt_s = 0.0;
  parameters.position_floor_m = 0.0;
  parameters.outlier_sigma = 100.0;
  const Row row(31, options);
  const Result result = drive(row, parameters);
  double nees = 0.0;
  double square = 0.0;
  for (const Track& track : result.plants) {
    double nearest_m = 1.0;
    Eigen::Vector2d error;
    for (const Plant& plant : row.plants()) {
      if ((plant.p_F_m - track.p_F_m).norm() >= nearest_m) continue;
      error = plant.p_F_m - track.p_F_m;
      nearest_m = error.norm();
    }
    nees += error.dot(track.covariance_F_m2.inverse() * error);
    square += error.squaredNorm() * track.views;
    // n views of equal covariance: R / n.
    EXPECT_NEAR(track.covariance_F_m2(0, 0), 16e-6 / track.views, 1e-9);
  }
  const auto count = static_cast<double>(result.plants.size());
  ASSERT_GT(count, 100.0);
  // Chi-square of 2 * count degrees has the mean 2 * count and the deviation 2 * sqrt(count).
  EXPECT_NEAR(nees / count, 2.0, 4.0 * 2.0 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(square / count / 2.0), 0.004, 0.0005);
}

TEST(TrackerOnARow, APlantSeenInTwoPassesStaysOnePlant) {
  RowOptions options;
  options.length_m = 4.0;
  const Row row(41, options);
  Tracker tracker;
  Result result;
  const int views = row.views();
  for (int i = 0; i < 2 * views; ++i) {
    // Forth, and back over the same ground.
    const View view = row.view(i, 0.1 * (i < views ? i : 2 * views - i));
    tracker.update(view, row.observe(view));
    collect(tracker.ended(), result);
  }
  tracker.finish();
  collect(tracker.ended(), result);
  EXPECT_EQ(result.plants.size(), row.plants().size());
}

TEST(TrackerOnARow, TheOrderOfObservationsDoesNotMatter) {
  RowOptions options;
  options.weeds_per_m2 = 81.2;
  options.ghosts_per_view = 2.0;
  const Row row(51, options);
  for (const char* association : {"dynamic_radius", "fixed_radius", "iou"}) {
    TrackerParameters parameters;
    parameters.association = association;
    Tracker straight(parameters);
    Tracker shuffled(parameters);
    Random random(52);
    for (int i = 0; i < 40; ++i) {
      const View view = row.view(i);
      std::vector<Observation> observations = row.observe(view);
      straight.update(view, observations);
      for (std::size_t k = observations.size(); k > 1; --k) {
        std::swap(observations[k - 1],
                  observations[random.integer(0, static_cast<std::int64_t>(k) - 1)]);
      }
      shuffled.update(view, observations);
      ASSERT_EQ(straight.tracks().size(), shuffled.tracks().size());
      for (std::size_t t = 0; t < straight.tracks().size(); ++t) {
        const Track& a = straight.tracks()[t];
        const Track& b = shuffled.tracks()[t];
        ASSERT_EQ(a.id, b.id);
        ASSERT_EQ(a.p_F_m, b.p_F_m);
        ASSERT_EQ(a.class_probability, b.class_probability);
      }
    }
  }
}

TEST(TrackerOnARow, DynamicRadiusDoesNotLoseSmallPlantsThatOverlapDoes) {
  RowOptions options;
  options.weeds_per_m2 = 22.3;
  options.stem_sigma_m = 0.004;
  options.pose_sigma_m = 0.010;
  const Row row(61, options);
  TrackerParameters overlap;
  overlap.association = "iou";
  const Result by_radius = drive(row);
  const Result by_overlap = drive(row, overlap);
  RecordProperty("idf1_permille_dynamic_radius", static_cast<int>(1e3 * by_radius.scores.idf1));
  RecordProperty("idf1_permille_iou", static_cast<int>(1e3 * by_overlap.scores.idf1));
  EXPECT_GT(by_radius.scores.idf1, by_overlap.scores.idf1);
}

struct Work {
  double plants_in_view;  // mean
  double step_s;          // median, of this thread
};

Work work_at(double weeds_per_m2) {
  RowOptions options;
  options.weeds_per_m2 = weeds_per_m2;
  options.ghosts_per_view = 2.0;
  const Row row(71, options);
  Tracker tracker;
  std::vector<double> steps_s;
  double observed = 0.0;
  for (int i = 0; i < row.views(); ++i) {
    const View view = row.view(i);
    const std::vector<Observation> observations = row.observe(view);
    const double start_s = thread_cpu_s();
    tracker.update(view, observations);
    steps_s.push_back(thread_cpu_s() - start_s);
    observed += static_cast<double>(observations.size());
  }
  return {observed / row.views(), median(steps_s)};
}

// Comparing each track with each observation would make the work grow with the square.
TEST(TrackerOnARow, WorkGrowsLessThanWithTheSquareOfThePlants) {
  const Work few = work_at(35.0);
  const Work many = work_at(140.0);
  const double plants = many.plants_in_view / few.plants_in_view;
  ASSERT_GT(plants, 3.0);
  const double work = many.step_s / few.step_s;
  RecordProperty("times_the_plants_percent", static_cast<int>(100 * plants));
  RecordProperty("times_the_work_percent", static_cast<int>(100 * work));
  EXPECT_LT(work, 0.6 * plants * plants);
}

// The pose error of dead reckoning grows, while the motion between two views is known to a
// millimetre. The common error must not merge neighbouring plants.
TEST(TrackerOnARow, DriftThatViewsShareDoesNotMixPlants) {
  const Row row(11, {});
  Tracker tracker;
  TrackingEvaluation evaluation(0.05);
  for (int i = 0; i < row.views(); ++i) {
    View view = row.view(i);
    const std::vector<Observation> observations = row.observe(view);
    view.pose_covariance = Eigen::Vector3d(1.0, 1.0, 0.01).asDiagonal();
    tracker.update(view, observations);
    ASSERT_TRUE(evaluation.add_frame(row.truth_in(view), tracked_in(tracker, view)).ok());
  }
  const TrackingScores scores = evaluation.scores();
  EXPECT_LE(static_cast<double>(scores.id_switches), 0.01 * static_cast<double>(scores.truth_ids));
}

}  // namespace
}  // namespace furrow::tracking
