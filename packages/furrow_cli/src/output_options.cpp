#include "output_options.hpp"

#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "furrow_core/error.hpp"

namespace furrow::cli {
namespace {

template <class Output>
Output checked(Result<Output> claimed, const std::string& wanted, const std::string& option) {
  if (!claimed.ok()) throw ConfigError(option + ": " + claimed.error().message);
  if (claimed->numbered()) {
    std::cerr << "furrow: " << wanted << " exists with results: writing to "
              << claimed->path().string() << " instead (--force overwrites)\n";
  }
  return std::move(claimed).value();
}

void write_and_name(std::optional<OutputFile>& file, const std::string& content) {
  if (!file) return;
  write_or_throw(*file, content);
  std::cout << file->path().string() << '\n';
}

}  // namespace

void add_force_option(Command command, bool& force) {
  command.flag("--force", force, "overwrite earlier results in place of a numbered name");
}

OutputFolder claim_folder(const std::string& path, const std::vector<std::string_view>& results,
                          bool force, const std::string& option) {
  const auto overwrite = force ? Overwrite::kYes : Overwrite::kNo;
  return checked(OutputFolder::claim(path, results, overwrite), path, option);
}

OutputFile claim_file(const std::string& path, bool force, const std::string& option) {
  const auto overwrite = force ? Overwrite::kYes : Overwrite::kNo;
  return checked(OutputFile::claim(path, overwrite), path, option);
}

void write_or_throw(OutputFile& file, const std::string& content) {
  if (const Status written = file.write(content); !written) {
    throw std::runtime_error(written.error().message);
  }
}

void add_result_options(Command command, ResultOptions& options, bool html) {
  command.option("--json", options.json, "file for the results");
  if (html) command.option("--html", options.html, "file for the report");
  add_force_option(command, options.force);
}

ResultFiles::ResultFiles(const ResultOptions& options) {
  if (!options.json.empty()) json_ = claim_file(options.json, options.force, "--json");
  if (!options.html.empty()) html_ = claim_file(options.html, options.force, "--html");
}

void ResultFiles::write_json(const std::string& content) {
  write_and_name(json_, content);
}

void ResultFiles::write_html(const std::string& content) {
  write_and_name(html_, content);
}

}  // namespace furrow::cli
