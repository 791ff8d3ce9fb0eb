#include "dataset_common.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "furrow_vision/image_file.hpp"

namespace furrow::vision {

bool cut_to_box(const cv::Mat& full_mask, AnnotatedInstance& instance) {
  const cv::Rect box = cv::boundingRect(full_mask);
  if (box.empty()) return false;
  instance.box_px = box;
  instance.mask = full_mask(box).clone();
  return true;
}

Result<cv::Mat> read_mask(const std::filesystem::path& file) {
  return read_image(file, ImageChannels::kGrey);
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
