#include "rate_meter.hpp"

namespace furrow::cli {

void RateMeter::add(Time now, std::size_t bytes) {
  if (!entries_.empty()) last_period_ = now - entries_.back().time;
  entries_.push_back({now, bytes});
  while (now - entries_.front().time > window_) entries_.pop_front();
  if (messages_ < kTries) ++messages_;
  had_rate_ = had_rate_ || entries_.size() > 1;
}

std::optional<RateMeter::Rate> RateMeter::rate() const {
  if (entries_.size() < 2) return std::nullopt;
  const double span_s = (entries_.back().time - entries_.front().time).to_seconds();
  if (span_s <= 0.0) return std::nullopt;
  // The first message only opens the span.
  const auto messages = static_cast<double>(entries_.size() - 1);
  double bytes = 0.0;
  for (std::size_t i = 1; i < entries_.size(); ++i) bytes += static_cast<double>(entries_[i].bytes);
  return Rate{.hz = messages / span_s,
              .bytes_per_s = bytes / span_s,
              .mean_bytes = bytes / messages,
              .span_s = span_s};
}

std::optional<Duration> RateMeter::period_beyond_window() const {
  if (had_rate_ || messages_ < kTries) return std::nullopt;
  return last_period_;
}

}  // namespace furrow::cli
