#include "furrow_vision/image_file.hpp"

#include <dlfcn.h>

#include <array>
#include <fstream>
#include <string>
#include <string_view>

#include "image_codecs.hpp"

namespace furrow::vision {
namespace {

namespace fs = std::filesystem;

Result<const ImageCodecs*> load_codecs() {
  Dl_info own{};
  if (dladdr(reinterpret_cast<void*>(&load_codecs), &own) == 0) {
    return Error{ErrorCode::kIo, "the folder of this library is not known"};
  }
  const fs::path library = fs::path(own.dli_fname).parent_path() / kImageCodecsLibrary;
  void* const handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) return Error{ErrorCode::kIo, dlerror()};
  auto* const function =
      reinterpret_cast<ImageCodecsFunction*>(dlsym(handle, kImageCodecsFunction));
  if (function == nullptr) return Error{ErrorCode::kIo, dlerror()};
  return function();
}

const Result<const ImageCodecs*>& codecs() {
  static const Result<const ImageCodecs*> loaded = load_codecs();
  return loaded;
}

/// What a file is that no codec reads, and what to do about it.
std::string why_unreadable(const fs::path& file) {
  std::array<char, 12> head{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), head.size());
  const std::string_view begin(head.data(), static_cast<std::size_t>(stream.gcount()));
  if (begin.empty()) return "the file is empty, or may not be read";
  const auto is = [&](std::string_view magic, std::size_t at = 0) {
    return begin.size() >= at + magic.size() && begin.substr(at, magic.size()) == magic;
  };
  std::string_view format;
  if (is("GIF8")) format = "a GIF image";
  if (is("ftyp", 4)) format = "a HEIF or AVIF image, or a video";
  if (is("RIFF") && is("AVI ", 8)) format = "a video";
  if (is("%PDF")) format = "a PDF document";
  if (is("<svg") || is("<?xml")) format = "an SVG or another XML file";
  if (format.empty()) return "not an image, or a truncated one";
  return std::string(format) + " is not read: save it as PNG or JPEG";
}

}  // namespace

Result<cv::Mat> read_image(const fs::path& file, ImageChannels channels) {
  if (!codecs().ok()) return codecs().error();
  const ImageCodecs& with = **codecs();
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) {
    return Error{ErrorCode::kNotFound, file.string() + ": no such image"};
  }
  const auto read = channels == ImageChannels::kGrey     ? with.read_grey
                    : channels == ImageChannels::kColour ? with.read_colour
                                                         : with.read_as_stored;
  cv::Mat image;
  try {
    image = read(file.string());
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) {
    return Error{ErrorCode::kParse, file.string() + ": " + why_unreadable(file)};
  }
  return image;
}

Result<cv::Mat> read_mask(const fs::path& file) {
  return read_image(file, ImageChannels::kGrey);
}

Status write_image(const fs::path& file, const cv::Mat& image) {
  if (!codecs().ok()) return codecs().error();
  bool written = false;
  try {
    written = (*codecs())->write(file.string(), image);
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written) return Error{ErrorCode::kIo, file.string() + ": cannot write the image"};
  return {};
}

Result<std::vector<std::uint8_t>> encode_jpeg(const cv::Mat& image, int quality) {
  if (!codecs().ok()) return codecs().error();
  std::vector<std::uint8_t> bytes;
  bool encoded = false;
  try {
    encoded = (*codecs())->encode_jpeg(image, quality, bytes);
  } catch (const cv::Exception&) {
    encoded = false;
  }
  if (!encoded) return Error{ErrorCode::kIo, "cannot encode the picture as JPEG"};
  return bytes;
}

}  // namespace furrow::vision
