#include <chrono>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <stdexcept>

#include "command.hpp"
#include "console.hpp"
#include "furrow_core/file.hpp"
#include "furrow_core/statistics.hpp"
#include "furrow_vision/metrics.hpp"
#include "scratch_folder.hpp"
#include "verb.hpp"
#include "vision_datasets.hpp"
#include "vision_options.hpp"

namespace furrow::cli {
namespace {

struct BenchVisionOptions {
  VisionOptions vision;
  std::int64_t frames = 30;
  std::uint64_t seed = 1;
  int threads = 2;
  std::string json;
};

struct BenchVisionRow {
  std::string detector;
  cv::Size size;
  double ms_p50 = 0.0;
  double ms_p99 = 0.0;
  double rss_mb = 0.0;
};

/// Resident memory of this process now.
double resident_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024.0;
  }
  return 0.0;
}

void measure(const VisionOptions& options, cv::Size size, std::vector<LoadedImage>& images,
             std::int64_t frames, std::vector<BenchVisionRow>& rows) {
  // One detector at a time, so that the memory is its own.
  for (std::size_t k = 0; k < make_detectors(options).size(); ++k) {
    auto detectors = make_detectors(options);
    const NamedDetector named = std::move(detectors[k]);
    detectors.clear();
    std::vector<double> ms;
    for (std::int64_t i = -2; i < frames; ++i) {  // the first two warm up
      const LoadedImage& image = images[static_cast<std::size_t>(i + 2) % images.size()];
      const auto start = std::chrono::steady_clock::now();
      const auto found = named.detector->detect(image.view());
      const std::chrono::duration<double, std::milli> took =
          std::chrono::steady_clock::now() - start;
      if (!found.ok()) throw std::runtime_error(found.error().message);
      if (i >= 0) ms.push_back(took.count());
    }
    rows.push_back({named.name, size, quantile(ms, 0.5), quantile(ms, 0.99), resident_mb()});
  }
}

void bench(const BenchVisionOptions& options) {
  cv::setNumThreads(options.threads);
  std::vector<BenchVisionRow> rows;
  constexpr std::int64_t kPictures = 3;
  for (const cv::Size size : {cv::Size(640, 480), cv::Size(1280, 960)}) {
    const ScratchFolder scratch;
    EvaluationSet set = render_evaluation_set(scratch.path(), kPictures, size, options.seed);
    std::vector<LoadedImage> images;
    for (auto& image : set.dataset.images) {
      auto loaded = load_image(image, set.resolution_mm_per_px);
      if (!loaded.ok()) throw std::runtime_error(loaded.error().message);
      images.push_back(std::move(loaded).value());
    }
    measure(options.vision, size, images, options.frames, rows);
  }
  std::vector<std::vector<std::string>> table = {
      {"detector", "width", "height", "ms p50", "ms p99", "RSS MB"}};
  nlohmann::ordered_json json = {{"rows", nlohmann::ordered_json::array()}};
  for (const BenchVisionRow& row : rows) {
    table.push_back({row.detector, std::to_string(row.size.width), std::to_string(row.size.height),
                     number(row.ms_p50, 1), number(row.ms_p99, 1), number(row.rss_mb, 0)});
    json["rows"].push_back({{"detector", row.detector},
                            {"width", row.size.width},
                            {"height", row.size.height},
                            {"ms_p50", row.ms_p50},
                            {"ms_p99", row.ms_p99},
                            {"rss_mb", row.rss_mb}});
  }
  json["seed"] = options.seed;
  json["parameters"] = {{"frames", options.frames}, {"threads", options.threads}};
  json["version"] = FURROW_VERSION;
  std::cout << text_table(table);
  if (options.json.empty()) return;
  if (const Status written = write_file_atomically(options.json, json.dump(2) + "\n");
      !written.ok()) {
    throw std::runtime_error(written.error().message);
  }
  std::cout << options.json << '\n';
}

}  // namespace

void add_bench_vision_command(CLI::App& app, int& /*exit_code*/) {
  CLI::App* command = group(app, "bench", "Speeds, with the alternative measured beside.");
  auto options = std::make_shared<BenchVisionOptions>();
  CLI::App* vision =
      command->add_subcommand("vision", "Time and memory of each detector on a rendered image.");
  add_vision_options(vision, options->vision);
  vision->add_option("--frames", options->frames, "measured for each")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  vision->add_option("--threads", options->threads, "of OpenCV")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  vision->add_option("--seed", options->seed, "of the image")->capture_default_str();
  vision->add_option("--json", options->json, "file of the results");
  vision->callback([options] { bench(*options); });
}

}  // namespace furrow::cli
