#include "console.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace furrow::cli {

ProgressBar::ProgressBar(std::string_view label)
    : label_(label), terminal_(::isatty(STDERR_FILENO) == 1) {}

void ProgressBar::show(double fraction, std::string_view detail) {
  const int percent = static_cast<int>(100.0 * std::clamp(fraction, 0.0, 1.0));
  if (terminal_) {
    constexpr int kWidth = 30;
    const int filled = percent * kWidth / 100;
    const std::string bar = std::string(static_cast<std::size_t>(filled), '=') +
                            std::string(static_cast<std::size_t>(kWidth - filled), ' ');
    std::fprintf(stderr, "\r%s [%s] %3d %% %.*s\033[K", label_.c_str(), bar.c_str(), percent,
                 static_cast<int>(detail.size()), detail.data());
    open_ = true;
  } else if (percent / 10 != last_ / 10 || last_ < 0) {
    std::fprintf(stderr, "%s %d %% %.*s\n", label_.c_str(), percent,
                 static_cast<int>(detail.size()), detail.data());
  }
  last_ = percent;
}

void ProgressBar::finish() {
  if (open_) std::fputs("\n", stderr);
  open_ = false;
}

void StagedProgress::show(const std::string& stage, double fraction) {
  if (!bar_ || stage != stage_) {
    finish();
    stage_ = stage;
    bar_.emplace(stage);
  }
  bar_->show(fraction, "");
}

void StagedProgress::finish() {
  if (bar_) bar_->finish();
  bar_.reset();
}

}  // namespace furrow::cli
