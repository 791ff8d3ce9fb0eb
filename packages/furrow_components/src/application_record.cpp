#include "furrow_components/application_record.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "furrow_components/conversions.hpp"
#include "furrow_core/file.hpp"
#include "furrow_geometry/geodetic.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_ledger/markup.hpp"
#include "furrow_msgs/enums.hpp"

namespace furrow::components {
namespace {

using actuation::Application;
using furrow_msgs::msg::RunRecord;
using ledger::fixed;
using ledger::ReportTable;
using msgs::AxisEventKind;

const geometry::AxisModel* find_axis(const geometry::ToolModel& tool, const std::string& name) {
  const auto it = std::ranges::find(tool.axes, name, &geometry::AxisModel::name);
  return it == tool.axes.end() ? nullptr : &*it;
}

ReportTable nozzle_table(const RunRecord& record) {
  ReportTable table{"Use by nozzle", {"axis", "openings", "open", "volume", "ended as"}, {}};
  for (const auto& state : record.axes()) {
    std::string ended = msgs::to_string(state.mode());
    if (state.cause() != msgs::SafetyCause::kNone) ended += ": " + msgs::to_string(state.cause());
    table.rows.push_back({state.axis(), std::to_string(state.openings()),
                          fixed(state.open_s(), 2) + " s", fixed(state.volume_ml(), 1) + " ml",
                          ended});
  }
  return table;
}

/// Each spray counts for the nearest crop row.
ReportTable row_table(const RunRecord& record, const std::vector<Application>& applications) {
  ReportTable table{"Use by crop row", {"row at y", "sprays", "volume", "per metre"}, {}};
  std::vector<double> rows_m = record.field().row_y_m();
  std::ranges::sort(rows_m);
  if (rows_m.empty()) return table;
  struct Use {
    int sprays = 0;
    double volume_ml = 0.0;
  };
  std::map<double, Use> uses;
  for (const double y_m : rows_m) uses[y_m] = {};
  for (const Application& a : applications) {
    const double row_m = *std::ranges::min_element(
        rows_m, {}, [&](double y_m) { return std::abs(y_m - a.p_F.y()); });
    ++uses[row_m].sprays;
    uses[row_m].volume_ml += a.volume_ml;
  }
  const double length_m = record.field().length_m();
  for (const auto& [y_m, use] : uses) {
    table.rows.push_back({fixed(y_m, 2) + " m", std::to_string(use.sprays),
                          fixed(use.volume_ml, 1) + " ml",
                          length_m > 0.0 ? fixed(use.volume_ml / length_m, 2) + " ml" : "-"});
  }
  return table;
}

/// The reach of the nozzles times the distance over the field.
double covered_area_m2(const RunRecord& record, const geometry::ToolModel& tool) {
  double left_m = 0.0;
  double right_m = 0.0;
  for (const geometry::AxisModel& axis : tool.axes) {
    for (const double q_m : {axis.lower_m, axis.upper_m}) {
      const double y_m = axis.nozzle_position_B(q_m).y();
      left_m = std::max(left_m, y_m + axis.nozzle.footprint_radius_m);
      right_m = std::min(right_m, y_m - axis.nozzle.footprint_radius_m);
    }
  }
  double length_m = record.distance_m();
  if (record.field().length_m() > 0.0) length_m = std::min(length_m, record.field().length_m());
  return length_m * (left_m - right_m);
}

ReportTable area_table(const RunRecord& record, const std::vector<Application>& applications,
                       const geometry::ToolModel& tool) {
  const double covered_m2 = covered_area_m2(record, tool);
  const double sprayed_m2 = actuation::sprayed_area_m2(applications);
  double volume_ml = 0.0;
  for (const Application& a : applications) volume_ml += a.volume_ml;
  ReportTable table{"Use by area", {"", ""}, {}};
  table.rows.push_back({"covered", fixed(covered_m2, 2) + " m2"});
  table.rows.push_back({"sprayed", fixed(sprayed_m2, 3) + " m2"});
  if (covered_m2 > 0.0) {
    table.rows.push_back({"sprayed of covered", fixed(100.0 * sprayed_m2 / covered_m2, 2) + " %"});
    constexpr double kLitresPerHectare = 10.0;  // per ml/m2
    table.rows.push_back(
        {"volume over covered", fixed(kLitresPerHectare * volume_ml / covered_m2, 1) + " l/ha"});
  }
  return table;
}

ReportTable safety_table(const RunRecord& record) {
  ReportTable table{"Safe states", {"at", "axis", "cause", "valve shut after"}, {}};
  for (const auto& event : record.events()) {
    const bool reset = event.event() == AxisEventKind::kReset;
    if (!reset && event.event() != AxisEventKind::kSafeState) continue;
    const Time at = graph::from_msg(event.header().stamp());
    const Duration took = graph::from_msg(event.closed()) - graph::from_msg(event.opened());
    table.rows.push_back({fixed(at.to_seconds(), 3) + " s", event.axis(),
                          reset ? "reset" : msgs::to_string(event.cause()),
                          reset ? "" : fixed(1e3 * took.to_seconds(), 2) + " ms"});
  }
  return table;
}

}  // namespace

std::vector<Application> applications_of(const RunRecord& record, const geometry::ToolModel& tool) {
  std::vector<Application> applications;
  for (const auto& event : record.events()) {
    const geometry::AxisModel* axis = find_axis(tool, event.axis());
    if (event.event() != AxisEventKind::kSprayed || axis == nullptr) continue;
    const Time opened = graph::from_msg(event.opened());
    applications.push_back({.axis = event.axis(),
                            .time = opened,
                            .open_s = (graph::from_msg(event.closed()) - opened).to_seconds(),
                            .volume_ml = event.volume_ml(),
                            .p_F = from_point(event.landing()).head<2>(),
                            .radius_m = axis->nozzle.footprint_radius_m,
                            .track_ids = event.track_ids()});
  }
  return applications;
}

std::vector<ReportTable> use_tables(const RunRecord& record,
                                    const std::vector<Application>& applications,
                                    const geometry::ToolModel& tool) {
  std::vector<ReportTable> tables = {nozzle_table(record), row_table(record, applications),
                                     area_table(record, applications, tool), safety_table(record)};
  std::erase_if(tables, [](const ReportTable& table) { return table.rows.empty(); });
  return tables;
}

Status write_as_applied(const std::filesystem::path& folder, const RunRecord& record,
                        const std::vector<Application>& applications) {
  if (!record.georeferenced()) return {};
  const auto earth = geometry::FieldGeoreference::at(
      {record.origin_latitude_deg(), record.origin_longitude_deg(), record.origin_altitude_m()},
      record.row_angle_rad());
  if (!earth) {
    return Error{earth.error().code,
                 "as_applied.geojson: the field's origin: " + earth.error().message};
  }
  return write_file_atomically(
      folder / "as_applied.geojson",
      actuation::as_applied_geojson(
          applications, [&](const Eigen::Vector2d& p_F) { return earth->to_lon_lat_deg(p_F); }));
}

}  // namespace furrow::components
