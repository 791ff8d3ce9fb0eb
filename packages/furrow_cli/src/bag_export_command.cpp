#include <iostream>
#include <memory>

#include "commands.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/text.hpp"
#include "furrow_recording/recording_export.hpp"

namespace furrow::cli {
namespace {

struct BagExportOptions {
  std::string input;
  std::string folder;
  double to_s = 0.0;
  recording::ExportOptions selection;
};

int report_export(const BagExportOptions& options, const recording::ExportReport& report) {
  std::vector<std::vector<std::string>> rows = {{"topic", "file", "written", "left out"}};
  for (const recording::ExportedTopic& topic : report.topics) {
    rows.push_back({topic.name, topic.file.empty() ? "-" : topic.file,
                    std::to_string(topic.written), std::to_string(topic.left_out)});
  }
  std::cout << text_table(rows);
  if (report.images > 0) std::cout << report.images << " images, listed in frames.json\n";
  std::cout << options.folder << '\n';
  if (!report.damage.empty())
    std::cerr << "furrow: the recording is not whole: " << report.damage << '\n';
  for (const std::string& fault : report.faults) std::cerr << "furrow: left out: " << fault << '\n';
  for (const recording::ExportedTopic& topic : report.topics) {
    if (topic.left_out == 0) continue;
    std::cerr << "furrow: " << topic.name << ": " << topic.left_out
              << " messages are not exported: " << topic.reason << '\n';
  }
  for (const std::string& pattern : report.unmatched_includes) {
    std::cerr << "furrow: --topics: no topic matches '" << pattern << "'\n";
  }
  return report.complete() ? 0 : 1;
}

int bag_export(BagExportOptions options) {
  if (options.to_s > 0.0) {
    if (options.to_s <= options.selection.from_s) {
      throw ConfigError("--to: must be later than --from");
    }
    options.selection.to_s = options.to_s;
  }
  const auto reader = recording::open_recording(options.input);
  if (!reader) throw ConfigError(reader.error().message);
  const auto report = recording::export_recording(**reader, options.folder, options.selection);
  if (report) return report_export(options, *report);
  if (report.error().code == ErrorCode::kIo) throw std::runtime_error(report.error().message);
  throw ConfigError(options.input + ": " + report.error().message);
}

}  // namespace

void add_bag_export_command(Command root) {
  auto options = std::make_shared<BagExportOptions>();
  Command command = bag_group(root).subcommand(
      "export", "Writes images as PNG with a COCO list, and other topics as CSV.");
  command.option("in", options->input, "recording of any format").required();
  command.option("--out", options->folder, "folder to make; must not exist").required();
  command.option("--topics", options->selection.topics.include,
                 "names or patterns to export; default: all");
  command.option("--exclude", options->selection.topics.exclude, "names or patterns not to export");
  command.option("--from", options->selection.from_s, "start, s from the first message, included")
      .range(0.0, 1e9);
  command.option("--to", options->to_s, "end, s from the first message, excluded; 0: all")
      .range(0.0, 1e9);
  command.on_run([options] { return bag_export(*options); });
}

}  // namespace furrow::cli
