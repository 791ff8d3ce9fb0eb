#include "furrow_configuration/parameter_file.hpp"

#include <gtest/gtest.h>

#include "furrow_core/test_support/config_error.hpp"
#include "furrow_core/test_support/temporary_folder.hpp"

namespace furrow::configuration {
namespace {

struct Parameters {
  double rate_hz = 1.0;
  std::string tool_file;
  std::vector<std::string> names;
  void visit(ParameterVisitor& v) {
    v.visit({.name = "rate_hz"}, rate_hz);
    v.visit({.name = "tool_file"}, tool_file);
    v.visit({.name = "names"}, names);
  }
};

TEST(ParameterFile, ReadsValuesOfEveryType) {
  EXPECT_EQ(parse_parameter_value("true"), ParameterValue(true));
  EXPECT_EQ(parse_parameter_value("-3"), ParameterValue(std::int64_t{-3}));
  EXPECT_EQ(parse_parameter_value("1e-3"), ParameterValue(1e-3));
  EXPECT_EQ(parse_parameter_value("\"3\""), ParameterValue(std::string("3")));
  EXPECT_EQ(parse_parameter_value("photos:DIR"), ParameterValue(std::string("photos:DIR")));
  EXPECT_EQ(parse_parameter_value("[1, 2.5]"), ParameterValue(std::vector<double>{1, 2.5}));
  EXPECT_EQ(parse_parameter_value("[a, 2]"), ParameterValue(std::vector<std::string>{"a", "2"}));
  EXPECT_EQ(parse_parameter_value("a: [b"), ParameterValue(std::string("a: [b")));
}

TEST(ParameterFile, RelativePathsStartAtTheFilesFolder) {
  const TemporaryFolder temporary;
  const auto& folder = temporary.path();
  const auto path = write_text(folder / "a" / "p.yaml", "tool_file: ../b/x.urdf\nrate_hz: 4\n");
  const auto parameters = load_parameter_file<Parameters>(path);
  EXPECT_EQ(parameters.tool_file, (folder / "b" / "x.urdf").string());
  EXPECT_EQ(parameters.rate_hz, 4.0);
}

TEST(ParameterFile, AnErrorNamesFileLineAndKey) {
  const TemporaryFolder temporary;
  const auto& folder = temporary.path();
  const auto load = [&](const std::string& text) {
    const auto path = write_text(folder / "p.yaml", text);
    return error_of(folder, [&] { (void)load_parameter_file<Parameters>(path); });
  };
  EXPECT_EQ(load("rate_hz: 1\nrate_hz: 2\n"), "p.yaml:2: rate_hz: is given twice");
  EXPECT_EQ(load("names: [a, [b]]\n"), "p.yaml:1: names: must be a value or a list of values");
  EXPECT_EQ(load("\nrate_hz:\n"), "p.yaml:2: rate_hz: must have one value or a list of values");
  EXPECT_EQ(load("- 1\n"), "p.yaml:1: is not a map of keys");
  EXPECT_TRUE(load("a: [1\nb: 2\n").starts_with("p.yaml:")) << load("a: [1\nb: 2\n");
  EXPECT_EQ(error_of(folder, [&] { (void)read_parameter_file(folder / "none.yaml"); }),
            "none.yaml: no such file");
}

TEST(ParameterFile, ReadsListsOfMaps) {
  const TemporaryFolder temporary;
  const auto& folder = temporary.path();
  const auto path = write_text(folder / "l.yaml", "things:\n  - {rate_hz: 2}\n  - {names: [x]}\n");
  const auto things = load_parameter_list<Parameters>(path, "things");
  ASSERT_EQ(things.size(), 2u);
  EXPECT_EQ(things[0].rate_hz, 2.0);
  EXPECT_EQ(things[1].names, std::vector<std::string>{"x"});
  EXPECT_EQ(error_of(folder, [&] { (void)read_parameter_list(path, "others"); }),
            "l.yaml:1: things: unknown key");
}

}  // namespace
}  // namespace furrow::configuration
