#include "furrow_benchmarks/vision_benchmark.hpp"

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <stdexcept>
#include <utility>

#include "furrow_core/scratch_folder.hpp"
#include "furrow_core/statistics.hpp"
#include "furrow_core/text.hpp"
#include "furrow_evaluation/loaded_image.hpp"
#include "furrow_evaluation/vision_datasets.hpp"

namespace furrow::benchmarks {
namespace {

using evaluation::LoadedImage;

/// Resident memory of this process now.
double resident_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024.0;
  }
  return 0.0;
}

std::vector<LoadedImage> rendered_images(cv::Size size_px, std::uint64_t seed) {
  constexpr std::int64_t kPictures = 3;
  const ScratchFolder scratch;
  evaluation::EvaluationSet set = evaluation::render_evaluation_set(
      {.images = kPictures, .size_px = size_px, .seed = seed}, scratch.path(), [](double) {});
  std::vector<LoadedImage> images;
  for (auto& image : set.dataset.images) {
    auto loaded = evaluation::load_image(image, set.resolution_mm_per_px);
    if (!loaded.ok()) throw std::runtime_error(loaded.error().message);
    images.push_back(std::move(loaded).value());
  }
  return images;
}

VisionBenchmarkRow measure(const evaluation::NamedDetector& named,
                           const std::vector<LoadedImage>& images, std::int64_t frames) {
  constexpr std::int64_t kWarmUp = 2;
  std::vector<double> ms;
  for (std::int64_t i = 0; i < kWarmUp + frames; ++i) {
    const LoadedImage& image = images[static_cast<std::size_t>(i) % images.size()];
    const auto start = std::chrono::steady_clock::now();
    const auto found = named.detector->detect(image.view());
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    if (!found.ok()) throw std::runtime_error(found.error().message);
    if (i >= kWarmUp) ms.push_back(took.count());
  }
  return {.detector = named.name,
          .width_px = images.front().bgr.cols,
          .height_px = images.front().bgr.rows,
          .ms_p50 = quantile(ms, 0.5),
          .ms_p99 = quantile(ms, 0.99),
          .rss_mb = resident_mb()};
}

}  // namespace

std::vector<VisionBenchmarkRow> run_vision_benchmark(const VisionBenchmark& benchmark) {
  cv::setNumThreads(benchmark.threads);
  std::vector<VisionBenchmarkRow> rows;
  for (const cv::Size size_px : {cv::Size(640, 480), cv::Size(1280, 960)}) {
    const auto images = rendered_images(size_px, benchmark.seed);
    // One detector at a time, so that the memory is its own.
    const std::size_t count = evaluation::make_detectors(benchmark.detectors).size();
    for (std::size_t i = 0; i < count; ++i) {
      auto detectors = evaluation::make_detectors(benchmark.detectors);
      const evaluation::NamedDetector named = std::move(detectors[i]);
      detectors.clear();
      rows.push_back(measure(named, images, benchmark.frames));
    }
  }
  return rows;
}

std::string to_table(const std::vector<VisionBenchmarkRow>& rows) {
  std::vector<std::vector<std::string>> table = {
      {"detector", "width", "height", "ms p50", "ms p99", "RSS MB"}};
  for (const VisionBenchmarkRow& row : rows) {
    table.push_back({row.detector, std::to_string(row.width_px), std::to_string(row.height_px),
                     fixed(row.ms_p50, 1), fixed(row.ms_p99, 1), fixed(row.rss_mb, 0)});
  }
  return text_table(table);
}

std::string to_json(const VisionBenchmark& benchmark, const std::vector<VisionBenchmarkRow>& rows,
                    std::string_view version) {
  nlohmann::ordered_json json = {{"rows", nlohmann::ordered_json::array()}};
  for (const VisionBenchmarkRow& row : rows) {
    json["rows"].push_back({{"detector", row.detector},
                            {"width", row.width_px},
                            {"height", row.height_px},
                            {"ms_p50", row.ms_p50},
                            {"ms_p99", row.ms_p99},
                            {"rss_mb", row.rss_mb}});
  }
  json["seed"] = benchmark.seed;
  json["parameters"] = {{"frames", benchmark.frames}, {"threads", benchmark.threads}};
  json["version"] = version;
  return json.dump(2) + "\n";
}

}  // namespace furrow::benchmarks
