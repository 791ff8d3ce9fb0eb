#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace furrow::cli {

/// A bar that is drawn anew on a terminal; in a log, a line at every tenth. On standard error, so
/// that what a command prints can be piped. Not thread-safe.
class ProgressBar {
 public:
  explicit ProgressBar(std::string_view label);
  /// `fraction` in [0, 1]; `detail` stands behind the bar.
  void show(double fraction, std::string_view detail);
  /// Ends the line.
  void finish();

 private:
  std::string label_;
  bool terminal_;
  int last_ = -1;
  bool open_ = false;
};

/// A bar for each stage of the work, one after the other.
class StagedProgress {
 public:
  /// `fraction` in [0, 1] of this stage.
  void show(const std::string& stage, double fraction);
  void finish();

 private:
  std::string stage_;
  std::optional<ProgressBar> bar_;
};

}  // namespace furrow::cli
