// The verbs of "furrow bag" that write a recording: one copy with different options each.
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "furrow_core/error.hpp"
#include "furrow_recording/recording_copy.hpp"

namespace furrow::cli {
namespace {

struct BagCopyOptions {
  std::string input;                ///< of all verbs but merge
  std::vector<std::string> inputs;  ///< of merge
  std::string output;
  std::string compression = "zstd";
  int level = 1;
  std::int64_t chunk_kb = 1024;
  double to_s = 0.0;
  bool no_latched = false;
  bool repairs = false;  ///< damage of the input is what the verb is for
  recording::Selection selection;
};

mcap::Compression compression_named(const std::string& name) {
  if (name == "none") return mcap::Compression::kNone;
  return name == "lz4" ? mcap::Compression::kLz4 : mcap::Compression::kZstd;
}

int report_copy(const BagCopyOptions& options, const recording::CopyReport& report) {
  for (const std::string& note : report.notes) std::cout << "note: " << note << '\n';
  for (const std::string& fault : report.faults) std::cout << "left out: " << fault << '\n';
  if (!report.damage.empty()) std::cout << "the input is not whole: " << report.damage << '\n';
  if (report.bytes_ignored > 0) {
    std::cout << "left out: " << report.bytes_ignored << " bytes at the end\n";
  }
  for (const std::string& pattern : report.unmatched_includes) {
    std::cerr << "furrow: --topics: no topic matches '" << pattern << "'\n";
  }
  for (const std::string& pattern : report.unmatched_excludes) {
    std::cerr << "furrow: --exclude: no topic matches '" << pattern << "'\n";
  }
  const bool empty = report.messages == 0 && report.messages_in > 0;
  if (empty) std::cerr << "furrow: no message of the recording was selected\n";
  std::cout << options.output << ": " << report.messages << " messages, " << report.attachments
            << " attachments, " << report.metadata << " metadata records\n";
  const bool complete = options.repairs || report.complete();
  return complete && !empty ? 0 : 1;
}

int bag_copy(const BagCopyOptions& options) {
  recording::CopyJob job;
  job.inputs.assign(options.inputs.begin(), options.inputs.end());
  if (!options.input.empty()) job.inputs.emplace_back(options.input);
  job.output = options.output;
  job.selection = options.selection;
  job.selection.latched = !options.no_latched;
  if (options.to_s > 0.0) {
    if (options.to_s <= options.selection.from_s) {
      throw ConfigError("--to: must be later than --from");
    }
    job.selection.to_s = options.to_s;
  }
  job.writer.compression = compression_named(options.compression);
  job.writer.zstd_level = options.level;
  job.writer.chunk_bytes = static_cast<std::size_t>(options.chunk_kb) * 1000;
  job.open.scan = options.repairs;
  const auto report = recording::run_copy(job);
  if (report) return report_copy(options, *report);
  if (report.error().code == ErrorCode::kIo) throw std::runtime_error(report.error().message);
  throw ConfigError(report.error().message);
}

/// Adds a command from one recording to one file, with the options that all of them have.
Command add_bag_copy_command(Command group, const std::string& name, const std::string& description,
                             const std::shared_ptr<BagCopyOptions>& options) {
  Command command = group.subcommand(name, description);
  command.option("in", options->input, "recording of any format").required();
  command.option("out", options->output, "MCAP file to write; must not exist").required();
  command.option("--compression", options->compression, "compression of the chunks")
      .choices({"none", "lz4", "zstd"});
  command.option("--level", options->level, "of zstd: 1 is fast, 19 is small").range(1, 19);
  command.on_run([options] { return bag_copy(*options); });
  return command;
}

void add_bag_topic_options(Command command, BagCopyOptions& options) {
  command.option("--topics", options.selection.topics.include,
                 "names or patterns to copy; default: all");
  command.option("--exclude", options.selection.topics.exclude, "names or patterns not to copy");
}

void add_bag_recover_command(Command group) {
  auto options = std::make_shared<BagCopyOptions>();
  options->repairs = true;
  add_bag_copy_command(group, "recover",
                       "Writes a sound file from what can be read of a damaged one.", options);
}

void add_bag_cut_command(Command group) {
  auto options = std::make_shared<BagCopyOptions>();
  Command command =
      add_bag_copy_command(group, "cut", "Copies a time range and some topics.", options);
  add_bag_topic_options(command, *options);
  command.option("--from", options->selection.from_s, "start, s from the first message, included")
      .range(0.0, 1e9);
  command.option("--to", options->to_s, "end, s from the first message, excluded; 0: all")
      .range(0.0, 1e9);
  command.flag("--no-latched", options->no_latched, "leave out earlier messages of latched topics");
}

void add_bag_filter_command(Command group) {
  auto options = std::make_shared<BagCopyOptions>();
  Command command = add_bag_copy_command(group, "filter",
                                         "Copies some topics, or fewer messages of each.", options);
  add_bag_topic_options(command, *options);
  command
      .option("--max-hz", options->selection.max_hz,
              "most messages per second and topic, but all of latched topics; 0: all")
      .range(0.0, 1e6);
}

void add_bag_convert_command(Command group) {
  auto options = std::make_shared<BagCopyOptions>();
  Command command =
      add_bag_copy_command(group, "convert", "Writes a recording of any format as MCAP.", options);
  add_bag_topic_options(command, *options);
}

void add_bag_compress_command(Command group) {
  auto options = std::make_shared<BagCopyOptions>();
  Command command = add_bag_copy_command(group, "compress",
                                         "Writes a recording with another compression.", options);
  command.option("--chunk-kb", options->chunk_kb, "size of a chunk before compression, kB")
      .range(4, 65536);
}

void add_bag_merge_command(Command group) {
  auto options = std::make_shared<BagCopyOptions>();
  Command command =
      group.subcommand("merge", "Writes several recordings of one clock as one, by time.");
  command.option("in", options->inputs, "recordings of any format").required();
  command.option("--out", options->output, "MCAP file to write; must not exist").required();
  command.option("--compression", options->compression, "compression of the chunks")
      .choices({"none", "lz4", "zstd"});
  add_bag_topic_options(command, *options);
  command.on_run([options] {
    if (options->inputs.size() < 2) throw ConfigError("merge: give at least two recordings");
    return bag_copy(*options);
  });
}

}  // namespace

void add_bag_copy_commands(Command root) {
  const Command group = bag_group(root);
  add_bag_recover_command(group);
  add_bag_cut_command(group);
  add_bag_filter_command(group);
  add_bag_convert_command(group);
  add_bag_compress_command(group);
  add_bag_merge_command(group);
}

}  // namespace furrow::cli
