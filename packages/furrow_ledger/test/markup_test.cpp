#include "furrow_ledger/markup.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "furrow_ledger/html.hpp"

namespace furrow::ledger {
namespace {

TEST(Escape, ReplacesWhatMarkupReads) {
  EXPECT_EQ(escape("<a href=\"x\">Tom & 'Jerry'</a>"),
            "&lt;a href=&quot;x&quot;&gt;Tom &amp; &#39;Jerry&#39;&lt;/a&gt;");
  EXPECT_EQ(escape("caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x8C\xB1"),
            "caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x8C\xB1");
}

TEST(Escape, ReplacesWhatIsNotText) {
  const std::string bad = "\xEF\xBF\xBD";
  EXPECT_EQ(escape(std::string("a\0b", 3)), "a" + bad + "b");
  EXPECT_EQ(escape("a\x1b[0m"), "a" + bad + "[0m");
  EXPECT_EQ(escape("\xff"), bad);
  EXPECT_EQ(escape("\xC3"), bad);                      // cut short
  EXPECT_EQ(escape("\xC0\xAF"), bad + bad);            // an overlong slash
  EXPECT_EQ(escape("\xED\xA0\x80"), bad + bad + bad);  // a surrogate
  EXPECT_EQ(escape("tab\tline\n"), "tab\tline\n");
}

TEST(Number, IsShortAndNeverMinusZero) {
  EXPECT_EQ(number(1.5), "1.5");
  EXPECT_EQ(number(2.0), "2");
  EXPECT_EQ(number(100.0, 0), "100");
  EXPECT_EQ(number(0.12345, 2), "0.12");
  EXPECT_EQ(number(-0.0001, 2), "0");
  EXPECT_EQ(fixed(-0.0001, 2), "0.00");
  EXPECT_EQ(fixed(-1.005e3, 1), "-1005.0");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN()), "-");
  EXPECT_EQ(number(std::numeric_limits<double>::infinity()), "-");
  EXPECT_EQ(number(1e300, 0).size(), 301u);
}

TEST(Markup, ClosesWhatItOpened) {
  Markup markup;
  markup.open("g", {{"id", "a\"b"}}).element("text", "1 < 2").empty("line");
  EXPECT_EQ(markup.finish(), "<g id=\"a&quot;b\"><text>1 &lt; 2</text>\n<line/>\n</g>\n");
  EXPECT_EQ(markup.finish(), "");
}

TEST(HtmlPage, IsSelfContainedAndEscapes) {
  HtmlPage page("A <b>", "sub & title");
  page.tiles({{"<t>", "1", "", ""}}).section("S<1>", "lead<2>");
  page.table({"cap<3>", {"h<4>", "n"}, {{"c<5>", "1.5 %"}, {"d", "2"}}});
  page.facts({{"k<6>", "v<7>"}}).paragraph("p<8>").figure("<svg></svg>", "f<9>");
  const std::string html = page.finish();
  for (int i = 1; i <= 9; ++i) {
    EXPECT_EQ(html.find("<" + std::to_string(i) + ">"), std::string::npos) << i;
    EXPECT_NE(html.find("&lt;" + std::to_string(i) + "&gt;"), std::string::npos) << i;
  }
  for (const char* fetched : {"http://", "https://", "<script", "@import", "url("}) {
    EXPECT_EQ(html.find(fetched), std::string::npos) << fetched;
  }
  EXPECT_EQ(html.find("<!DOCTYPE html>"), 0u);
  EXPECT_NE(html.find("<td class=\"num\">1.5 %</td>"), std::string::npos);
  EXPECT_NE(html.find("<td class=\"text\">d</td>"), std::string::npos);
}

TEST(HtmlPage, AcceptsRaggedAndEmptyTables) {
  HtmlPage page("t", "");
  page.table({"", {"a"}, {{"1", "2", "3"}, {}}}).table({});
  const std::string html = page.finish();
  EXPECT_NE(html.find(">3</td>"), std::string::npos);
}

}  // namespace
}  // namespace furrow::ledger
