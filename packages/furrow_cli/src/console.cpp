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

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - row[i].size(), ' ');
      text += i == 0 ? row[i] + padding : "  " + padding + row[i];
    }
    text += '\n';
  }
  return text;
}

std::string number(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

}  // namespace furrow::cli
