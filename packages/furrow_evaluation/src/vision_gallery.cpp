#include "vision_gallery.hpp"

#include <algorithm>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>

#include "furrow_vision/image_file.hpp"
#include "furrow_vision/overlay.hpp"

namespace furrow::evaluation {
namespace {

constexpr std::size_t kBestPictures = 2;
constexpr std::size_t kWorstPictures = 3;

template <class Better>
void keep(VisionPicture picture, std::size_t most, Better better,
          std::vector<VisionPicture>& list) {
  const auto at = std::ranges::find_if(
      list, [&](const auto& other) { return better(picture.miou, other.miou); });
  list.insert(at, std::move(picture));
  if (list.size() > most) list.pop_back();
}

bool same_image(const VisionPicture& a, const VisionPicture& b) {
  return a.file == b.file && a.detector == b.detector && a.dataset == b.dataset;
}

}  // namespace

bool VisionGallery::wants(double miou) const {
  return best_.size() < kBestPictures || worst_.size() < kWorstPictures ||
         miou > best_.back().miou || miou < worst_.back().miou;
}

void VisionGallery::add(VisionPicture picture) {
  keep(picture, kBestPictures, std::greater<>(), best_);
  keep(std::move(picture), kWorstPictures, std::less<>(), worst_);
}

void VisionGallery::move_to(std::vector<VisionPicture>& pictures) {
  for (auto* list : {&best_, &worst_}) {
    for (VisionPicture& picture : *list) {
      const bool known = std::ranges::any_of(
          pictures, [&](const auto& other) { return same_image(picture, other); });
      if (!known) pictures.push_back(std::move(picture));
    }
    list->clear();
  }
}

std::string side_by_side_jpeg(const annotation::AnnotatedImage& image,
                              const std::vector<vision::Instance>& found,
                              const std::vector<annotation::SubClass>& classes) {
  constexpr double kHeight_px = 420.0;
  constexpr double kGap = 0.01;  // of the width
  cv::Mat left = image.bgr.clone();
  cv::Mat right = image.bgr.clone();
  vision::draw_annotations(image.instances, left);
  vision::draw_instances(found, classes, false, right);
  const int gap_px = std::max(1, static_cast<int>(kGap * left.cols));
  const cv::Mat gap(left.rows, gap_px, CV_8UC3, cv::Scalar::all(255));
  cv::Mat both;
  cv::hconcat(std::vector<cv::Mat>{left, gap, right}, both);
  if (both.rows > kHeight_px) {
    const double scale = kHeight_px / both.rows;
    cv::resize(both, both, {}, scale, scale, cv::INTER_AREA);
  }
  constexpr int kQuality = 75;
  const auto bytes = vision::encode_jpeg(both, kQuality);
  if (!bytes.ok()) throw std::runtime_error(bytes.error().message);
  return {bytes->begin(), bytes->end()};
}

}  // namespace furrow::evaluation
