#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "furrow_components/observation_conversion.hpp"
#include "furrow_components/track_conversion.hpp"
#include "furrow_components/track_field.hpp"
#include "furrow_core/file.hpp"
#include "furrow_field/field_csv.hpp"

namespace furrow::components {
namespace {

/// A camera one metre above the origin of F; the top of its image points along x of F.
geometry::PinholeCamera camera() {
  return geometry::PinholeCamera({.width_px = 640,
                                  .height_px = 480,
                                  .fx_px = 500.0,
                                  .fy_px = 500.0,
                                  .cx_px = 320.0,
                                  .cy_px = 240.0});
}
Eigen::Isometry3d pose() {
  Eigen::Isometry3d X_FC = Eigen::Isometry3d::Identity();
  X_FC.linear() << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  X_FC.translation() = Eigen::Vector3d(0.0, 0.0, 1.0);
  return X_FC;
}

furrow_msgs::msg::PlantInstance instance() {
  furrow_msgs::msg::PlantInstance instance;
  instance.score(0.75F);
  instance.crop_probability(0.25F);
  instance.box().x_offset(400);
  instance.box().y_offset(100);
  instance.box().width(4);
  instance.box().height(2);
  instance.mask_runs({1, 3, 0, 4});
  instance.stem_u_px(420.0);
  instance.stem_v_px(140.0);
  instance.stem().z(1.0);
  instance.radius_m(0.01);
  instance.area_mm2(100.0);
  return instance;
}

TEST(ObservationConversion, ProjectsAnInstanceToTheField) {
  const auto seen = observe(instance(), camera(), pose(), {});
  ASSERT_TRUE(seen.ok()) << seen.error().message;
  // 100 px up and 100 px to the right at 500 px/m: forward and to the robot's right.
  EXPECT_NEAR(seen->p_F_m.x(), 0.2, 1e-12);
  EXPECT_NEAR(seen->p_F_m.y(), -0.2, 1e-12);
  EXPECT_FLOAT_EQ(static_cast<float>(seen->score), 0.75F);
  EXPECT_FLOAT_EQ(static_cast<float>(seen->class_probability[0]), 0.25F);
  EXPECT_FALSE(seen->truncated);
  EXPECT_TRUE(seen->footprint.empty());
}

TEST(ObservationConversion, ProjectsTheMask) {
  ObservationParameters parameters;
  parameters.footprints = true;
  const auto seen = observe(instance(), camera(), pose(), parameters);
  ASSERT_TRUE(seen.ok()) << seen.error().message;
  // Seven pixels of 2 mm.
  EXPECT_NEAR(seen->footprint.area_mm2(), 7 * 4.0, 8.0);
}

TEST(ObservationConversion, MarksInstancesCutByTheBorder) {
  auto cut = instance();
  cut.box().x_offset(636);
  const auto seen = observe(cut, camera(), pose(), {});
  ASSERT_TRUE(seen.ok());
  EXPECT_TRUE(seen->truncated);
}

TEST(ObservationConversion, InvalidInstancesAreErrors) {
  ObservationParameters parameters;
  parameters.footprints = true;
  auto over = instance();
  over.mask_runs({1, 300});
  EXPECT_FALSE(observe(over, camera(), pose(), parameters).ok());
  auto huge = instance();
  huge.box().width(4000000000U);
  huge.box().height(4000000000U);
  EXPECT_FALSE(observe(huge, camera(), pose(), parameters).ok());
  auto nan = instance();
  nan.stem_u_px(NAN);
  EXPECT_FALSE(observe(nan, camera(), pose(), parameters).ok());
  auto no_depth = instance();
  no_depth.stem().z(0.0);
  EXPECT_FALSE(observe(no_depth, camera(), pose(), parameters).ok());
}

TEST(ObservationConversion, TakesThePlanarPartOfACovariance) {
  nav_msgs::msg::Odometry message;
  for (std::size_t i = 0; i < 36; ++i) {
    message.pose().covariance()[i] = static_cast<double>(i);
  }
  const Eigen::Matrix3d covariance = planar_covariance(message);
  EXPECT_EQ(covariance(0, 0), 0.0);
  EXPECT_EQ(covariance(0, 2), 5.0);
  EXPECT_EQ(covariance(1, 1), 7.0);
  EXPECT_EQ(covariance(2, 2), 35.0);
}

tracking::Track track(std::uint64_t id, double x_m, double y_m, double crop) {
  tracking::Track track;
  track.id = id;
  track.confirmed = true;
  track.p_F_m = {x_m, y_m};
  track.radius_m = 0.02;
  track.area_mm2 = 500.0;
  track.class_probability = {crop, 1.0 - crop};
  return track;
}

furrow_msgs::msg::SpeciesProbability share(const std::string& name, bool crop, float probability) {
  furrow_msgs::msg::SpeciesProbability species;
  species.species(name);
  species.crop(crop);
  species.probability(probability);
  return species;
}

std::vector<tracking::Track> tracks() {
  std::vector<tracking::Track> tracks;
  for (std::uint64_t i = 0; i < 6; ++i) {
    tracks.push_back(track(i + 1, 0.2 * static_cast<double>(i), 0.25, 0.9));
  }
  tracks.push_back(track(7, 0.5, -0.3, 0.1));
  tracks.back().species_probability = {0.0F, 0.9F};
  tracks.push_back(track(8, 0.6, -0.2, 0.1));
  tracks.push_back(track(9, -0.1, 0.0, 0.1));  // before the field
  tracks.push_back(track(10, 5.1, 0.0, 0.1));  // beyond it
  tracks.push_back(track(11, 0.4, 0.0, 0.1));
  tracks.back().confirmed = false;
  return tracks;
}

TEST(TrackField, HasTheConfirmedTracksOfTheField) {
  TrackFieldParameters parameters;
  parameters.length_m = 5.0;
  SpeciesNames species;
  bool overflow = false;
  (void)species.take(std::vector{share("violet", false, 0.5F), share("thistle", false, 0.5F)},
                     overflow);
  const field::FieldModel field = field_of_tracks(tracks(), species, parameters);
  EXPECT_TRUE(field::validate(field).ok());
  ASSERT_EQ(field.plants.size(), 8u);
  EXPECT_EQ(field.length_m, 5.0);
  EXPECT_DOUBLE_EQ(field.width_m, 0.6);
  ASSERT_EQ(field.row_y_m.size(), 1u);
  EXPECT_DOUBLE_EQ(field.row_y_m[0], 0.25);
  for (const field::Plant& plant : field.plants) {
    const char* species_name = plant.id <= 6 ? "sugar_beet" : plant.id == 7 ? "thistle" : "";
    EXPECT_EQ(plant.species, species_name);
    EXPECT_EQ(plant.kind, plant.id <= 6 ? field::PlantKind::kCrop : field::PlantKind::kWeed);
  }
}

TEST(SpeciesNames, KeepTheirPlacesOverTheViews) {
  SpeciesNames names;
  bool overflow = false;
  EXPECT_EQ(
      names.take(std::vector{share("thistle", false, 0.7F), share("beet", true, 0.2F)}, overflow),
      (std::vector{0.7F, 0.2F}));
  // A crop of the same name is another entry.
  EXPECT_EQ(
      names.take(std::vector{share("beet", false, 0.1F), share("thistle", false, 0.4F)}, overflow),
      (std::vector{0.4F, 0.0F, 0.1F}));
  EXPECT_TRUE(names.take({}, overflow).empty());
  EXPECT_FALSE(overflow);
  ASSERT_EQ(names.entries().size(), 3U);
  EXPECT_TRUE(names.entries()[1].crop);
}

TEST(SpeciesNames, LeaveOutWhatIsBeyondTheLimit) {
  std::vector<furrow_msgs::msg::SpeciesProbability> all;
  for (std::size_t i = 0; i <= SpeciesNames::kMost; ++i) {
    all.push_back(share("species_" + std::to_string(i), false, 0.01F));
  }
  SpeciesNames names;
  bool overflow = false;
  EXPECT_EQ(names.take(all, overflow).size(), SpeciesNames::kMost);
  EXPECT_TRUE(overflow);
}

TEST(TrackConversion, TellsTheSpeciesMostProbableFirst) {
  SpeciesNames names;
  bool overflow = false;
  (void)names.take(std::vector{share("thistle", false, 0.5F), share("beet", true, 0.2F),
                               share("foxtail", false, 0.2F)},
                   overflow);
  tracking::Track seen = track(1, 0.5, 0.0, 0.1);
  seen.species_probability = {0.3F, 0.002F, 0.6F};
  seen.leaves = 3.6;
  const auto message = to_msg(seen, names);
  ASSERT_EQ(message.species().size(), 2U) << "less than 0.5 % is left out";
  EXPECT_EQ(message.species()[0].species(), "foxtail");
  EXPECT_EQ(message.species()[0].probability(), 0.6F);
  EXPECT_FALSE(message.species()[0].crop());
  EXPECT_EQ(message.species()[1].species(), "thistle");
  EXPECT_EQ(message.leaves(), 4);
}

TEST(TrackField, IsWrittenAndReadBack) {
  TrackFieldParameters parameters;
  parameters.length_m = 5.0;
  const field::FieldModel field = field_of_tracks(tracks(), {}, parameters);
  const auto file = std::filesystem::temp_directory_path() / "furrow_track_field_test.csv";
  ASSERT_TRUE(write_field(field, file.string()).ok());
  const auto text = read_file(file);
  std::filesystem::remove(file);
  ASSERT_TRUE(text.ok());
  const auto copy = field::from_csv(*text, "test");
  ASSERT_TRUE(copy.ok()) << copy.error().message;
  EXPECT_EQ(copy->plants.size(), field.plants.size());
  EXPECT_FALSE(write_field(field, "field.txt").ok());
}

TEST(TrackField, IsEmptyWithoutTracks) {
  const field::FieldModel field = field_of_tracks({}, {}, {});
  EXPECT_TRUE(field.plants.empty());
  EXPECT_TRUE(field.row_y_m.empty());
}

}  // namespace
}  // namespace furrow::components
