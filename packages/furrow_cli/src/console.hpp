#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace furrow::cli {

/// A bar that is drawn anew on a terminal; in a log, a line at every tenth. On standard error, so
/// that what a verb prints can be piped. Not thread-safe.
class ProgressBar {
 public:
  explicit ProgressBar(std::string_view label);
  /// `fraction` in [0, 1]; `detail` stands behind the bar.
  void show(double fraction, std::string_view detail);
  /// Leaves the line.
  void finish();

 private:
  std::string label_;
  bool terminal_;
  int last_ = -1;
  bool open_ = false;
};

/// Columns of text, the first left and the others right aligned.
[[nodiscard]] std::string text_table(const std::vector<std::vector<std::string>>& rows);

/// With a fixed number of decimals.
[[nodiscard]] std::string number(double value, int decimals);

}  // namespace furrow::cli
