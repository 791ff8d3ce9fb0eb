#include "furrow_vision/coco_rle.hpp"

#include <limits>

namespace furrow::vision {

RunLengths encode_run_lengths(const cv::Mat& mask) {
  RunLengths runs;
  bool current = false;
  std::uint32_t length = 0;
  for (int u = 0; u < mask.cols; ++u) {
    for (int v = 0; v < mask.rows; ++v) {
      const bool set = mask.at<std::uint8_t>(v, u) != 0;
      if (set != current) {
        runs.push_back(length);
        length = 0;
        current = set;
      }
      ++length;
    }
  }
  runs.push_back(length);
  return runs;
}

Result<cv::Mat> decode_run_lengths(const RunLengths& runs, cv::Size size) {
  const std::uint64_t total = static_cast<std::uint64_t>(size.width) * size.height;
  std::uint64_t sum = 0;
  for (const std::uint32_t run : runs) sum += run;
  if (sum != total) {
    return Error{ErrorCode::kParse, "run lengths cover " + std::to_string(sum) +
                                        " pixels of a mask of " + std::to_string(total)};
  }
  // Filled along rows of the transposed mask, whose memory is in the order of the runs.
  cv::Mat transposed(size.width, size.height, CV_8U);
  std::uint8_t* out = transposed.data;
  std::uint8_t value = 0;
  for (const std::uint32_t run : runs) {
    std::fill_n(out, run, value);
    out += run;
    value = static_cast<std::uint8_t>(255 - value);
  }
  return cv::Mat(transposed.t());
}

std::string compress_run_lengths(const RunLengths& runs) {
  std::string text;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::int64_t rest = runs[i];
    if (i > 2) rest -= runs[i - 2];
    for (bool more = true; more;) {
      int bits = static_cast<int>(rest & 0x1f);
      rest >>= 5;
      more = (bits & 0x10) != 0 ? rest != -1 : rest != 0;
      if (more) bits |= 0x20;
      text.push_back(static_cast<char>(bits + 48));
    }
  }
  return text;
}

Result<RunLengths> decompress_run_lengths(std::string_view text) {
  RunLengths runs;
  for (std::size_t at = 0; at < text.size();) {
    std::int64_t value = 0;
    int shift = 0;
    for (bool more = true; more; ++at, shift += 5) {
      if (at == text.size()) return Error{ErrorCode::kParse, "run lengths end within a number"};
      const int bits = text[at] - 48;
      if (bits < 0 || bits > 63) {
        return Error{ErrorCode::kParse, "run lengths hold a character outside '0' to 'o'"};
      }
      if (shift > 35) return Error{ErrorCode::kParse, "run lengths hold a number too long"};
      value |= static_cast<std::int64_t>(bits & 0x1f) << shift;
      more = (bits & 0x20) != 0;
      if (!more && (bits & 0x10) != 0) value -= std::int64_t{1} << (shift + 5);
    }
    if (runs.size() > 2) value += runs[runs.size() - 2];
    if (value < 0 || value > std::numeric_limits<std::uint32_t>::max()) {
      return Error{ErrorCode::kParse, "run lengths hold a length that is negative or too great"};
    }
    runs.push_back(static_cast<std::uint32_t>(value));
  }
  return runs;
}

}  // namespace furrow::vision
