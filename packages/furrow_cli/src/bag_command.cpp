#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/text.hpp"
#include "furrow_core/version.hpp"
#include "furrow_recording/recording_summary.hpp"
#include "output_options.hpp"

namespace furrow::cli {
namespace {

using RecordingJson = nlohmann::ordered_json;

struct BagOptions {
  std::vector<std::string> files;
  ResultOptions results;
};

std::string compressions_of(const recording::RecordingInfo& info) {
  std::string text;
  for (const std::string& name : info.compressions) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "-" : text;
}

RecordingJson describe_recording(const std::string& file, const recording::RecordingInfo& info) {
  const mcap::Statistics& statistics = info.statistics();
  const double duration_s = (statistics.end_time - statistics.start_time).to_seconds();
  RecordingJson json = {{"file", file},
                        {"format", info.format},
                        {"bytes", info.bytes},
                        {"profile", info.profile},
                        {"library", info.library},
                        {"start_s", statistics.start_time.to_seconds()},
                        {"duration_s", duration_s},
                        {"messages", statistics.message_count},
                        {"chunks", statistics.chunk_count},
                        {"compression", compressions_of(info)},
                        {"attachments", info.summary.attachments.size()},
                        {"metadata", info.summary.metadata.size()},
                        {"damage", info.damage},
                        {"faults", info.faults},
                        {"notes", info.notes},
                        {"topics", RecordingJson::array()}};
  for (const recording::TopicSummary& topic : recording::summarize_topics(info)) {
    json["topics"].push_back({{"topic", topic.topic},
                              {"type", topic.type},
                              {"messages", topic.messages},
                              {"rate_hz", topic.rate_hz},
                              {"schema", topic.schema},
                              {"encoding", topic.encoding},
                              {"qos", topic.quality},
                              {"channels", topic.channels}});
  }
  return json;
}

void print_recording(const RecordingJson& file) {
  std::cout << file["file"].get<std::string>() << '\n'
            << "  " << fixed(file["bytes"].get<double>() * 1e-6, 3) << " MB of "
            << file["format"].get<std::string>() << ", "
            << fixed(file["duration_s"].get<double>(), 3) << " s from "
            << fixed(file["start_s"].get<double>(), 3) << ", " << file["messages"] << " messages, "
            << file["chunks"] << " chunks (" << file["compression"].get<std::string>() << "), "
            << file["attachments"] << " attachments, " << file["metadata"]
            << " metadata records, profile '" << file["profile"].get<std::string>() << "', by '"
            << file["library"].get<std::string>() << "'\n";
  if (const std::string damage = file["damage"]; !damage.empty()) {
    std::cout << "  damaged: " << damage << '\n';
  }
  for (const auto& fault : file["faults"]) {
    std::cout << "  damaged: " << fault.get<std::string>() << '\n';
  }
  for (const auto& note : file["notes"]) std::cout << "  note: " << note.get<std::string>() << '\n';
  std::vector<std::vector<std::string>> rows = {
      {"topic", "type", "messages", "Hz", "schema", "encoding", "quality"}};
  for (const auto& topic : file["topics"]) {
    rows.push_back({topic["topic"], topic["type"], topic["messages"].dump(),
                    fixed(topic["rate_hz"].get<double>(), 2), topic["schema"], topic["encoding"],
                    topic["qos"]});
  }
  std::cout << text_table(rows);
}

int bag_info(const BagOptions& options) {
  ResultFiles files(options.results);
  RecordingJson json = {{"rows", RecordingJson::array()}};
  bool whole = true;
  for (const std::string& file : options.files) {
    const auto reader = recording::open_recording(file);
    if (!reader) throw ConfigError(reader.error().message);
    json["rows"].push_back(describe_recording(file, (*reader)->info()));
    whole = whole && (*reader)->info().whole();
    print_recording(json["rows"].back());
  }
  json["version"] = version();
  // Names in a recording may be any bytes.
  files.write_json(json.dump(2, ' ', false, RecordingJson::error_handler_t::replace) + "\n");
  return whole ? 0 : 1;
}

int bag_verify(const BagOptions& options) {
  bool sound = true;
  for (const std::string& file : options.files) {
    const auto report = recording::verify_recording(file);
    if (!report) throw ConfigError(report.error().message);
    for (const std::string& fault : report->faults) std::cout << file << ": " << fault << '\n';
    const bool well = report->faults.empty() && report->closed;
    sound = sound && well;
    std::cout << file << ": "
              << (well             ? "sound"
                  : report->closed ? "damaged"
                                   : "not closed")
              << ", " << report->messages << " messages, " << report->chunks << " chunks, "
              << report->bytes << " bytes\n";
  }
  return sound ? 0 : 1;
}

}  // namespace

void add_bag_commands(Command root) {
  Command group = bag_group(root);
  auto options = std::make_shared<BagOptions>();
  Command info =
      group.subcommand("info", "Shows topics, times, types and sizes. Exit code 1: damaged.");
  info.option("recordings", options->files, "files or rosbag2 folders").required();
  add_result_options(info, options->results, false);
  info.on_run([options] { return bag_info(*options); });

  Command verify = group.subcommand(
      "verify", "Checks every byte: structure, CRCs, indexes. Exit code 1: faults.");
  verify.option("recordings", options->files, "files or rosbag2 folders").required();
  verify.on_run([options] { return bag_verify(*options); });
}

}  // namespace furrow::cli
