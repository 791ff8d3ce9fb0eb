#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "commands.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/text.hpp"
#include "furrow_core/version.hpp"
#include "furrow_recording/mcap_tools.hpp"
#include "furrow_recording/topic_description.hpp"
#include "furrow_recording/topic_filter.hpp"
#include "output_options.hpp"

namespace furrow::cli {
namespace {

struct BagOptions {
  std::vector<std::string> files;
  std::string in;
  std::string out;
  ResultOptions results;
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
            << "  " << fixed(file["bytes"].get<double>() * 1e-6, 3) << " MB, "
            << fixed(file["duration_s"].get<double>(), 3) << " s from "
            << fixed(file["start_s"].get<double>(), 3) << ", " << file["messages"] << " messages, "
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
                    fixed(topic["rate_hz"].get<double>(), 2), topic["schema"], topic["qos"]});
  }
  std::cout << text_table(rows);
}

int info(const BagOptions& options) {
  ResultFiles files(options.results);
  nlohmann::ordered_json json = {{"rows", nlohmann::ordered_json::array()}};
  bool damaged = false;
  for (const std::string& file : options.files) {
    const mcap::Reader reader = open_reader(file);
    json["rows"].push_back(describe(file, reader));
    damaged = damaged || !reader.damage().empty();
    print(json["rows"].back());
  }
  json["version"] = version();
  files.write_json(json.dump(2) + "\n");
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
      throw ConfigError("--from: the recording is only " + fixed(length_s, 3) + " s long");
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

void add_copy_options(Command command, BagOptions& options) {
  command.option("in", options.in, "MCAP file").required();
  command.option("out", options.out, "file to write; must not exist").required();
  command.option("--compression", options.compression, "compression of the chunks")
      .choices({"none", "lz4", "zstd"});
}

void add_cut_command(Command group) {
  auto options = std::make_shared<BagOptions>();
  Command command = group.subcommand("cut", "Copies a time range and some topics.");
  add_copy_options(command, *options);
  command.option("--from", options->from_s, "start, s from the first message, included")
      .range(0.0, 1e9);
  command.option("--to", options->to_s, "end, s from the first message, excluded; 0: all")
      .range(0.0, 1e9);
  command.option("--topics", options->topics.include, "names or patterns to copy; default: all");
  command.option("--exclude", options->topics.exclude, "names or patterns not to copy");
  command.flag("--no-latched", options->no_latched, "leave out earlier messages of latched topics");
  command.on_run([options] { return cut(*options); });
}

}  // namespace

void add_bag_commands(Command root) {
  Command group = root.group("bag", "Inspects, checks and repairs recordings.");
  auto options = std::make_shared<BagOptions>();
  Command info_command =
      group.subcommand("info", "Shows topics, times, types and sizes. Exit code 1: damaged.");
  info_command.option("files", options->files, "MCAP files").required();
  add_result_options(info_command, options->results, false);
  info_command.on_run([options] { return info(*options); });

  Command verify_command = group.subcommand(
      "verify", "Checks every byte: structure, CRCs, indexes. Exit code 1: faults.");
  verify_command.option("files", options->files, "MCAP files").required();
  verify_command.on_run([options] { return verify(*options); });

  Command recover_command =
      group.subcommand("recover", "Writes a sound file from what can be read of a damaged one.");
  add_copy_options(recover_command, *options);
  recover_command.on_run([options] { return recover(*options); });
  add_cut_command(group);
}

}  // namespace furrow::cli
