#include "hardware.hpp"

namespace furrow::actuation::campaign {

void ValveHardware::set_coil(Time now, bool open) {
  if (coil_ == open) return;
  coil_ = open;
  coil_since_ = now;
}

bool ValveHardware::request(Time now, bool open) {
  if (!connected_) return false;
  last_request_ = now;
  set_coil(now, open);
  return true;
}

void ValveHardware::advance(Time now) {
  if (last_request_ && (now - *last_request_).to_seconds() > kWatchdog_s) set_coil(now, false);
  const double delay_s = trouble_ == ValveTrouble::kSlow ? kSlow_s : kDelay_s;
  if ((now - coil_since_).to_seconds() >= delay_s) flow_ = coil_;
}

bool ValveHardware::flowing() const {
  switch (trouble_) {
    case ValveTrouble::kNone:
    case ValveTrouble::kSlow:
      return flow_;
    case ValveTrouble::kStuckOpen:
    case ValveTrouble::kLeaking:
      return true;
    case ValveTrouble::kStuckShut:
    case ValveTrouble::kBlocked:
      return false;
  }
  return false;
}

Status ValveClient::write(Time time, bool open) {
  const bool fresh = written_ && (time - *written_).to_seconds() < kRefresh_s;
  if (fresh && level_ == open) return {};
  if (!hardware_.request(time, open)) {
    written_.reset();
    return Error{ErrorCode::kUnavailable, "the module does not answer"};
  }
  written_ = time;
  level_ = open;
  return {};
}

}  // namespace furrow::actuation::campaign
