#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "furrow_core/text.hpp"

namespace furrow::ledger {

/// Text escaped for HTML and SVG, also for quoted attributes: & < > " ' are replaced. Control
/// characters that XML forbids, and bytes that are not UTF-8, become U+FFFD.
[[nodiscard]] std::string escape(std::string_view text);

/// A number with at most `decimals` digits after the point and no trailing zeros; "-" when not
/// finite. The same on every locale.
[[nodiscard]] std::string number(double value, int decimals = 3);
using furrow::fixed;

using Attribute = std::pair<std::string_view, std::string>;
using Attributes = std::initializer_list<Attribute>;

/// Writes elements of HTML or SVG: escapes what it is given, closes what it opened.
class Markup {
 public:
  Markup& open(std::string_view tag, Attributes attributes = {});
  /// @pre an element is open.
  Markup& close();
  Markup& text(std::string_view text);
  /// An element that holds only text.
  Markup& element(std::string_view tag, std::string_view text, Attributes attributes = {});
  /// An element without content, as `<tag/>`: SVG shapes, and HTML's void elements.
  Markup& empty(std::string_view tag, Attributes attributes = {});
  /// Markup that is already safe, such as a chart's SVG.
  Markup& raw(std::string_view markup);
  /// Everything so far, with all that is open closed. Leaves the builder empty.
  [[nodiscard]] std::string finish();

 private:
  void start(std::string_view tag, Attributes attributes);
  std::string text_;
  std::vector<std::string> open_;
};

}  // namespace furrow::ledger
