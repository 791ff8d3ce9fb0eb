// The species of a track over its views: expected values from Bayes' rule, by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tracker_inputs.hpp"

namespace furrow::tracking {
namespace {

/// The track after views of one plant with these distributions.
Track seen_as(const std::vector<std::vector<float>>& views,
              const TrackerParameters& parameters = {}) {
  Tracker tracker(parameters);
  double t_s = 0.0;
  Observation observation = seen_at(0.0, 0.0);
  for (const auto& view : views) {
    observation.species_probability = view;
    tracker.update(view_at(t_s += 0.2), Observations{observation});
  }
  EXPECT_EQ(tracker.tracks().size(), 1U);
  return tracker.tracks().empty() ? Track{} : tracker.tracks()[0];
}

TEST(SpeciesFusion, OneViewIsBayesRuleWithTheConfusionModel) {
  // Likelihoods 0.9 p + 0.1 / 12, of ten species not named 0.1 / 12.
  const double floor = 0.1 / 12.0;
  const double a = 0.9 * 0.7 + floor;
  const double b = 0.9 * 0.3 + floor;
  const double sum = a + b + 10.0 * floor;
  const Track track = seen_as({{0.7F, 0.3F}});
  ASSERT_EQ(track.species_probability.size(), 2U);
  EXPECT_NEAR(track.species_probability[0], a / sum, 1e-6);
  EXPECT_NEAR(track.species_probability[1], b / sum, 1e-6);
}

TEST(SpeciesFusion, IndependentViewsMultiplyLikelihoods) {
  TrackerParameters parameters;
  parameters.species_view_correlation = 0.0;
  const double floor = 0.1 / 12.0;
  const double a = (0.9 * 0.6 + floor) * (0.9 * 0.5 + floor);
  const double b = (0.9 * 0.4 + floor) * (0.9 * 0.5 + floor);
  const double sum = a + b + 10.0 * floor * floor;
  const Track track = seen_as({{0.6F, 0.4F}, {0.5F, 0.5F}}, parameters);
  EXPECT_NEAR(track.species_probability[0], a / sum, 1e-5);
  EXPECT_NEAR(track.species_probability[1], b / sum, 1e-5);
}

TEST(SpeciesFusion, FullyCorrelatedViewsAddNoEvidence) {
  TrackerParameters parameters;
  parameters.species_view_correlation = 1.0;
  const std::vector<float> view = {0.6F, 0.4F};
  const Track once = seen_as({view}, parameters);
  const Track often = seen_as({view, view, view, view}, parameters);
  EXPECT_NEAR(once.species_probability[0], often.species_probability[0], 1e-5);
}

TEST(SpeciesFusion, MoreViewsOfOneKindMakeItSurer) {
  const std::vector<float> view = {0.6F, 0.4F};
  const Track once = seen_as({view});
  const Track often = seen_as({view, view, view, view});
  EXPECT_GT(often.species_probability[0], once.species_probability[0]);
  EXPECT_LT(often.species_probability[0], 1.0F);
}

TEST(SpeciesFusion, AViewWithoutSpeciesChangesNothing) {
  const Track with = seen_as({{0.7F, 0.3F}});
  const Track and_without = seen_as({{0.7F, 0.3F}, {}, {0.0F, 0.0F}});
  EXPECT_EQ(with.species_probability, and_without.species_probability);
  EXPECT_TRUE(seen_as({{}}).species_probability.empty());
  EXPECT_EQ(most_probable_species(seen_as({{}})), -1);
}

TEST(SpeciesFusion, TheRestIsUnknownAndProbabilitiesStayFinite) {
  std::vector<std::vector<float>> views(3000, {1.0F});
  const Track sure = seen_as(views);
  EXPECT_TRUE(std::isfinite(sure.species_probability[0]));
  EXPECT_GT(sure.species_probability[0], 0.97F);
  // 0.9 * 0.2 + floor against eleven floors: most of it stays unknown or not named.
  const Track unsure = seen_as({{0.2F}});
  const double floor = 0.1 / 12.0;
  EXPECT_NEAR(unsure.species_probability[0], (0.18 + floor) / (0.18 + 12.0 * floor), 1e-6);
}

TEST(SpeciesFusion, RefusesWhatIsNoDistribution) {
  Tracker tracker;
  Observation observation = seen_at(0.0, 0.0);
  observation.species_probability = {0.9F, 0.9F};
  EXPECT_EQ(tracker.update(view_at(0.2), Observations{observation}).born, 0);
}

}  // namespace
}  // namespace furrow::tracking
