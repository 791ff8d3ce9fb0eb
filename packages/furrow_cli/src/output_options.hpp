#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command_line.hpp"
#include "furrow_core/output_path.hpp"

namespace furrow::cli {

// The options of all commands that write results, over the policy of furrow_core/output_path.hpp.

/// Adds --force.
void add_force_option(Command command, bool& force);

/// Claims a folder for results before the work begins, and says on standard error when it is
/// another one than asked for. Throws ConfigError that names `option`.
[[nodiscard]] OutputFolder claim_folder(const std::string& path,
                                        const std::vector<std::string_view>& results, bool force,
                                        const std::string& option = "--out");
/// The same for a file.
[[nodiscard]] OutputFile claim_file(const std::string& path, bool force,
                                    const std::string& option = "--out");

/// Writes the file; throws std::runtime_error when that fails.
void write_or_throw(OutputFile& file, const std::string& content);

/// The files that most experiments and benchmarks offer.
struct ResultOptions {
  std::string json;  ///< empty: none
  std::string html;  ///< empty: none
  bool force = false;
};

/// Adds --json, --force and, with `html`, --html.
void add_result_options(Command command, ResultOptions& options, bool html);

/// The files of ResultOptions. Construct it before the work begins.
class ResultFiles {
 public:
  /// Throws ConfigError for a file that cannot be written.
  explicit ResultFiles(const ResultOptions& options);
  [[nodiscard]] bool wants_html() const { return html_.has_value(); }
  /// Writes the file if it was asked for, and prints its name. Throws std::runtime_error when that
  /// fails.
  void write_json(const std::string& content);
  void write_html(const std::string& content);

 private:
  std::optional<OutputFile> json_;
  std::optional<OutputFile> html_;
};

}  // namespace furrow::cli
