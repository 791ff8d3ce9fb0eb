#include "dataset_common.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace furrow::vision {

bool cut_to_box(const cv::Mat& full_mask, AnnotatedInstance& instance) {
  const cv::Rect box = cv::boundingRect(full_mask);
  if (box.empty()) return false;
  instance.box_px = box;
  instance.mask = full_mask(box).clone();
  return true;
}

Result<cv::Mat> read_mask(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    return Error{ErrorCode::kNotFound, file.string() + ": no such mask"};
  }
  cv::Mat mask;
  try {
    mask = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    mask.release();
  }
  if (mask.empty()) {
    return Error{ErrorCode::kParse, file.string() + ": not an image, or a truncated one"};
  }
  return mask;
}

Result<std::vector<std::filesystem::path>> list_files(const std::filesystem::path& folder,
                                                      const std::vector<std::string>& extensions) {
  std::error_code failure;
  std::vector<std::filesystem::path> files;
  for (std::filesystem::directory_iterator it(folder, failure), end; !failure && it != end;
       it.increment(failure)) {
    std::string extension = it->path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) {
      files.push_back(it->path());
    }
  }
  if (failure) {
    return Error{ErrorCode::kNotFound, folder.string() + ": " + failure.message()};
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace furrow::vision
