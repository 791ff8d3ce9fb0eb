#include "furrow_annotation/run_lengths.hpp"

#include <algorithm>
#include <limits>

namespace furrow::annotation {

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

namespace {

/// Calls `visit(column, first_row, end_row)` for each vertical stretch of set pixels.
template <class Visit>
void each_stretch(const RunLengths& runs, int height, const Visit& visit) {
  std::int64_t at = 0;
  bool set = false;
  for (const std::uint32_t run : runs) {
    const std::int64_t end = at + run;
    while (set && at < end) {
      const std::int64_t column = at / height;
      const std::int64_t stop = std::min<std::int64_t>(end, (column + 1) * height);
      visit(static_cast<int>(column), static_cast<int>(at - column * height),
            static_cast<int>(stop - column * height));
      at = stop;
    }
    at = end;
    set = !set;
  }
}

}  // namespace

Result<BoxedMask> decode_run_lengths(const RunLengths& runs, cv::Size size) {
  const std::uint64_t total = static_cast<std::uint64_t>(size.width) * size.height;
  std::uint64_t sum = 0;
  for (const std::uint32_t run : runs) sum += run;
  if (sum != total) {
    return Error{ErrorCode::kParse, "run lengths cover " + std::to_string(sum) +
                                        " pixels of a mask of " + std::to_string(total)};
  }
  cv::Point low(size.width, size.height), high(0, 0);
  each_stretch(runs, size.height, [&](int column, int first, int end) {
    low = {std::min(low.x, column), std::min(low.y, first)};
    high = {std::max(high.x, column + 1), std::max(high.y, end)};
  });
  BoxedMask mask;
  if (high.x == 0) return mask;
  mask.box_px = cv::Rect(low, high);
  mask.pixels = cv::Mat::zeros(mask.box_px.size(), CV_8U);
  each_stretch(runs, size.height, [&](int column, int first, int end) {
    for (int row = first; row < end; ++row) {
      mask.pixels.at<std::uint8_t>(row - low.y, column - low.x) = 255;
    }
  });
  return mask;
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

}  // namespace furrow::annotation
