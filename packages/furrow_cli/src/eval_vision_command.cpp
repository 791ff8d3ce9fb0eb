#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "command.hpp"
#include "console.hpp"
#include "furrow_core/file.hpp"
#include "furrow_core/statistics.hpp"
#include "furrow_vision/image_file.hpp"
#include "furrow_vision/overlay.hpp"
#include "scratch_folder.hpp"
#include "verb.hpp"
#include "vision_datasets.hpp"
#include "vision_options.hpp"
#include "vision_report.hpp"

namespace furrow::cli {
namespace {

struct EvaluateOptions {
  VisionOptions vision;
  std::vector<std::string> datasets = {"rendered"};
  std::int64_t images = 40;
  std::int64_t limit = 0;
  std::uint64_t seed = 900001;
  std::string species;
  std::string json;
  std::string html;
};

constexpr std::size_t kBestPictures = 2, kWorstPictures = 3;
/// Of an image with fewer plants there is little to see.
constexpr std::size_t kLeastPlants = 5;

/// Truth on the left, what was found on the right.
std::string picture_of(const annotation::AnnotatedImage& image,
                       const std::vector<vision::Instance>& found,
                       const std::vector<annotation::SubClass>& classes) {
  constexpr double kHeight_px = 420.0;
  constexpr double kGap = 0.01;  // of the width
  cv::Mat left = image.bgr.clone(), right = image.bgr.clone(), both;
  vision::draw_annotations(image.instances, left);
  vision::draw_instances(found, classes, false, right);
  const int gap_px = std::max(1, static_cast<int>(kGap * left.cols));
  cv::hconcat(
      std::vector<cv::Mat>{left, cv::Mat(left.rows, gap_px, CV_8UC3, cv::Scalar::all(255)), right},
      both);
  if (both.rows > kHeight_px) {
    const double scale = kHeight_px / both.rows;
    cv::resize(both, both, {}, scale, scale, cv::INTER_AREA);
  }
  constexpr int kQuality = 75;
  const auto bytes = vision::encode_jpeg(both, kQuality);
  if (!bytes.ok()) throw std::runtime_error(bytes.error().message);
  return {bytes->begin(), bytes->end()};
}

/// Keeps the best and the worst pictures, and no more, as the images go by.
class Gallery {
 public:
  [[nodiscard]] bool wants(double miou) const {
    return best_.size() < kBestPictures || worst_.size() < kWorstPictures ||
           miou > best_.back().miou || miou < worst_.back().miou;
  }
  void add(VisionPicture picture) {
    keep(
        picture, kBestPictures, [](double a, double b) { return a > b; }, best_);
    keep(
        std::move(picture), kWorstPictures, [](double a, double b) { return a < b; }, worst_);
  }
  void take_to(std::vector<VisionPicture>& pictures) {
    for (auto* list : {&best_, &worst_}) {
      for (VisionPicture& picture : *list) {
        const bool there = std::any_of(pictures.begin(), pictures.end(), [&](const auto& other) {
          return other.file == picture.file && other.detector == picture.detector &&
                 other.dataset == picture.dataset;
        });
        if (!there) pictures.push_back(std::move(picture));
      }
    }
  }

 private:
  template <class Better>
  static void keep(VisionPicture picture, std::size_t most, Better better,
                   std::vector<VisionPicture>& list) {
    const auto at = std::find_if(list.begin(), list.end(), [&](const auto& other) {
      return better(picture.miou, other.miou);
    });
    list.insert(at, std::move(picture));
    if (list.size() > most) list.pop_back();
  }
  std::vector<VisionPicture> best_, worst_;
};

void evaluate_on(EvaluationSet set, std::vector<NamedDetector>& detectors,
                 const EvaluateOptions& options, VisionReport& report) {
  if (options.vision.resolution_mm_per_px) {
    set.resolution_mm_per_px = *options.vision.resolution_mm_per_px;
  }
  std::erase_if(set.dataset.images, [](const auto& image) { return !image.labelled; });
  if (options.limit > 0 && std::ssize(set.dataset.images) > options.limit) {
    set.dataset.images.resize(static_cast<std::size_t>(options.limit));
  }
  struct Running {
    vision::VisionEvaluation evaluation;
    std::vector<double> ms;
    Gallery gallery;
  };
  std::vector<Running> running(detectors.size());
  ProgressBar bar(set.name);
  for (std::size_t i = 0; i < set.dataset.images.size(); ++i) {
    annotation::AnnotatedImage& image = set.dataset.images[i];
    const auto loaded = load_image(image, set.resolution_mm_per_px);
    if (!loaded.ok()) throw std::runtime_error(loaded.error().message);
    for (std::size_t k = 0; k < detectors.size(); ++k) {
      vision::Detector& detector = *detectors[k].detector;
      detector.reset();  // the images are no sequence
      const auto start = std::chrono::steady_clock::now();
      const auto found = detector.detect(loaded->view());
      running[k].ms.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
              .count());
      if (!found.ok()) {
        throw std::runtime_error(image.path.string() + ": " + found.error().message);
      }
      const double miou = running[k].evaluation.add(image, *found, loaded->camera);
      if (!options.html.empty() && image.instances.size() >= kLeastPlants &&
          running[k].gallery.wants(miou)) {
        running[k].gallery.add({.dataset = set.name,
                                .detector = detectors[k].name,
                                .file = image.path.filename().string(),
                                .miou = miou,
                                .jpeg = picture_of(image, *found, detector.classes())});
      }
    }
    image.bgr.release();
    bar.show(static_cast<double>(i + 1) / static_cast<double>(set.dataset.images.size()), "");
  }
  bar.finish();
  for (std::size_t k = 0; k < detectors.size(); ++k) {
    report.rows.push_back({.dataset = set.name,
                           .detector = detectors[k].name,
                           .scores = running[k].evaluation.scores(),
                           .ms_per_frame = quantile(running[k].ms, 0.5)});
    running[k].gallery.take_to(report.pictures);
  }
  report.parameters.emplace_back(set.name + "_mm_per_px", number(set.resolution_mm_per_px, 3));
}

void write(const std::string& file, const std::string& text) {
  if (file.empty()) return;
  if (const Status written = write_file_atomically(file, text); !written.ok()) {
    throw std::runtime_error(written.error().message);
  }
  std::cout << file << '\n';
}

void evaluate(const EvaluateOptions& options) {
  auto detectors = make_detectors(options.vision);
  VisionReport report;
  report.seed = options.seed;
  for (const std::string& setting : options.vision.settings) {
    const auto equals = setting.find('=');
    report.parameters.emplace_back(setting.substr(0, equals), setting.substr(equals + 1));
  }
  for (const std::string& dataset : options.datasets) {
    if (dataset == "rendered") {
      const ScratchFolder scratch;
      evaluate_on(render_evaluation_set(scratch.path(), options.images, {640, 480}, options.seed,
                                        options.species),
                  detectors, options, report);
    } else {
      evaluate_on(open_evaluation_set(dataset), detectors, options, report);
    }
  }
  std::cout << to_table(report);
  write(options.json, to_json(report));
  write(options.html, to_html(report));
}

}  // namespace

void add_eval_vision_command(CLI::App& app, int& /*exit_code*/) {
  CLI::App* command = group(app, "eval", "The experiments, the paper's figures beside ours.");
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* vision = command->add_subcommand(
      "vision", "IoU, average precision, stem and area errors of the detectors.");
  vision
      ->add_option("--dataset", options->datasets,
                   "'rendered', or a folder of CWFID, Carrot-Weed or COCO with evaluation.json")
      ->capture_default_str();
  add_vision_options(vision, options->vision);
  vision->add_option("--images", options->images, "of the rendered set")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  vision->add_option("--limit", options->limit, "images of each set; 0: all")
      ->check(CLI::NonNegativeNumber);
  vision->add_option("--seed", options->seed, "of the rendered set")->capture_default_str();
  vision
      ->add_option("--species", options->species,
                   "file of the species of the rendered set, in place of "
                   "params/species_evaluation.yaml")
      ->check(CLI::ExistingFile);
  vision->add_option("--json", options->json, "file of the results");
  vision->add_option("--html", options->html, "file of the report");
  vision->callback([options] { evaluate(*options); });
}

}  // namespace furrow::cli
