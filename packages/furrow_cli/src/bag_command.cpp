#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "command.hpp"
#include "console.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/file.hpp"
#include "furrow_recording/mcap_tools.hpp"
#include "furrow_recording/topic_description.hpp"
#include "furrow_recording/topic_filter.hpp"

namespace furrow::cli {
namespace {

struct BagOptions {
  std::vector<std::string> files;
  std::string in;
  std::string out;
  std::string json;
  std::string compression = "zstd";
  recording::TopicFilter topics;
  double from_s = 0.0;
  double to_s = 0.0;
  bool no_latched = false;
};

std::unique_ptr<mcap::Source> open_source(const std::string& file) {
  auto source = mcap::open_file(file);
  if (!source) throw ConfigError(source.error().message);
  return std::move(source).value();
}

/// By the summary; where that is damaged, by going through the file.
mcap::Reader open_reader(const std::string& file) {
  auto reader = mcap::Reader::open(open_source(file));
  if (!reader) reader = mcap::Reader::scan(open_source(file));
  if (!reader) throw ConfigError(file + ": " + reader.error().message);
  return std::move(reader).value();
}

mcap::WriterOptions writer_options(const std::string& compression) {
  mcap::WriterOptions options;
  options.compression = compression == "none"  ? mcap::Compression::kNone
                        : compression == "lz4" ? mcap::Compression::kLz4
                                               : mcap::Compression::kZstd;
  return options;
}

std::string quality(const recording::TopicDescription& topic) {
  if (topic.offered_qos.empty()) return "-";
  const bool reliable = topic.offered_qos.front().reliability == msgs::Reliability::kReliable;
  return std::string(reliable ? "reliable" : "best effort") + (topic.latched() ? ", latched" : "");
}

std::string compression_of(const mcap::Summary& summary) {
  std::set<std::string> names;
  for (const mcap::ChunkIndex& chunk : summary.chunks) {
    names.insert(chunk.compression.empty() ? "none" : chunk.compression);
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "-" : text;
}

nlohmann::ordered_json topic_row(const mcap::Summary& summary, const mcap::Channel& channel,
                                 double duration_s) {
  const auto schema = summary.schemas.find(channel.schema_id);
  const auto topic = recording::describe_channel(
      channel, schema == summary.schemas.end() ? nullptr : &schema->second);
  const auto& counts = summary.statistics->channel_message_counts;
  const auto count = counts.find(channel.id);
  const std::uint64_t messages = count == counts.end() ? 0 : count->second;
  return {{"topic", topic.name},
          {"type", topic.type_name},
          {"messages", messages},
          {"rate_hz", duration_s > 0.0 ? static_cast<double>(messages) / duration_s : 0.0},
          {"schema", topic.schema_encoding},
          {"encoding", topic.message_encoding},
          {"qos", quality(topic)}};
}

nlohmann::ordered_json describe(const std::string& file, const mcap::Reader& reader) {
  const mcap::Summary& summary = reader.summary();
  const mcap::Statistics& statistics = *summary.statistics;
  const double duration_s = (statistics.end_time - statistics.start_time).to_seconds();
  nlohmann::ordered_json json = {{"file", file},
                                 {"bytes", std::filesystem::file_size(file)},
                                 {"profile", reader.header().profile},
                                 {"library", reader.header().library},
                                 {"start_s", statistics.start_time.to_seconds()},
                                 {"duration_s", duration_s},
                                 {"messages", statistics.message_count},
                                 {"chunks", statistics.chunk_count},
                                 {"compression", compression_of(summary)},
                                 {"attachments", summary.attachments.size()},
                                 {"damage", reader.damage()},
                                 {"topics", nlohmann::ordered_json::array()}};
  for (const auto& [id, channel] : summary.channels) {
    json["topics"].push_back(topic_row(summary, channel, duration_s));
  }
  return json;
}

void print(const nlohmann::ordered_json& file) {
  std::cout << file["file"].get<std::string>() << '\n'
            << "  " << number(file["bytes"].get<double>() * 1e-6, 3) << " MB, "
            << number(file["duration_s"].get<double>(), 3) << " s from "
            << number(file["start_s"].get<double>(), 3) << ", " << file["messages"] << " messages, "
            << file["chunks"] << " chunks (" << file["compression"].get<std::string>()
            << "), profile " << file["profile"].get<std::string>() << ", by "
            << file["library"].get<std::string>() << '\n';
  if (const std::string damage = file["damage"]; !damage.empty()) {
    std::cout << "  damaged: " << damage << '\n';
  }
  std::vector<std::vector<std::string>> rows = {
      {"topic", "type", "messages", "Hz", "schema", "quality"}};
  for (const auto& topic : file["topics"]) {
    rows.push_back({topic["topic"], topic["type"], topic["messages"].dump(),
                    number(topic["rate_hz"].get<double>(), 2), topic["schema"], topic["qos"]});
  }
  std::cout << text_table(rows);
}

int info(const BagOptions& options) {
  nlohmann::ordered_json json = {{"rows", nlohmann::ordered_json::array()}};
  bool damaged = false;
  for (const std::string& file : options.files) {
    const mcap::Reader reader = open_reader(file);
    json["rows"].push_back(describe(file, reader));
    damaged = damaged || !reader.damage().empty();
    print(json["rows"].back());
  }
  json["version"] = FURROW_VERSION;
  if (!options.json.empty()) {
    if (const Status written = write_file_atomically(options.json, json.dump(2) + "\n"); !written) {
      throw std::runtime_error(written.error().message);
    }
  }
  return damaged ? 1 : 0;
}

int verify(const BagOptions& options) {
  bool sound = true;
  for (const std::string& file : options.files) {
    const auto source = open_source(file);
    const auto report = mcap::verify(*source);
    if (!report) throw std::runtime_error(file + ": " + report.error().message);
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

std::unique_ptr<mcap::Sink> create_target(const BagOptions& options) {
  auto sink = mcap::create_file(options.out);
  if (!sink) throw ConfigError(sink.error().message);
  return std::move(sink).value();
}

int finish(const BagOptions& options, const Result<mcap::CopyReport>& report) {
  if (!report) {
    std::error_code ignored;
    std::filesystem::remove(options.out, ignored);
    if (report.error().code == ErrorCode::kIo) throw std::runtime_error(report.error().message);
    throw ConfigError(options.in + ": " + report.error().message);
  }
  for (const std::string& fault : report->faults) std::cout << "left out: " << fault << '\n';
  if (report->bytes_ignored > 0) {
    std::cout << "left out: " << report->bytes_ignored << " bytes at the end\n";
  }
  std::cout << options.out << ": " << report->messages << " messages\n";
  return 0;
}

int recover(const BagOptions& options) {
  auto source = open_source(options.in);
  auto sink = create_target(options);
  return finish(options, mcap::recover(std::move(source), std::move(sink),
                                       writer_options(options.compression)));
}

int cut(const BagOptions& options) {
  mcap::CutOptions cut;
  {
    const mcap::Reader reader = open_reader(options.in);
    const mcap::Statistics& statistics = *reader.summary().statistics;
    const double length_s = (statistics.end_time - statistics.start_time).to_seconds();
    if (options.from_s > length_s) {
      throw ConfigError("--from: the recording is only " + number(length_s, 3) + " s long");
    }
    if (options.to_s > 0.0 && options.to_s <= options.from_s) {
      throw ConfigError("--to: must be later than --from");
    }
    cut.read.begin = statistics.start_time + Duration::seconds(options.from_s);
    if (options.to_s > 0.0) {
      cut.read.end = statistics.start_time + Duration::seconds(options.to_s);
    }
  }
  const auto accepts = [topics = options.topics](const mcap::Channel& channel) {
    return topics.accepts(recording::topic_from_file(channel.topic));
  };
  cut.read.accept = accepts;
  if (!options.no_latched) {
    cut.latched = [accepts](const mcap::Channel& channel) {
      return accepts(channel) && recording::describe_channel(channel, nullptr).latched();
    };
  }
  auto source = open_source(options.in);
  auto sink = create_target(options);
  return finish(options, mcap::cut(std::move(source), std::move(sink), cut,
                                   writer_options(options.compression)));
}

void add_copy_options(CLI::App* command, BagOptions& options) {
  command->add_option("in", options.in, "MCAP file")->required();
  command->add_option("out", options.out, "file to write; must not exist")->required();
  command->add_option("--compression", options.compression, "of chunks")
      ->check(CLI::IsMember({"none", "lz4", "zstd"}))
      ->capture_default_str();
}

}  // namespace

void add_bag_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("bag", "Looks at recordings, checks and mends them.");
  command->require_subcommand(1);
  auto options = std::make_shared<BagOptions>();
  CLI::App* info_command =
      command->add_subcommand("info", "Topics, times, types and sizes. Exit 1: damaged.");
  info_command->add_option("files", options->files, "MCAP files")->required();
  info_command->add_option("--json", options->json, "file of the results");
  info_command->callback([options, &exit_code] { exit_code = info(*options); });
  CLI::App* verify_command = command->add_subcommand(
      "verify", "Goes through every byte: structure, CRCs, indexes. Exit 1: faults.");
  verify_command->add_option("files", options->files, "MCAP files")->required();
  verify_command->callback([options, &exit_code] { exit_code = verify(*options); });
  CLI::App* recover_command = command->add_subcommand(
      "recover", "Writes a whole file from what can be read of a damaged one.");
  add_copy_options(recover_command, *options);
  recover_command->callback([options, &exit_code] { exit_code = recover(*options); });
  CLI::App* cut_command = command->add_subcommand("cut", "Copies a time range and some topics.");
  add_copy_options(cut_command, *options);
  cut_command->add_option("--from", options->from_s, "seconds from the first message, included")
      ->check(CLI::Range(0.0, 1e9));
  cut_command->add_option("--to", options->to_s, "seconds, excluded; 0: to the end")
      ->check(CLI::Range(0.0, 1e9));
  cut_command->add_option("--topics", options->topics.include, "names or patterns to copy")
      ->take_all();
  cut_command->add_option("--exclude", options->topics.exclude, "names or patterns to leave out")
      ->take_all();
  cut_command->add_flag("--no-latched", options->no_latched,
                        "leave out what late joiners would get at the beginning");
  cut_command->callback([options, &exit_code] { exit_code = cut(*options); });
}

}  // namespace furrow::cli
