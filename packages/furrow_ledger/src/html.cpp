#include "furrow_ledger/html.hpp"

#include <algorithm>
#include <charconv>

namespace furrow::ledger {
namespace {

constexpr std::string_view kStyle = R"css(
:root{--ink:#1f2a24;--muted:#66736b;--line:#e4e8e2;--accent:#2e6b4a}
*{box-sizing:border-box}
body{margin:0;background:#f4f5f1;color:var(--ink);font:15px/1.55 Inter,system-ui,"Segoe UI",Roboto,
"Helvetica Neue",Arial,"DejaVu Sans",sans-serif;-webkit-font-smoothing:antialiased}
main{max-width:1290px;margin:0 auto;padding:44px 28px 72px}
h1{font-size:30px;line-height:1.2;letter-spacing:-.02em;margin:0 0 6px;font-weight:650}
.sub{color:var(--muted);margin:0 0 30px}
section{background:#fff;border:1px solid var(--line);border-radius:14px;padding:24px 26px 26px;
margin:0 0 20px;box-shadow:0 1px 2px rgba(31,42,36,.04)}
h2{font-size:18px;letter-spacing:-.01em;margin:0 0 4px;font-weight:620}
.lead{color:var(--muted);margin:0 0 18px;max-width:78ch}
p{max-width:78ch}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(165px,1fr));gap:14px;margin:0 0 20px}
.tile{background:#fff;border:1px solid var(--line);border-radius:14px;padding:16px 18px;
box-shadow:0 1px 2px rgba(31,42,36,.04);border-top:3px solid var(--accent)}
.tile b{display:block;font-size:27px;line-height:1.2;letter-spacing:-.02em;font-weight:620;
font-variant-numeric:tabular-nums}
.tile span{color:var(--muted);font-size:13px;display:block}
.tile .label{color:var(--ink);margin-bottom:6px}
figure{margin:0}
figure svg{width:100%;height:auto;display:block}
figcaption{color:var(--muted);font-size:13px;margin-top:10px}
.row{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(460px,100%),1fr));gap:30px 44px}
.row svg{width:100%;height:auto;max-width:640px;display:block}
.scroll{overflow-x:auto}
table{border-collapse:collapse;width:100%;font-size:14px;font-variant-numeric:tabular-nums}
caption{text-align:left;font-weight:600;padding:0 0 8px}
th,td{padding:7px 12px;text-align:left;border-bottom:1px solid var(--line);vertical-align:top}
thead th{color:var(--muted);font-weight:500;font-size:12.5px;white-space:nowrap}
tbody tr:last-child td{border-bottom:0}
tbody tr:hover{background:#f8f9f6}
.num{text-align:right}
.scroll + .scroll,.row + .scroll,figure + .scroll,figure + .row,.row + figure{margin-top:26px}
th:first-child,td:first-child{padding-left:4px}
.facts{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(330px,100%),1fr));gap:0 34px;
margin:0;font-size:14px}
.facts div{display:flex;justify-content:space-between;gap:18px;padding:7px 0;
border-bottom:1px solid var(--line)}
.facts dt{color:var(--muted);white-space:nowrap}
.facts dd{margin:0;text-align:right;overflow-wrap:anywhere;font-variant-numeric:tabular-nums}
@media print{body{background:#fff}section,.tile{box-shadow:none;break-inside:avoid}}
)css";

bool is_number(std::string_view text) {
  if (text.empty() || text == "-") return true;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  // A unit or percent sign may follow.
  return error == std::errc() && text.size() - static_cast<std::size_t>(end - text.data()) <= 4;
}

}  // namespace

HtmlPage::HtmlPage(std::string_view title, std::string_view subtitle) : title_(title) {
  body_.element("h1", title);
  if (!subtitle.empty()) body_.element("p", subtitle, {{"class", "sub"}});
}

void HtmlPage::close_section() {
  if (in_section_) body_.close();
  in_section_ = false;
}

HtmlPage& HtmlPage::section(std::string_view heading, std::string_view lead) {
  close_section();
  body_.open("section").element("h2", heading);
  if (!lead.empty()) body_.element("p", lead, {{"class", "lead"}});
  in_section_ = true;
  return *this;
}

HtmlPage& HtmlPage::paragraph(std::string_view text) {
  body_.element("p", text);
  return *this;
}

HtmlPage& HtmlPage::tiles(const std::vector<Tile>& tiles) {
  body_.open("div", {{"class", "tiles"}});
  for (const Tile& tile : tiles) {
    const std::string style = tile.color.empty() ? "" : "border-top-color:" + tile.color;
    body_.open("div", {{"class", "tile"}, {"style", style}});
    body_.element("span", tile.label, {{"class", "label"}}).element("b", tile.value);
    if (!tile.note.empty()) body_.element("span", tile.note);
    body_.close();
  }
  body_.close();
  return *this;
}

HtmlPage& HtmlPage::table(const ReportTable& table) {
  std::size_t columns = table.header.size();
  for (const auto& row : table.rows) columns = std::max(columns, row.size());
  std::vector<bool> numeric(columns, !table.rows.empty());
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) numeric[c] = numeric[c] && is_number(row[c]);
  }
  const auto cells = [&](const std::vector<std::string>& row, std::string_view tag) {
    body_.open("tr");
    for (std::size_t c = 0; c < columns; ++c) {
      body_.element(tag, c < row.size() ? row[c] : "", {{"class", numeric[c] ? "num" : "text"}});
    }
    body_.close();
  };
  body_.open("div", {{"class", "scroll"}}).open("table");
  if (!table.title.empty()) body_.element("caption", table.title);
  if (!table.header.empty()) {
    body_.open("thead");
    cells(table.header, "th");
    body_.close();
  }
  body_.open("tbody");
  for (const auto& row : table.rows) cells(row, "td");
  body_.close().close().close();
  return *this;
}

HtmlPage& HtmlPage::facts(const std::vector<std::pair<std::string, std::string>>& facts) {
  body_.open("dl", {{"class", "facts"}});
  for (const auto& [name, value] : facts) {
    body_.open("div").element("dt", name).element("dd", value).close();
  }
  body_.close();
  return *this;
}

HtmlPage& HtmlPage::figure(std::string_view svg, std::string_view caption) {
  body_.open("figure").raw(svg);
  if (!caption.empty()) body_.element("figcaption", caption);
  body_.close();
  return *this;
}

HtmlPage& HtmlPage::figures(const std::vector<std::string>& svgs) {
  body_.open("div", {{"class", "row"}});
  for (const std::string& svg : svgs) body_.open("div").raw(svg).close();
  body_.close();
  return *this;
}

HtmlPage& HtmlPage::raw(std::string_view markup) {
  body_.raw(markup);
  return *this;
}

std::string HtmlPage::finish() {
  close_section();
  std::string page = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n";
  page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>";
  page += escape(title_) + "</title>\n<style>";
  page += kStyle;
  page += "</style></head>\n<body><main>\n";
  page += body_.finish();
  page += "</main></body></html>\n";
  return page;
}

}  // namespace furrow::ledger
