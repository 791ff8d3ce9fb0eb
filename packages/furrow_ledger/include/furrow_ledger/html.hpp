#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "furrow_ledger/markup.hpp"
#include "furrow_ledger/run_record.hpp"

namespace furrow::ledger {

/// One headline figure.
struct Tile {
  std::string label;
  std::string value;
  std::string note;   ///< a line below; may be empty
  std::string color;  ///< of the edge; may be empty
};

/// A self-contained page: style inline, no scripts, nothing fetched. Everything given as text is
/// escaped; only `figure` and `raw` take markup.
class HtmlPage {
 public:
  HtmlPage(std::string_view title, std::string_view subtitle);

  HtmlPage& section(std::string_view heading, std::string_view lead = {});
  HtmlPage& paragraph(std::string_view text);
  HtmlPage& tiles(const std::vector<Tile>& tiles);
  /// Columns whose cells are all numbers are set flush right.
  HtmlPage& table(const ReportTable& table);
  /// A table of names and values.
  HtmlPage& facts(const std::vector<std::pair<std::string, std::string>>& facts);
  /// An inline SVG with a caption below it.
  HtmlPage& figure(std::string_view svg, std::string_view caption = {});
  /// Figures side by side where the page is wide enough.
  HtmlPage& figures(const std::vector<std::string>& svgs);
  HtmlPage& raw(std::string_view markup);
  /// The whole document. Leaves the page empty.
  [[nodiscard]] std::string finish();

 private:
  void close_section();
  Markup body_;
  std::string title_;
  bool in_section_ = false;
};

}  // namespace furrow::ledger
