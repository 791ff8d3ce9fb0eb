#include "furrow_evaluation/vision_report.hpp"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "furrow_core/text.hpp"
#include "furrow_core/version.hpp"
#include "furrow_ledger/chart.hpp"
#include "furrow_ledger/html.hpp"

namespace furrow::evaluation {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no NaN.
Json figure(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json interval_of(const vision::Interval& interval) {
  return Json::array({figure(interval.low), figure(interval.high)});
}

Json intervals_of(const vision::ScoreIntervals& intervals) {
  return {{"iou_vegetation", interval_of(intervals.iou_vegetation)},
          {"iou_crop", interval_of(intervals.iou_crop)},
          {"iou_weed", interval_of(intervals.iou_weed)},
          {"miou", interval_of(intervals.miou)},
          {"crops_sprayed_pct", interval_of(intervals.crops_sprayed_pct)},
          {"weeds_found_pct", interval_of(intervals.weeds_found_pct)},
          {"false_per_m2", interval_of(intervals.false_per_m2)}};
}

std::string cell(double value, int decimals) {
  return std::isfinite(value) ? fixed(value, decimals) : "-";
}

std::vector<std::string> cells_of(const VisionRow& row) {
  const vision::VisionScores& s = row.scores;
  return {row.dataset,
          row.detector,
          std::to_string(s.images),
          cell(s.iou_vegetation, 3),
          cell(s.iou_crop, 3),
          cell(s.iou_weed, 3),
          cell(s.miou, 3),
          cell(s.ap_mask, 3),
          cell(s.ap50_mask, 3),
          cell(s.ap50_box, 3),
          cell(s.pq, 3),
          cell(s.stem_p50_mm, 2),
          cell(s.area_error_p50_pct, 1),
          cell(s.outcome.crops_sprayed_pct(), 1),
          cell(s.outcome.weeds_found_pct(), 1),
          cell(s.outcome.false_per_m2(), 2),
          cell(row.ms_per_frame, 1)};
}

const std::vector<std::string> kHeader = {
    "data set",   "detector",        "images",        "IoU veg.",  "crop", "weed",
    "mean",       "AP mask",         "AP50 mask",     "AP50 box",  "PQ",   "stem p50 mm",
    "area p50 %", "crops sprayed %", "weeds found %", "false /m2", "ms"};

}  // namespace

std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

std::string to_json(const VisionReport& report) {
  Json json = {{"rows", Json::array()}};
  for (const VisionRow& row : report.rows) {
    const vision::VisionScores& s = row.scores;
    json["rows"].push_back({{"dataset", row.dataset},
                            {"detector", row.detector},
                            {"images", s.images},
                            {"iou_vegetation", figure(s.iou_vegetation)},
                            {"iou_crop", figure(s.iou_crop)},
                            {"iou_weed", figure(s.iou_weed)},
                            {"miou", figure(s.miou)},
                            {"ap_mask", figure(s.ap_mask)},
                            {"ap50_mask", figure(s.ap50_mask)},
                            {"ap50_box", figure(s.ap50_box)},
                            {"ap50_crop", figure(s.ap50_crop)},
                            {"ap50_weed", figure(s.ap50_weed)},
                            {"pq", figure(s.pq)},
                            {"stem_p50_mm", figure(s.stem_p50_mm)},
                            {"area_error_p50_pct", figure(s.area_error_p50_pct)},
                            {"crops_total", s.outcome.crops},
                            {"crops_sprayed_pct", figure(s.outcome.crops_sprayed_pct())},
                            {"weeds_total", s.outcome.weeds},
                            {"weeds_found_pct", figure(s.outcome.weeds_found_pct())},
                            {"false_per_m2", figure(s.outcome.false_per_m2())},
                            {"ci95", intervals_of(row.intervals)},
                            {"ms_per_frame", figure(row.ms_per_frame)}});
  }
  json["seed"] = report.seed;
  json["parameters"] = Json::object();
  for (const auto& [key, value] : report.parameters) json["parameters"][key] = value;
  json["version"] = version();
  return json.dump(2) + "\n";
}

std::string to_table(const VisionReport& report) {
  std::vector<std::vector<std::string>> table = {kHeader};
  for (const VisionRow& row : report.rows) table.push_back(cells_of(row));
  return text_table(table);
}

std::string to_html(const VisionReport& report) {
  ledger::HtmlPage page("Seeing plants",
                        "Furrow " + std::string(version()) + ", detectors on data sets");
  page.section("Figures",
               "IoU of pixels, summed over the images. Average precision by COCO's procedure over "
               "crop and weed. Panoptic quality. Errors of stems and areas of plants that were "
               "found with a mask IoU of at least 0.5. Crops sprayed: a weed's stem in the crop's "
               "mask, or a footprint of 25 mm on its stem. Weeds found: a weed's stem within "
               "15 mm. False: detections on no plant. A dash: the data set does not say.");
  ledger::ReportTable table{.title = "", .header = kHeader, .rows = {}};
  for (const VisionRow& row : report.rows) table.rows.push_back(cells_of(row));
  page.table(table);
  if (!report.parameters.empty()) page.facts(report.parameters);

  std::vector<std::string> datasets;
  std::map<std::string, std::vector<const VisionRow*>> rows_of;
  for (const VisionRow& row : report.rows) {
    if (!rows_of.contains(row.dataset)) datasets.push_back(row.dataset);
    rows_of[row.dataset].push_back(&row);
  }
  std::vector<std::string> charts;
  for (const std::string& dataset : datasets) {
    ledger::GroupedBarChart chart{.title = dataset,
                                  .y_label = "IoU, AP50",
                                  .categories = {"vegetation", "crop", "weed", "AP50 mask", "PQ"},
                                  .series = {}};
    for (const VisionRow* row : rows_of[dataset]) {
      ledger::GroupedBarChart::Series series{.name = row->detector, .color = {}, .samples = {}};
      const vision::VisionScores& s = row->scores;
      for (const double value : {s.iou_vegetation, s.iou_crop, s.iou_weed, s.ap50_mask, s.pq}) {
        series.samples.push_back(
            std::isfinite(value) ? std::optional<ledger::Sample>({.value = value}) : std::nullopt);
      }
      chart.series.push_back(std::move(series));
    }
    charts.push_back(ledger::to_svg(chart));
  }
  page.figures(charts);

  page.section("Pictures",
               "For each detector and data set the images that came out best and worst (mean IoU "
               "of soil, weed and crop). Annotations on the left, detections on the right: crops "
               "green, weeds orange, a cross at the stem.");
  for (const VisionPicture& picture : report.pictures) {
    page.paragraph(picture.dataset + ", " + picture.detector + ": " + picture.file + ", mean IoU " +
                   fixed(picture.miou, 3));
    ledger::Markup image;
    image.empty("img", {{"src", "data:image/jpeg;base64," + base64(picture.jpeg)},
                        {"alt", picture.file},
                        {"style", "max-width:100%"}});
    page.raw(image.finish());
  }
  return page.finish();
}

}  // namespace furrow::evaluation
