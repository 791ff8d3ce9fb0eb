#include "furrow_core/parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace furrow {
namespace {

struct Parameters {
  double rate_hz = 5.0;
  std::int64_t views = 2;
  bool dry_run = false;
  std::string mode = "rolling";
  std::vector<double> offsets_m = {0.1, 0.2};
  std::vector<std::string> species;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "rate_hz", .unit = "Hz", .description = "", .min = 0.1, .max = 60}, rate_hz);
    v.visit({.name = "views", .unit = "", .description = "", .min = 1}, views);
    v.visit({.name = "dry_run", .unit = "", .description = ""}, dry_run);
    v.visit({.name = "mode", .unit = "", .description = "", .choices = {"rolling", "segment"}},
            mode);
    v.visit({.name = "offsets_m", .unit = "m", .description = "", .min = 0}, offsets_m);
    v.visit({.name = "species", .unit = "", .description = ""}, species);
  }
};

std::string error_of(const std::string& name, ParameterValue value) {
  Parameters parameters;
  try {
    ParameterLoader::load({{name, std::move(value), {"p.yaml", 4}}}, parameters);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Parameters, GivenValuesReplaceDefaults) {
  Parameters parameters;
  ParameterLoader::load({{"rate_hz", std::int64_t{10}, {}},
                         {"mode", std::string("segment"), {}},
                         {"species", std::vector<double>{}, {}}},
                        parameters);
  EXPECT_EQ(parameters.rate_hz, 10.0);
  EXPECT_EQ(parameters.mode, "segment");
  EXPECT_EQ(parameters.views, 2);
}

TEST(Parameters, ErrorsNameFileLineAndKey) {
  EXPECT_EQ(error_of("rate_hz", 100.0), "p.yaml:4: rate_hz: 100 is out of range [0.1, 60] Hz");
  EXPECT_EQ(error_of("rate_hx", 1.0),
            "p.yaml:4: rate_hx: unknown parameter; did you mean 'rate_hz'?");
  EXPECT_EQ(error_of("views", 1.5), "p.yaml:4: views: is of type number; type integer is needed");
  EXPECT_EQ(error_of("mode", std::string("x")),
            "p.yaml:4: mode: 'x' is not one of [rolling, segment]");
  EXPECT_EQ(error_of("rate_hz", std::nan("")), "p.yaml:4: rate_hz: is not a number");
  EXPECT_NE(error_of("offsets_m", std::vector<double>{-1}), "");
}

TEST(Parameters, NothingIsAssignedWhenOneIsBad) {
  Parameters parameters;
  EXPECT_THROW(
      ParameterLoader::load({{"views", std::int64_t{5}, {}}, {"nope", true, {}}}, parameters),
      ConfigError);
  EXPECT_EQ(parameters.views, 2);
}

TEST(Parameters, GivenTwiceIsAnError) {
  Parameters parameters;
  EXPECT_THROW(ParameterLoader::load(
                   {{"views", std::int64_t{5}, {}}, {"views", std::int64_t{5}, {}}}, parameters),
               ConfigError);
}

TEST(Parameters, ListsDeclarationsWithDefaults) {
  const auto declared = declared_parameters<Parameters>();
  ASSERT_EQ(declared.size(), 6u);
  EXPECT_EQ(declared[0].info.name, "rate_hz");
  EXPECT_EQ(to_text(declared[0].default_value), "5");
  EXPECT_EQ(to_text(declared[4].default_value), "[0.1, 0.2]");
  EXPECT_EQ(type_name(declared[5].default_value), "list of strings");
}

struct Pair {
  Parameters left;
  Parameters right;
  void visit(ParameterVisitor& v) {
    PrefixedVisitor l(v, "left_");
    left.visit(l);
    PrefixedVisitor r(v, "right_");
    right.visit(r);
  }
};

TEST(Parameters, PrefixesTellPartsApart) {
  Pair pair;
  ParameterLoader::load({{"right_views", std::int64_t{9}, {}}}, pair);
  EXPECT_EQ(pair.left.views, 2);
  EXPECT_EQ(pair.right.views, 9);
  EXPECT_EQ(declared_parameters<Pair>().size(), 12u);
}

}  // namespace
}  // namespace furrow
