#include <array>
#include <charconv>
#include <cmath>

#include "furrow_ledger/ledger.hpp"
#include "furrow_ledger/markup.hpp"

namespace furrow::ledger {
namespace {

std::string field_text(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

/// The shortest decimal that reads back as the same number: worths can be computed again.
std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace

std::string to_csv(const Ledger& ledger) {
  std::string csv =
      "plant_id,kind,species,x_m,y_m,radius_m,area_mm2,outcome,reason,decision,axis,spray_time_s,"
      "spray_distance_mm,track_id,track_kind,track_distance_mm,seen_species,seen_probability,"
      "unknown_probability,seen_area_mm2,seen_leaves,beta,class_weight,crop_distance_m,"
      "crop_proximity_per_mm2_m,worth_scheme,worth,worth_threshold\n";
  for (const LedgerRow& row : ledger.rows) {
    const auto cell = [&csv](std::string_view text) {
      csv += field_text(text);
      csv += ',';
    };
    cell(std::to_string(row.plant_id));
    cell(to_string(row.kind));
    cell(row.species);
    cell(fixed(row.p_F_m.x(), 4));
    cell(fixed(row.p_F_m.y(), 4));
    cell(fixed(row.radius_m, 4));
    cell(fixed(row.area_mm2, 1));
    cell(to_string(row.outcome));
    cell(row.reason == Reason::kNone ? "" : to_string(row.reason));
    cell(row.action == Action::kNone ? "" : to_string(row.action));
    cell(row.axis < 0 ? "" : std::to_string(row.axis));
    cell(row.sprayed ? fixed(row.sprayed->to_seconds(), 4) : "");
    cell(row.spray_distance_m ? fixed(*row.spray_distance_m * 1e3, 2) : "");
    cell(row.track_id ? std::to_string(*row.track_id) : "");
    cell(row.track_kind ? to_string(*row.track_kind) : "");
    cell(row.track_distance_m ? fixed(*row.track_distance_m * 1e3, 2) : "");
    cell(row.seen_species);
    cell(row.seen_probability ? shortest(*row.seen_probability) : "");
    const Appraisal appraisal = row.appraisal.value_or(Appraisal());
    const auto appraised = [&](double value) { cell(row.appraisal ? shortest(value) : ""); };
    appraised(appraisal.unknown_probability);
    appraised(appraisal.area_mm2);
    cell(appraisal.leaves > 0 ? std::to_string(appraisal.leaves) : "");
    appraised(appraisal.beta);
    appraised(appraisal.class_weight);
    cell(row.appraisal && std::isfinite(appraisal.crop_distance_m)
             ? shortest(appraisal.crop_distance_m)
             : "");
    appraised(appraisal.crop_proximity);
    cell(appraisal.scheme);
    appraised(appraisal.worth);
    appraised(appraisal.threshold);
    csv.back() = '\n';
  }
  return csv;
}

}  // namespace furrow::ledger
