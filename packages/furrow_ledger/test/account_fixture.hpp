#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "furrow_ledger/ledger.hpp"

namespace furrow::ledger::test {

using field::PlantKind;

inline field::Plant plant(std::int64_t id, PlantKind kind, double x, double y) {
  field::Plant p;
  p.id = id;
  p.kind = kind;
  p.p_F_m = {x, y};
  p.radius_m = 0.01;
  return p;
}
inline field::FieldModel field_of(std::vector<field::Plant> plants) {
  field::FieldModel model;
  model.name = "test";
  model.length_m = 10.0;
  model.width_m = 1.4;
  model.plants = std::move(plants);
  return model;
}
inline TrackView track(std::int64_t id, double x, double y, PlantKind kind = PlantKind::kWeed,
                       bool confirmed = true) {
  return {.id = id, .p_F_m = {x, y}, .kind = kind, .confirmed = confirmed};
}
inline Spray spray(double x, double y, std::vector<std::int64_t> tracks, double aim_x,
                   double aim_y) {
  Spray s;
  s.p_F_m = {x, y};
  s.aim_F_m = {aim_x, aim_y};
  s.track_ids = std::move(tracks);
  return s;
}
inline Spray spray(double x, double y, std::vector<std::int64_t> tracks = {}) {
  return spray(x, y, std::move(tracks), x, y);
}
inline Decision leave(std::int64_t id, Reason reason, double t = 1.0) {
  return {
      .time = Time::from_seconds(t), .track_id = id, .action = Action::kLeave, .reason = reason};
}
inline Decision treat(std::int64_t id, double t = 1.0) {
  return {.time = Time::from_seconds(t), .track_id = id, .action = Action::kTreat, .axis = 2};
}
inline LedgerRow only_row(const field::FieldModel& model, const RunRecord& record) {
  const auto ledger = account(model, record);
  EXPECT_TRUE(ledger.ok());
  EXPECT_EQ(ledger->rows.size(), 1u);
  return ledger->rows.front();
}

}  // namespace furrow::ledger::test
