#include "summary.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "furrow_core/statistics.hpp"

namespace furrow::ledger {
namespace {

using Json = nlohmann::ordered_json;

/// Figures are written to a tenth of a micrometre or a ten-thousandth of a percent: enough, and
/// readable.
Json rounded(double value) {
  return Json(std::round(value * 1e4) / 1e4);
}
Json rounded(const std::optional<double>& value) {
  return value ? rounded(*value) : Json(nullptr);
}
Json rounded(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(rounded(value));
  return list;
}

}  // namespace

void count_rows(const std::vector<LedgerRow>& rows, Summary& summary) {
  std::int64_t vision = 0;
  for (const LedgerRow& row : rows) {
    if (row.kind == field::PlantKind::kCrop) {
      ++summary.crops_total;
      if (row.outcome == Outcome::kHit) ++summary.crops_hit;
      continue;
    }
    ++summary.weeds_total;
    switch (row.outcome) {
      case Outcome::kAccurate:
        ++summary.treated_accurate;
        break;
      case Outcome::kPartial:
        ++summary.treated_partial;
        break;
      default:
        ++summary.missed;
        ++summary.missed_by_reason.at(static_cast<std::size_t>(row.reason));
        if (is_vision_loss(row.reason)) ++vision;
    }
  }
  if (summary.weeds_total == 0) return;
  const double percent = 100.0 / static_cast<double>(summary.weeds_total);
  summary.loss_pct = static_cast<double>(summary.missed) * percent;
  summary.loss_vision_pct = static_cast<double>(vision) * percent;
  summary.loss_planning_pct = static_cast<double>(summary.missed - vision) * percent;
}

void take_run_info(const RunInfo& info, Summary& summary) {
  summary.simulated = info.simulated;
  summary.interrupted = info.interrupted;
  summary.axis_travel_m = info.axis_travel_m;
  summary.speed_mps = info.speed_mps;
  summary.distance_m = info.distance_m;
  summary.duration_s = info.duration_s;
  summary.seed = info.seed;
  summary.version = info.version;
  if (info.wall_s > 0.0) {
    summary.wall_s = info.wall_s;
    summary.realtime_factor = info.duration_s / info.wall_s;
  }
}

void set_errors(const std::vector<double>& placement_mm, const std::vector<double>& aim_mm,
                Summary& summary) {
  if (!placement_mm.empty()) {
    summary.placement_error_p50_mm = quantile_of_sorted(placement_mm, 0.50);
    summary.placement_error_p95_mm = quantile_of_sorted(placement_mm, 0.95);
    for (int i = 0; i <= 10; ++i) {
      summary.placement_error_deciles_mm.push_back(quantile_of_sorted(placement_mm, i / 10.0));
    }
  }
  if (!aim_mm.empty()) {
    summary.aim_error_p50_mm = quantile_of_sorted(aim_mm, 0.50);
    summary.aim_error_p95_mm = quantile_of_sorted(aim_mm, 0.95);
  }
}

std::string to_json(const Summary& summary) {
  Json reasons = Json::object();
  for (std::size_t i = 1; i < kReasonCount; ++i) {
    reasons[std::string(to_string(static_cast<Reason>(i)))] = summary.missed_by_reason[i];
  }
  Json json;
  json["field"] = summary.field;
  json["source"] = summary.source;
  json["simulated"] = summary.simulated;
  json["against_truth"] = summary.against_truth;
  json["interrupted"] = summary.interrupted;
  json["weeds_total"] = summary.weeds_total;
  json["treated_accurate"] = summary.treated_accurate;
  json["treated_partial"] = summary.treated_partial;
  json["missed"] = summary.missed;
  json["missed_by_reason"] = std::move(reasons);
  json["loss_pct"] = rounded(summary.loss_pct);
  json["loss_planning_pct"] = rounded(summary.loss_planning_pct);
  json["loss_vision_pct"] = summary.against_truth ? Json(rounded(summary.loss_vision_pct)) : Json();
  json["crops_total"] = summary.crops_total;
  json["crops_hit"] = summary.crops_hit;
  json["sprays"] = summary.sprays;
  json["sprays_without_weed"] = summary.sprays_without_weed;
  json["sprays_uncommanded"] = summary.sprays_uncommanded;
  json["sprays_by_axis"] = summary.sprays_by_axis;
  json["placement_error_p50_mm"] = rounded(summary.placement_error_p50_mm);
  json["placement_error_p95_mm"] = rounded(summary.placement_error_p95_mm);
  json["placement_error_deciles_mm"] = rounded(summary.placement_error_deciles_mm);
  json["aim_error_p50_mm"] = rounded(summary.aim_error_p50_mm);
  json["aim_error_p95_mm"] = rounded(summary.aim_error_p95_mm);
  json["tracks_total"] = summary.tracks_total;
  json["tracks_without_plant"] = summary.tracks_without_plant;
  json["axis_travel_m"] = rounded(summary.axis_travel_m);
  json["speed_mps"] = rounded(summary.speed_mps);
  json["distance_m"] = rounded(summary.distance_m);
  json["duration_s"] = rounded(summary.duration_s);
  json["seed"] = summary.seed;
  json["version"] = summary.version;
  json["realtime_factor"] = rounded(summary.realtime_factor);
  json["wall_s"] = rounded(summary.wall_s);
  // Names may come from files: bytes that are not UTF-8 must not stop the run's summary.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace furrow::ledger
