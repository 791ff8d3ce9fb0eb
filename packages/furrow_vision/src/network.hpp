#pragma once

#include <opencv2/dnn.hpp>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_vision/model_file.hpp"

namespace furrow::vision {

/// A network in ONNX, run by OpenCV on the CPU. OpenCV's exceptions become Errors.
class Network {
 public:
  /// Errors of read_model_part(); kParse where the bytes are no network that OpenCV runs.
  [[nodiscard]] static Result<Network> load(const ModelPart& part);

  /// @pre input is a blob of CV_32F; outputs by name, in their order.
  [[nodiscard]] Result<std::vector<cv::Mat>> run(const cv::Mat& input,
                                                 const std::vector<std::string>& outputs);
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  Network(cv::dnn::Net net, std::string file) : net_(std::move(net)), file_(std::move(file)) {}
  cv::dnn::Net net_;
  std::string file_;
};

/// A model file of this kind and these classes (empty: any). Throws ConfigError.
[[nodiscard]] ModelFile load_model(const std::filesystem::path& path, ModelFile::Kind kind,
                                   const std::vector<std::string>& classes);
/// Throws ConfigError.
[[nodiscard]] Network load_network(const ModelFile& model, const std::string& part);

/// The size of the network's input for an image: of the model's ground resolution, sides multiples
/// of 32 and at least 64, area as far as allowed at most `area_max_px`.
[[nodiscard]] cv::Size network_input_size(cv::Size image, double image_mm_per_px,
                                          double model_mm_per_px, std::int64_t area_max_px);

}  // namespace furrow::vision
