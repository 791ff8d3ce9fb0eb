#include "image_codecs.hpp"

#include <opencv2/imgcodecs.hpp>

extern "C" const furrow::vision::ImageCodecs* furrow_image_codecs() {
  static constexpr furrow::vision::ImageCodecs kCodecs = {
      .read_grey = [](const std::string& file) { return cv::imread(file, cv::IMREAD_GRAYSCALE); },
      .read_colour = [](const std::string& file) { return cv::imread(file, cv::IMREAD_COLOR); },
      .read_as_stored =
          [](const std::string& file) { return cv::imread(file, cv::IMREAD_UNCHANGED); },
      .write = [](const std::string& file,
                  const cv::Mat& image) { return cv::imwrite(file, image); },
      .encode_jpeg =
          [](const cv::Mat& image, int quality, std::vector<std::uint8_t>& bytes) {
            return cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
          }};
  return &kCodecs;
}
