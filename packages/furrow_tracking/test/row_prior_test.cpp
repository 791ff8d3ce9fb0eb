#include "furrow_tracking/row_prior.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "furrow_core/random.hpp"

namespace furrow::tracking {
namespace {

Track track_at(double x_m, double y_m, double log_odds) {
  Track track;
  track.confirmed = true;
  track.p_F_m = {x_m, y_m};
  track.class_log_odds = log_odds;
  return track;
}

RowPriorParameters enabled() {
  RowPriorParameters parameters;
  parameters.row_prior = true;
  return parameters;
}

/// Crops every 0.2 m in three rows half a metre apart, weeds anywhere, ten metres long.
std::vector<Track> field(std::uint64_t seed, double weeds_per_m2) {
  Random random(seed, "field");
  std::vector<Track> tracks;
  for (const double row_m : {-0.5, 0.0, 0.5}) {
    for (int i = 0; i < 50; ++i) {
      tracks.push_back(track_at(0.2 * i, row_m + random.normal(0.0, 0.01), 4.0));
    }
  }
  const auto weeds = static_cast<int>(weeds_per_m2 * 10.0 * 1.4);
  for (int i = 0; i < weeds; ++i) {
    tracks.push_back(track_at(random.uniform(0.0, 10.0), random.uniform(-0.7, 0.7), -4.0));
  }
  return tracks;
}

TEST(RowPrior, FindsTheRowsAndTheirDensities) {
  RowPrior prior(enabled());
  prior.learn(field(1, 20.0));
  ASSERT_EQ(prior.rows().size(), 3u);
  std::vector<double> ys;
  for (const RowPrior::Row& row : prior.rows()) {
    ys.push_back(row.y_m);
    EXPECT_NEAR(row.crops_per_m, 5.0, 0.5);
    EXPECT_NEAR(row.sd_m, 0.01, 0.005);
  }
  std::sort(ys.begin(), ys.end());
  EXPECT_NEAR(ys[0], -0.5, 0.006);
  EXPECT_NEAR(ys[1], 0.0, 0.006);
  EXPECT_NEAR(ys[2], 0.5, 0.006);
  EXPECT_NEAR(prior.weeds_per_m2(), 20.0, 3.0);
}

TEST(RowPrior, TellsByBayesRule) {
  RowPriorParameters parameters = enabled();
  parameters.row_max_log_odds = 20.0;
  RowPrior prior(parameters);
  prior.learn(field(2, 20.0));
  ASSERT_EQ(prior.rows().size(), 3u);
  // On a row: 5 crops per metre under a normal density with its peak of 1 / (sd sqrt(2 pi)).
  for (const RowPrior::Row& row : prior.rows()) {
    const double peak_per_m = 1.0 / (row.sd_m * std::sqrt(2.0 * M_PI));
    EXPECT_NEAR(prior.log_odds(row.y_m),
                std::log(row.crops_per_m * peak_per_m / prior.weeds_per_m2()), 0.05);
  }
  EXPECT_LT(prior.log_odds(0.25), -3.0);
  EXPECT_GT(prior.log_odds(0.0), prior.log_odds(0.02));
}

TEST(RowPrior, DenserWeedsTellLessForCrop) {
  RowPrior sparse(enabled());
  RowPrior dense(enabled());
  sparse.learn(field(3, 5.0));
  dense.learn(field(3, 80.0));
  EXPECT_GT(sparse.log_odds(0.02), dense.log_odds(0.02));
}

TEST(RowPrior, TellsNothingWithoutRows) {
  RowPrior prior(enabled());
  EXPECT_EQ(prior.log_odds(0.0), 0.0);
  prior.learn({});
  EXPECT_EQ(prior.log_odds(0.0), 0.0);
  // Weeds alone, and a single crop.
  std::vector<Track> tracks = field(4, 20.0);
  std::erase_if(tracks, [](const Track& track) { return track.class_log_odds > 0.0; });
  tracks.push_back(track_at(1.0, 0.0, 4.0));
  prior.learn(tracks);
  EXPECT_TRUE(prior.rows().empty());
  EXPECT_EQ(prior.log_odds(0.0), 0.0);
}

TEST(RowPrior, TakesManyDoubtfulWeedsForNoRow) {
  // 80 weeds per m2 of which each might be a crop: many in every strip, but in none more.
  RowPrior prior(enabled());
  std::vector<Track> tracks = field(6, 80.0);
  std::erase_if(tracks, [](const Track& track) { return track.class_log_odds > 0.0; });
  for (Track& track : tracks) track.class_log_odds = -1.0;
  prior.learn(tracks);
  EXPECT_TRUE(prior.rows().empty());
}

TEST(RowPrior, LeavesOutTracksFarAcross) {
  RowPrior prior(enabled());
  std::vector<Track> tracks = field(5, 10.0);
  tracks.push_back(track_at(1.0, 1e9, 4.0));
  prior.learn(tracks);
  EXPECT_EQ(prior.rows().size(), 3u);
}

}  // namespace
}  // namespace furrow::tracking
