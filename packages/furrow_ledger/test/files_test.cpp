#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "furrow_core/file.hpp"
#include "furrow_ledger/ledger.hpp"

namespace furrow::ledger {
namespace {

Ledger small_ledger(const std::string& species = "beet") {
  field::FieldModel model;
  model.name = "small";
  model.source = "generated: by hand";
  model.length_m = 2.0;
  model.width_m = 1.4;
  field::Plant weed;
  weed.id = 5;
  weed.kind = field::PlantKind::kWeed;
  weed.species = species;
  weed.p_F_m = {0.5, -0.25};
  weed.radius_m = 0.012;
  weed.area_mm2 = 400.0;
  model.plants = {weed};
  RunRecord record;
  record.info.seed = 7;
  record.info.duration_s = 10.0;
  record.info.wall_s = 4.0;
  record.info.axis_travel_m = {1.25, 0.0};
  record.tracks = {{.id = 3, .p_F_m = {0.502, -0.25}, .confirmed = true}};
  Spray spray;
  spray.time = Time::from_seconds(1.5);
  spray.axis = 1;
  spray.p_F_m = {0.506, -0.25};
  spray.aim_F_m = {0.502, -0.25};
  spray.track_ids = {3};
  record.sprays = {spray};
  auto ledger = account(model, record);
  EXPECT_TRUE(ledger.ok());
  return *ledger;
}

TEST(Json, HasTheDocumentedKeys) {
  const auto json = nlohmann::json::parse(to_json(small_ledger().summary));
  for (const char* key :
       {"field", "weeds_total", "treated_accurate", "treated_partial", "missed", "missed_by_reason",
        "loss_pct", "loss_planning_pct", "loss_vision_pct", "crops_total", "crops_hit", "sprays",
        "placement_error_p50_mm", "placement_error_p95_mm", "axis_travel_m", "distance_m",
        "duration_s", "realtime_factor", "seed"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["treated_accurate"], 1);
  EXPECT_EQ(json["placement_error_p50_mm"], 6.0);
  EXPECT_EQ(json["aim_error_p50_mm"], 4.0);
  EXPECT_EQ(json["realtime_factor"], 2.5);
  EXPECT_EQ(json["sprays_by_axis"], nlohmann::json::array({0, 1}));
  EXPECT_EQ(json["missed_by_reason"].size(), kReasonCount - 1);
}

TEST(Json, WallClockFiguresStandLastAndAloneDiffer) {
  Summary a = small_ledger().summary;
  Summary b = a;
  b.wall_s = 8.0;
  b.realtime_factor = 1.25;
  const std::string first = to_json(a);
  const std::string second = to_json(b);
  const std::size_t wall = first.find("\"realtime_factor\"");
  EXPECT_EQ(first.substr(0, wall), second.substr(0, wall));
  EXPECT_NE(first, second);
}

TEST(Json, UnmeasuredIsNullAndStrangeNamesSurvive) {
  Summary summary;
  summary.field = "\xff\"quoted\"\n";
  summary.speed_mps = std::numeric_limits<double>::quiet_NaN();
  const auto json = nlohmann::json::parse(to_json(summary));
  EXPECT_TRUE(json["placement_error_p50_mm"].is_null());
  EXPECT_TRUE(json["realtime_factor"].is_null());
  EXPECT_TRUE(json["speed_mps"].is_null());
  EXPECT_NE(json["field"].get<std::string>().find("\"quoted\""), std::string::npos);
}

TEST(Csv, OneLineForEveryPlant) {
  EXPECT_EQ(to_csv(small_ledger()),
            "plant_id,kind,species,x_m,y_m,radius_m,area_mm2,outcome,reason,decision,axis,"
            "spray_time_s,spray_distance_mm,track_id,track_kind,track_distance_mm,seen_species,"
            "seen_probability,unknown_probability,seen_area_mm2,seen_leaves,beta,class_weight,"
            "crop_distance_m,crop_proximity_per_mm2_m,worth_scheme,worth,worth_threshold\n"
            "5,weed,beet,0.5000,-0.2500,0.0120,400.0,accurate,,,1,1.5000,6.00,3,weed,2.00"
            ",,,,,,,,,,,,\n");
}

TEST(Csv, SaysWhatThePlannerMadeOfAPlant) {
  Ledger ledger = small_ledger();
  ledger.rows[0].seen_species = "thistle";
  ledger.rows[0].seen_probability = 0.1 + 0.2;  // 0.30000000000000004: read back as it was
  ledger.rows[0].appraisal = Appraisal{.scheme = "kappa",
                                       .species = "thistle",
                                       .species_probability = 0.1 + 0.2,
                                       .area_mm2 = 400.0,
                                       .leaves = 4,
                                       .beta = 0.5,
                                       .class_weight = 1.0,
                                       .crop_distance_m = 0.25,
                                       .crop_proximity = 0.002,
                                       .worth = 0.4,
                                       .threshold = 0.1};
  EXPECT_NE(to_csv(ledger).find(",2.00,thistle,0.30000000000000004,0,400,4,0.5,1,0.25,0.002,kappa,"
                                "0.4,0.1\n"),
            std::string::npos);
}

TEST(Csv, QuotesNamesThatNeedIt) {
  EXPECT_NE(to_csv(small_ledger("a,\"b\"")).find("5,weed,\"a,\"\"b\"\"\",0.5000"),
            std::string::npos);
}

class RunFiles : public testing::Test {
 protected:
  RunFiles()
      : folder_(std::filesystem::path(testing::TempDir()) /
                ("furrow_ledger_" + std::to_string(reinterpret_cast<std::uintptr_t>(this)))) {}
  ~RunFiles() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(RunFiles, WritesFourFiles) {
  ASSERT_TRUE(write_run_files(folder_ / "run", small_ledger(), {}).ok());
  for (const char* name : {"summary.json", "ledger.csv", "map.svg", "report.html"}) {
    EXPECT_GT(std::filesystem::file_size(folder_ / "run" / name), 100u) << name;
  }
  const auto entries = std::filesystem::directory_iterator(folder_ / "run");
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 4);
}

TEST_F(RunFiles, SaysWhyItCannotWrite) {
  ASSERT_TRUE(write_file_atomically(folder_ / "taken", "a file, not a folder").ok());
  const Status written = write_run_files(folder_ / "taken", small_ledger(), {});
  ASSERT_FALSE(written.ok());
  EXPECT_NE(written.error().message.find("taken"), std::string::npos) << written.error().message;
}

}  // namespace
}  // namespace furrow::ledger
