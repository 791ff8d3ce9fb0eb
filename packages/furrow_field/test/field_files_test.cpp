#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "field_test_support.hpp"
#include "furrow_field/field_csv.hpp"
#include "furrow_field/field_geojson.hpp"

namespace furrow::field {
namespace {

constexpr GeoOrigin kOrigin{50.6149, 6.9874, 0.7};
using Reader = Result<FieldModel> (*)(const std::string&);

Result<FieldModel> read_csv(const std::string& text) {
  return from_csv(text, "field.csv");
}
Result<FieldModel> read_geojson(const std::string& text) {
  return from_geojson(text, "field.geojson");
}

void expect_error(const Result<FieldModel>& result, std::initializer_list<const char*> parts) {
  ASSERT_FALSE(result.ok());
  for (const char* part : parts) {
    EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
  }
}

/// Truncated and damaged files read as a valid field or fail with the file's name; nothing else.
void survive_damage(const std::string& whole, Reader read, const std::string& file) {
  Random random(12);
  const auto last = static_cast<std::int64_t>(whole.size()) - 1;
  for (int i = 0; i < 600; ++i) {
    std::string text = whole;
    if (i % 3 == 0) text.resize(static_cast<std::size_t>(random.integer(0, last)));
    if (i % 3 == 1) text.erase(static_cast<std::size_t>(random.integer(0, last)), 1);
    for (int k = 0; i % 3 == 2 && k < 4; ++k) {
      text[static_cast<std::size_t>(random.integer(0, last))] =
          static_cast<char>(random.integer(0, 255));
    }
    const Result<FieldModel> field = read(text);
    if (field.ok()) {
      EXPECT_TRUE(validate(*field).ok());
    } else {
      EXPECT_EQ(field.error().message.rfind(file, 0), 0u) << field.error().message;
    }
  }
  for (int i = 0; i < 300; ++i) {
    std::string noise(static_cast<std::size_t>(random.integer(0, 200)), ' ');
    for (char& c : noise) c = static_cast<char>(random.integer(0, 255));
    EXPECT_FALSE(read(noise).ok());
  }
}

TEST(FieldCsv, ReadsBackWhatItWrote) {
  for (int seed = 0; seed < 20; ++seed) {
    const FieldModel field = random_field(seed, seed * 5);
    const Result<std::string> text = to_csv(field);
    ASSERT_TRUE(text.ok());
    const Result<FieldModel> back = read_csv(*text);
    ASSERT_TRUE(back.ok()) << back.error().message;
    expect_equal(*back, field);
  }
}

TEST(FieldCsv, HasOneLineAPlantBelowAHeaderWithUnits) {
  FieldModel field;
  field.name = "n";
  field.source = "s";
  field.length_m = 2.0;
  field.width_m = 1.0;
  field.row_y_m = {0.25};
  field.plants.push_back({3, PlantKind::kWeed, "violet", {1.5, -0.25}, 0.02, 300.0, 4, 0.5});
  EXPECT_EQ(*to_csv(field),
            "# name: n\n# source: s\n# length_m: 2\n# width_m: 1\n# row_y_m: 0.25\n"
            "id,kind,species,x_m,y_m,radius_m,area_mm2,leaves,heading_rad\n"
            "3,weed,violet,1.5,-0.25,0.02,300,4,0.5\n");
}

TEST(FieldCsv, ReadsABareListOfPlants) {
  const Result<FieldModel> field = read_csv("y_m,kind,x_m\r\n0.5,weed,3\r\n\r\n-0.25,crop,1\r\n");
  ASSERT_TRUE(field.ok()) << field.error().message;
  EXPECT_EQ(field->source, "imported: field.csv");
  EXPECT_EQ(field->length_m, 3.0);
  EXPECT_EQ(field->width_m, 1.0);
  ASSERT_EQ(field->plants.size(), 2u);
  EXPECT_EQ(field->plants[0].kind, PlantKind::kCrop);
  EXPECT_EQ(field->plants[0].id, 1);
  EXPECT_EQ(field->plants[1].p_F_m, Eigen::Vector2d(3.0, 0.5));
}

TEST(FieldCsv, ErrorsNameFileLineAndColumn) {
  const std::string header = "id,kind,species,x_m,y_m\n";
  expect_error(read_csv(""), {"field.csv:", "no header"});
  expect_error(read_csv("# name: x\n"), {"no header"});
  expect_error(read_csv("# length_m: far\n" + header), {"field.csv:1: length_m", "'far'"});
  expect_error(read_csv("# row_y_m: 0 nan\n" + header), {"field.csv:1: row_y_m", "'nan'"});
  expect_error(read_csv("id,kind,x_m\n"), {"'y_m' is missing"});
  expect_error(read_csv("kind,x_m,y_m,x_m\n"), {"'x_m' is there twice"});
  expect_error(read_csv("kind,x,y_m\n"), {"'x' is not known"});
  expect_error(read_csv(header + "0,weed,a,1,0\n1,weed,a,1\n"), {"field.csv:3: line", "4 cells"});
  expect_error(read_csv(header + "0,tree,a,1,0\n"), {":2: kind: 'tree'"});
  expect_error(read_csv(header + "0.5,weed,a,1,0\n"), {":2: id: '0.5'"});
  expect_error(read_csv(header + "99999999999999999999,weed,a,1,0\n"), {":2: id"});
  expect_error(read_csv(header + "0,weed,a,inf,0\n"), {":2: x_m: 'inf'"});
  expect_error(read_csv(header + "0,weed,a,1,1 m\n"), {":2: y_m: '1 m'"});
  expect_error(read_csv(header + "0,weed,\"a,1,0\n"), {":2: line", "quote"});
  expect_error(read_csv(header + "0,weed,\"a\"b,1,0\n"), {":2: line", "quote"});
  expect_error(read_csv(header + "0,weed,a,1,0\n0,weed,a,2,0\n"), {"plant 0", "unique"});
  expect_error(read_csv("# length_m: 1\n" + header + "0,weed,a,2,0\n"), {"plant 0", "outside"});
  expect_error(read_csv(header + "0,weed,a,-1,0\n"), {"plant 0", "outside"});
}

TEST(FieldCsv, ReadsWhatSpreadsheetsWrite) {
  const std::string plants[] = {
      "\xEF\xBB\xBFkind,x_m,y_m\r\ncrop,1.5,0.0\r\nweed,0.5,0.25\r\n",  // CSV UTF-8
      "kind;x_m;y_m\r\ncrop;1,5;0\r\nweed;0,5;0,25\r\n",                // decimal commas
      "\xEF\xBB\xBFsep=;\r\nkind;x_m;y_m\r\ncrop;1.5;0\r\nweed;0.5;0.25\r\n;;\r\n",
      "kind\tx_m\ty_m\ncrop\t1,5\t0,0\nweed\t0.5\t0,25\n",
      "# name: n,,\n# width_m: 0.5,,\nkind,x_m,y_m\ncrop, 1.5 ,0\nweed,0.5,0.25\n,,\n"};
  for (const std::string& text : plants) {
    const Result<FieldModel> field = read_csv(text);
    ASSERT_TRUE(field.ok()) << text << field.error().message;
    ASSERT_EQ(field->plants.size(), 2u) << text;
    EXPECT_EQ(field->plants[0].p_F_m, Eigen::Vector2d(0.5, 0.25));
    EXPECT_EQ(field->plants[1].p_F_m, Eigen::Vector2d(1.5, 0.0));
    EXPECT_EQ(field->width_m, 0.5);
  }
}

TEST(FieldCsv, TellsWhatASpreadsheetMustDo) {
  expect_error(read_csv("kind,species,x_m,y_m\nweed,Kamille \xE9,0.3,0.1\n"),
               {"field.csv:2:", "0xE9", "CSV UTF-8"});
  expect_error(read_csv(std::string("\xFF\xFEk\0i\0", 6)), {"field.csv:1:", "UTF-16"});
  expect_error(read_csv("kind,x_m,y_m\nweed,0,3,0,1\n"), {":2: line", "5 cells", "decimal mark"});
  expect_error(read_csv("kind;x_m;y_m\nweed;1.000,5;0\n"), {":2: x_m: '1.000,5'"});
}

TEST(FieldCsv, SurvivesDamage) {
  survive_damage(*to_csv(random_field(3, 12)), read_csv, "field.csv");
}

TEST(FieldGeoJson, ReadsBackWhatItWroteInMetres) {
  for (int seed = 0; seed < 20; ++seed) {
    const FieldModel field = random_field(seed, seed * 5);
    const Result<FieldModel> back = read_geojson(*to_geojson(field));
    ASSERT_TRUE(back.ok()) << back.error().message;
    expect_equal(*back, field);
  }
}

TEST(FieldGeoJson, ReadsBackWhatItWroteInDegrees) {
  for (int seed = 0; seed < 20; ++seed) {
    FieldModel field = random_field(seed, 40);
    field.plants.back().p_F_m = {field.length_m, 0.5 * field.width_m};
    const Result<FieldModel> back = read_geojson(*to_geojson(field, kOrigin));
    ASSERT_TRUE(back.ok()) << back.error().message;
    expect_equal(*back, field, 1e-7);
  }
}

TEST(FieldGeoJson, LiesAcrossTheDateLineOnThePolesAndInTheSouth) {
  for (const GeoOrigin& origin :
       {GeoOrigin{-16.8, 179.99999, 0.4}, GeoOrigin{16.8, -179.99999, 3.0},
        GeoOrigin{-90.0, 0.0, 1.0}, GeoOrigin{90.0, 12.0, -1.0},
        GeoOrigin{-43.5, 172.6, 2.0, 400.0}}) {
    const FieldModel field = random_field(11, 40);
    const Result<FieldModel> back = read_geojson(*to_geojson(field, origin));
    ASSERT_TRUE(back.ok()) << back.error().message;
    expect_equal(*back, field, 1e-7);
  }
}

TEST(FieldGeoJson, ReadsPointsOfOthersAcrossTheDateLine) {
  const std::string text = R"({"type":"FeatureCollection","features":[
    {"type":"Feature","geometry":{"type":"Point","coordinates":[179.9999,-16.8]},
     "properties":{"kind":"crop"}},
    {"type":"Feature","geometry":{"type":"Point","coordinates":[-179.9999,-16.8]},
     "properties":{"kind":"weed"}}]})";
  const Result<FieldModel> field = from_geojson(text, "f", GeoOrigin{-16.8, 179.9999, 0.0});
  ASSERT_TRUE(field.ok()) << field.error().message;
  ASSERT_EQ(field->plants.size(), 2u);
  // 0.0002 degrees of the parallel: N cos(16.8 deg), N = a / sqrt(1 - e2 sin2(16.8 deg)).
  const double rad = 3.14159265358979323846 / 180.0;
  const double sine = std::sin(16.8 * rad);
  const double n_m = 6378137.0 / std::sqrt(1.0 - 0.00669437999014 * sine * sine);
  EXPECT_NEAR(field->length_m, 0.0002 * rad * n_m * std::cos(16.8 * rad), 1e-6);
}

TEST(FieldGeoJson, RefusesAPointFarFromTheOrigin) {
  const std::string text = R"({"type":"FeatureCollection","features":[
    {"type":"Feature","geometry":{"type":"Point","coordinates":[-170,0]},
     "properties":{"kind":"weed"}}]})";
  const Result<FieldModel> field = from_geojson(text, "f", GeoOrigin{0.0, 10.0, 0.0});
  expect_error(field, {"feature 0: coordinates", "near the origin"});
}

TEST(FieldGeoJson, ReadsPointsOfOtherPrograms) {
  const std::string text = R"({"type":"FeatureCollection","features":[
    {"type":"Feature","geometry":{"type":"Point","coordinates":[10.0001,0]},
     "properties":{"kind":"weed"}}]})";
  expect_error(read_geojson(text), {"origin must be given"});
  const Result<FieldModel> field = from_geojson(text, "f", GeoOrigin{0.0, 10.0, 0.0});
  ASSERT_TRUE(field.ok()) << field.error().message;
  EXPECT_NEAR(field->plants.at(0).p_F_m.x(), 11.131949, 1e-5);
  EXPECT_EQ(field->source, "imported: f");
}

std::string one_feature(const std::string& geometry, const std::string& properties,
                        const std::string& furrow = R"({"coordinates":"field"})") {
  return R"({"type":"FeatureCollection","furrow":)" + furrow +
         R"(,"features":[{"type":"Feature","geometry":)" + geometry + R"(,"properties":)" +
         properties + "}]}";
}

TEST(FieldGeoJson, ErrorsNameFileFeatureAndKey) {
  const std::string point = R"({"type":"Point","coordinates":[1,0]})";
  const std::string weed = R"({"kind":"weed"})";
  EXPECT_TRUE(read_geojson(one_feature(point, weed)).ok());
  expect_error(read_geojson(""), {"field.geojson", "parse error"});
  expect_error(read_geojson("[]"), {"FeatureCollection"});
  expect_error(read_geojson(R"({"type":"Feature"})"), {"FeatureCollection"});
  expect_error(read_geojson(R"({"type":"FeatureCollection","furrow":{"coordinates":"field"}})"),
               {"features"});
  expect_error(read_geojson(one_feature("null", weed)), {"feature 0: geometry"});
  expect_error(read_geojson(one_feature(R"({"type":"Point","coordinates":[1]})", weed)),
               {"feature 0: coordinates"});
  expect_error(read_geojson(one_feature(R"({"type":"Point","coordinates":["1",2]})", weed)),
               {"feature 0: coordinates"});
  expect_error(read_geojson(one_feature(point, "{}")), {"feature 0: kind"});
  expect_error(read_geojson(one_feature(point, R"({"kind":1})")), {"feature 0: kind"});
  expect_error(read_geojson(one_feature(point, R"({"kind":"weed","id":1.5})")), {"id"});
  expect_error(read_geojson(one_feature(point, R"({"kind":"weed","id":18446744073709551615})")),
               {"id", "too large"});
  expect_error(read_geojson(one_feature(point, R"({"kind":"weed","leaves":4000000000})")),
               {"leaves", "too large"});
  expect_error(read_geojson(one_feature(point, R"({"kind":"weed","radius_m":"x"})")),
               {"feature 0: radius_m"});
  expect_error(read_geojson(one_feature(point, weed, "1")), {"furrow", "object"});
  expect_error(read_geojson(one_feature(point, weed, "{}")), {"furrow.coordinates"});
  expect_error(read_geojson(one_feature(point, weed, R"({"coordinates":"wgs84"})")),
               {"origin", "missing"});
  expect_error(read_geojson(one_feature(point, weed, R"({"coordinates":"wgs84","origin":{
        "latitude_deg":95,"longitude_deg":0,"heading_rad":0}})")),
               {"origin", "not on the earth"});
  expect_error(read_geojson(one_feature(point, weed, R"({"coordinates":"field","length_m":0.5,
        "width_m":1})")),
               {"plant 0", "outside"});
}

TEST(FieldGeoJson, SurvivesDamage) {
  survive_damage(*to_geojson(random_field(4, 6)), read_geojson, "field.geojson");
  survive_damage(*to_geojson(random_field(4, 6), kOrigin), read_geojson, "field.geojson");
  EXPECT_FALSE(read_geojson(std::string(200'000, '[')).ok());
}

TEST(FieldFiles, RefuseToWriteAnInvalidField) {
  FieldModel field = random_field(5, 3);
  EXPECT_FALSE(to_geojson(field, GeoOrigin{90.1, 0.0, 0.0}).ok());
  field.plants[0].species = "\xff";
  EXPECT_FALSE(to_geojson(field).ok());
  EXPECT_FALSE(to_csv(field).ok());
  field.plants[0].p_F_m.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(to_csv(field).ok());
  EXPECT_FALSE(to_geojson(field).ok());
}

}  // namespace
}  // namespace furrow::field
