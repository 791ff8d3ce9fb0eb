#include "furrow_field/field_csv.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "csv_cells.hpp"
#include "furrow_core/text.hpp"
#include "furrow_core/utf8.hpp"
#include "numbers.hpp"

namespace furrow::field {
namespace {

constexpr std::array<std::string_view, 9> kColumns = {
    "id", "kind", "species", "x_m", "y_m", "radius_m", "area_mm2", "leaves", "heading_rad"};
constexpr std::array<std::string_view, 3> kRequired = {"kind", "x_m", "y_m"};

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"#") == std::string::npos) {
    return text;
  }
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

/// Only separators: the empty row of a spreadsheet.
bool is_blank(std::string_view line) {
  return line.find_first_not_of(",; \t") == std::string_view::npos;
}

class CsvReader {
 public:
  CsvReader(std::string_view text, std::string_view origin) : text_(text), origin_(origin) {}

  Result<FieldModel> read() {
    if (const std::string fault = take_byte_order_mark(text_); !fault.empty()) {
      return Error{ErrorCode::kParse, origin_ + ":" + fault};
    }
    std::string_view line;
    bool have_header = false;
    while (next_line(line)) {
      Status status;
      if (is_blank(line)) continue;
      if (!have_header && line.starts_with("sep=")) continue;  // the header shows it too
      if (!have_header && line.front() == '#') {
        status = read_comment(line);
      } else if (!have_header) {
        status = read_header(line);
        have_header = true;
      } else {
        status = read_plant(line);
      }
      if (!status.ok()) return status.error();
    }
    if (!have_header) return fail("header", "the file has no header line");
    complete_extent();
    sort_plants(field_);
    if (Status status = validate(field_); !status.ok()) {
      return Error{status.error().code, origin_ + ": " + status.error().message};
    }
    return std::move(field_);
  }

 private:
  [[nodiscard]] Error fail(std::string_view key, std::string_view message) const {
    return {ErrorCode::kParse, origin_ + ":" + std::to_string(line_) + ": " + std::string(key) +
                                   ": " + std::string(message)};
  }

  bool next_line(std::string_view& line) {
    if (text_.empty()) return false;
    const std::size_t end = text_.find('\n');
    line = text_.substr(0, end);
    text_ = end == std::string_view::npos ? std::string_view() : text_.substr(end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++line_;
    return true;
  }

  Status read_comment(std::string_view line) {
    // A spreadsheet appends separators.
    line = line.substr(0, line.find_last_not_of(",;\t") + 1);
    const std::size_t colon = line.find(": ");
    if (colon == std::string_view::npos || line.size() < 2) return {};
    const std::string_view key = line.substr(2, colon > 2 ? colon - 2 : 0);
    const std::string_view value = line.substr(colon + 2);
    if (key == "name") field_.name = value;
    if (key == "source") field_.source = value;
    if (key == "length_m" || key == "width_m") {
      const auto number = parse_number<double>(value);
      if (!number) return fail(key, "'" + std::string(value) + "' is not a finite number");
      (key == "length_m" ? length_m_ : width_m_) = number;
    }
    return key == "row_y_m" ? read_rows(value) : Status();
  }

  Status read_rows(std::string_view value) {
    while (!value.empty()) {
      const std::size_t space = value.find(' ');
      const std::string_view word = value.substr(0, space);
      value = space == std::string_view::npos ? std::string_view() : value.substr(space + 1);
      if (word.empty()) continue;
      const auto number = parse_number<double>(word);
      if (!number) return fail("row_y_m", "'" + std::string(word) + "' is not a finite number");
      field_.row_y_m.push_back(*number);
    }
    return {};
  }

  Status read_header(std::string_view line) {
    separator_ = csv_separator(line);
    const auto cells = csv_cells(line, separator_);
    if (!cells) return fail("header", "a quote does not close");
    for (const std::string& cell : *cells) {
      const auto column = std::find(kColumns.begin(), kColumns.end(), cell);
      if (column == kColumns.end()) return fail("header", "the column '" + cell + "' is not known");
      const auto index = static_cast<std::size_t>(column - kColumns.begin());
      if (std::find(order_.begin(), order_.end(), index) != order_.end()) {
        return fail("header", "the column '" + cell + "' is there twice");
      }
      order_.push_back(index);
    }
    for (const std::string_view name : kRequired) {
      if (std::find(cells->begin(), cells->end(), name) == cells->end()) {
        return fail("header", "the column '" + std::string(name) + "' is missing");
      }
    }
    return {};
  }

  Status read_plant(std::string_view line) {
    if (field_.plants.size() >= kMaxPlants) return fail("file", "more than 1000000 plants");
    const auto cells = csv_cells(line, separator_);
    if (!cells) return fail("line", "a quote does not close or text follows it");
    if (cells->size() != order_.size()) {
      return fail("line", std::to_string(cells->size()) + " cells where the header has " +
                              std::to_string(order_.size()) + more_cells_hint(cells->size()));
    }
    Plant plant;
    plant.id = static_cast<std::int64_t>(field_.plants.size());
    for (std::size_t i = 0; i < cells->size(); ++i) {
      std::string cell(trimmed((*cells)[i]));
      if (is_number(order_[i]) && separator_ != ',') use_decimal_point(cell);
      if (!assign(plant, order_[i], cell)) {
        return fail(kColumns[order_[i]], "'" + (*cells)[i] + "' is no value for this column");
      }
    }
    field_.plants.push_back(std::move(plant));
    return {};
  }

  [[nodiscard]] std::string more_cells_hint(std::size_t cells) const {
    if (separator_ != ',' || cells < order_.size()) return {};
    return ": where the comma is the decimal mark, separate the cells by ';'";
  }

  static bool is_number(std::size_t column) { return column != 1 && column != 2; }

  /// "0,25" becomes "0.25". A cell with a point or several commas is unchanged.
  static void use_decimal_point(std::string& cell) {
    if (cell.find('.') != std::string::npos) return;
    if (std::count(cell.begin(), cell.end(), ',') == 1) cell[cell.find(',')] = '.';
  }

  template <class Number, class Target>
  static bool set(Target& target, const std::string& cell) {
    const auto value = parse_number<Number>(cell);
    if (value) target = *value;
    return value.has_value();
  }

  static bool assign(Plant& plant, std::size_t column, const std::string& cell) {
    switch (column) {
      case 0:
        return set<std::int64_t>(plant.id, cell);
      case 1: {
        const auto kind = plant_kind_from(cell);
        if (kind) plant.kind = *kind;
        return kind.has_value();
      }
      case 2:
        plant.species = cell;
        return true;
      case 3:
        return set<double>(plant.p_F_m.x(), cell);
      case 4:
        return set<double>(plant.p_F_m.y(), cell);
      case 5:
        return set<double>(plant.radius_m, cell);
      case 6:
        return set<double>(plant.area_mm2, cell);
      case 7:
        return set<int>(plant.leaves, cell);
      default:
        return set<double>(plant.heading_rad, cell);
    }
  }

  void complete_extent() {
    double length_m = 0.0;
    double half_width_m = 0.0;
    for (const Plant& plant : field_.plants) {
      length_m = std::max(length_m, plant.p_F_m.x());
      half_width_m = std::max(half_width_m, std::abs(plant.p_F_m.y()));
    }
    field_.length_m = length_m_.value_or(length_m);
    field_.width_m = width_m_.value_or(2.0 * half_width_m);
    if (field_.source.empty()) field_.source = "imported: " + origin_;
  }

  std::string_view text_;
  std::string origin_;
  int line_ = 0;
  char separator_ = ',';
  FieldModel field_;
  std::optional<double> length_m_;
  std::optional<double> width_m_;
  std::vector<std::size_t> order_;  ///< for each cell, its index in kColumns
};

}  // namespace

Result<std::string> to_csv(const FieldModel& field) {
  if (Status status = validate(field); !status.ok()) return status.error();
  std::string text = "# name: " + field.name + "\n# source: " + field.source +
                     "\n# length_m: " + exact_text(field.length_m) +
                     "\n# width_m: " + exact_text(field.width_m) + "\n# row_y_m: ";
  for (std::size_t i = 0; i < field.row_y_m.size(); ++i) {
    text += (i > 0 ? " " : "") + exact_text(field.row_y_m[i]);
  }
  text += '\n';
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    if (i > 0) text += ',';
    text += kColumns[i];
  }
  text += '\n';
  for (const Plant& plant : field.plants) {
    text += std::to_string(plant.id) + ',' + std::string(to_string(plant.kind)) + ',' +
            quoted(plant.species) + ',' + exact_text(plant.p_F_m.x()) + ',' +
            exact_text(plant.p_F_m.y()) + ',' + exact_text(plant.radius_m) + ',' +
            exact_text(plant.area_mm2) + ',' + std::to_string(plant.leaves) + ',' +
            exact_text(plant.heading_rad) + '\n';
  }
  if (!is_utf8(text)) return Error{ErrorCode::kInvalidArgument, "a text is not UTF-8"};
  return text;
}

Result<FieldModel> from_csv(std::string_view text, std::string_view origin) {
  return CsvReader(text, origin).read();
}

}  // namespace furrow::field
