#include "network.hpp"

#include <algorithm>
#include <cmath>

#include "furrow_core/error.hpp"

namespace furrow::vision {

Result<Network> Network::load(const ModelPart& part) {
  const auto bytes = read_model_part(part);
  if (!bytes.ok()) return bytes.error();
  try {
    cv::dnn::Net net = cv::dnn::readNetFromONNX(bytes->data(), bytes->size());
    net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    return Network(std::move(net), part.path.string());
  } catch (const cv::Exception& failure) {
    return Error{ErrorCode::kParse,
                 part.path.string() + ": is no network that can be run: " + failure.err};
  }
}

Result<std::vector<cv::Mat>> Network::run(const cv::Mat& input,
                                          const std::vector<std::string>& outputs) {
  try {
    net_.setInput(input);
    std::vector<cv::Mat> results;
    net_.forward(results, outputs);
    return results;
  } catch (const cv::Exception& failure) {
    return Error{ErrorCode::kInvalidArgument, file_ + ": cannot be run: " + failure.err};
  }
}

ModelFile load_model(const std::filesystem::path& path, ModelFile::Kind kind,
                     const std::vector<std::string>& classes) {
  auto model = read_model_file(path);
  if (!model.ok()) throw ConfigError(model.error().message);
  if (model->kind != kind) {
    throw ConfigError(path.string() + ": is not a model of kind " +
                      (kind == ModelFile::Kind::kOneStage ? "one_stage" : "mask_rcnn"));
  }
  if (const Status same = check_classes(*model, classes); !same.ok()) {
    throw ConfigError(path.string() + ": " + same.error().message);
  }
  return std::move(model).value();
}

Network load_network(const ModelFile& model, const std::string& part) {
  auto network = Network::load(part_of(model, part));
  if (!network.ok()) throw ConfigError(network.error().message);
  return std::move(network).value();
}

cv::Size network_input_size(cv::Size image, double image_mm_per_px, double model_mm_per_px,
                            std::int64_t area_max_px) {
  constexpr double kStep_px = 32.0, kLeast_px = 64.0;
  const double wanted = image_mm_per_px / model_mm_per_px;
  const double allowed = std::sqrt(static_cast<double>(area_max_px) /
                                   (static_cast<double>(image.width) * image.height));
  const double scale = std::min(wanted, allowed);
  const auto side = [&](int pixels) {
    // A very flat image may exceed the area by its shorter side's minimum, never without bound.
    const double steps = std::round(std::min(pixels * scale, 16384.0) / kStep_px);
    return static_cast<int>(std::max(kLeast_px, steps * kStep_px));
  };
  return {side(image.width), side(image.height)};
}

}  // namespace furrow::vision
