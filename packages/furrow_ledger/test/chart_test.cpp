#include "furrow_ledger/chart.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>

#include "xml_check.hpp"

namespace furrow::ledger {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInf = std::numeric_limits<double>::infinity();

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(XmlCheck, FindsFaults) {
  EXPECT_EQ(xml_fault("<a b=\"c\"><d/>x &lt; y</a>\n"), "");
  for (const char* bad :
       {"<a>", "<a></b>", "<a b=\"c></a>", "<a>&lt</a>", "<a/><b/>", "x", "<a>></a>"}) {
    EXPECT_NE(xml_fault(bad), "") << bad;
  }
}

TEST(Ticks, AreRoundAndSpanTheRange) {
  EXPECT_EQ(ticks(0.0, 10.0, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(ticks(0.0, 0.9, 4), (std::vector<double>{0, 0.25, 0.5, 0.75, 1.0}));
  for (const auto& [low, high] :
       {std::pair{-3.7, 12.4}, {1e-9, 3e-9}, {5.0, 5.0}, {0.0, 0.0}, {-1e300, 1e300}, {9.0, 2.0}}) {
    const auto values = ticks(low, high, 5);
    ASSERT_GE(values.size(), 2u) << low << " " << high;
    EXPECT_LE(values.front(), std::min(low, high) + 1e-15);
    EXPECT_GE(values.back(), std::max(low, high) - 1e-15);
    EXPECT_LE(values.size(), 12u);
  }
  EXPECT_TRUE(ticks(0.0, kInf, 5).empty());
  EXPECT_TRUE(ticks(kNan, 1.0, 5).empty());
}

TEST(BarChart, BarsAreProportional) {
  const BarChart chart{
      .title = "t", .unit = "%", .bars = {{"a<", 2.0, "#010101", "n"}, {"b", 1.0, "#020202", ""}}};
  const std::string svg = to_svg(chart);
  EXPECT_EQ(xml_fault(svg), "");
  const std::regex width("width=\"([0-9.]+)\" height=\"15\" rx=\"3\" fill=\"#0([12])0");
  std::vector<double> widths;
  for (auto it = std::sregex_iterator(svg.begin(), svg.end(), width); it != std::sregex_iterator();
       ++it) {
    widths.push_back(std::stod((*it)[1]));
  }
  ASSERT_EQ(widths.size(), 2u);
  EXPECT_NEAR(widths[0], 2.0 * widths[1], 0.02);
  EXPECT_NE(svg.find("a&lt;"), std::string::npos);
}

TEST(LineChart, PointsStandWhereTheScaleSays) {
  LineChart chart;
  chart.series = {{"s", "#123456", {{0.0, {0.0}}, {5.0, {5.0, 4.0, 6.0}}, {10.0, {10.0}}}}};
  const std::string svg = to_svg(chart);
  EXPECT_EQ(xml_fault(svg), "");
  // Both scales run from 0 to 10: the middle point is midway between the others.
  const std::regex circle("cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  std::vector<std::pair<double, double>> at;
  for (auto it = std::sregex_iterator(svg.begin(), svg.end(), circle); it != std::sregex_iterator();
       ++it) {
    at.emplace_back(std::stod((*it)[1]), std::stod((*it)[2]));
  }
  ASSERT_EQ(at.size(), 3u);
  EXPECT_NEAR(at[1].first, (at[0].first + at[2].first) / 2, 0.02);
  EXPECT_NEAR(at[1].second, (at[0].second + at[2].second) / 2, 0.02);
  EXPECT_LT(at[2].second, at[0].second);  // larger is higher
}

TEST(LineChart, LogarithmicScalesLeaveOutWhatTheyCannotShow) {
  LineChart chart;
  chart.log_x = chart.log_y = true;
  chart.series = {{"s",
                   "",
                   {{0.0, {1.0}},
                    {1.0, {-1.0}},
                    {1.0, {10.0}},
                    {100.0, {kNan}},
                    {100.0, {1000.0, -5.0, 2000.0}}}}};
  const std::string svg = to_svg(chart);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_EQ(occurrences(svg, "<circle"), 2u);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Histogram, CountsEveryValueOnce) {
  Histogram chart;
  chart.values = {0.0, 0.5, 1.0, 1.9, 2.0, 99.0, kNan, kInf, -1.0};
  chart.bin_width = 1.0;
  chart.x_max = 4.0;
  chart.marks = {{2.0, "mark"}, {9.0, "beyond"}};
  const std::string svg = to_svg(chart);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_NE(svg.find("0 to 1: 2<"), std::string::npos);
  EXPECT_NE(svg.find("1 to 2: 2<"), std::string::npos);
  EXPECT_NE(svg.find("2 to 3: 1<"), std::string::npos);
  EXPECT_NE(svg.find("3 and more: 1<"), std::string::npos);
  EXPECT_NE(svg.find("mark"), std::string::npos);
  EXPECT_EQ(svg.find("beyond"), std::string::npos);
}

TEST(GroupedBarChart, DrawsABarForEverySampleThereIs) {
  GroupedBarChart chart;
  chart.categories = {"x", "y"};
  chart.series = {{"ours", "", {Sample{1.0, 0.5, 1.5}, Sample{2.0}}},
                  {"paper", "", {std::nullopt, Sample{kNan}}}};
  const std::string svg = to_svg(chart);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_EQ(occurrences(svg, "<rect"), 2u);
}

TEST(Charts, EmptyOnesSaySo) {
  Histogram no_bins;
  no_bins.values = {1.0};
  no_bins.bin_width = 0.0;
  for (const std::string& svg :
       {to_svg(BarChart{}), to_svg(GroupedBarChart{}), to_svg(LineChart{}), to_svg(Histogram{}),
        to_svg(no_bins), to_svg(BarChart{.bars = {{"a", kNan, "", ""}}})}) {
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_NE(svg.find("no data"), std::string::npos);
  }
}

TEST(Charts, ExtremeValuesDoNotBreakThem) {
  LineChart line;
  line.series = {{"s", "", {{1e308, {1e308}}, {-1e308, {-1e308}}}}};
  BarChart bars{.bars = {{std::string(1000, 'w'), 0.0, "", ""}, {"", -5.0, "", ""}}};
  Histogram histogram;
  histogram.values = {0.0, 1e12};
  for (const std::string& svg : {to_svg(line), to_svg(bars), to_svg(histogram)}) {
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
  }
}

}  // namespace
}  // namespace furrow::ledger
