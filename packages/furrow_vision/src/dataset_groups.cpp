#include "furrow_vision/dataset_groups.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <regex>
#include <set>
#include <vector>

#include "furrow_core/time.hpp"

namespace furrow::vision {
namespace {

std::optional<Time> time_of(const AnnotatedImage& image) {
  if (image.stamp) return image.stamp;
  const std::string name = image.path.stem().string();
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size() || number < 0) return std::nullopt;
  // Unix times of this century have 10 digits in s, and three more for each finer unit.
  switch (name.size()) {
    case 10:
      return Time::from_nanoseconds(number * 1'000'000'000);
    case 13:
      return Time::from_nanoseconds(number * 1'000'000);
    case 16:
      return Time::from_nanoseconds(number * 1'000);
    case 19:
      return Time::from_nanoseconds(number);
    default:
      return std::nullopt;
  }
}

}  // namespace

Result<std::size_t> group_by_path(const std::string& pattern, Dataset& dataset) {
  std::regex expression;
  try {
    expression = std::regex(pattern);
  } catch (const std::regex_error&) {
    return Error{ErrorCode::kInvalidArgument, "'" + pattern + "' is not a regular expression"};
  }
  std::set<std::string> groups;
  std::vector<std::string> sequences;
  for (const AnnotatedImage& image : dataset.images) {
    const std::string path = image.path.string();
    std::smatch match;
    if (!std::regex_search(path, match, expression)) {
      return Error{ErrorCode::kInvalidArgument, path + ": does not match '" + pattern + "'"};
    }
    sequences.push_back(match.size() > 1 ? match[1].str() : match[0].str());
    groups.insert(sequences.back());
  }
  for (std::size_t i = 0; i < sequences.size(); ++i) dataset.images[i].sequence = sequences[i];
  return groups.size();
}

Result<std::size_t> group_by_time(double gap_s, Dataset& dataset) {
  std::vector<std::pair<Time, std::size_t>> order;
  for (std::size_t i = 0; i < dataset.images.size(); ++i) {
    const auto time = time_of(dataset.images[i]);
    if (!time) {
      return Error{ErrorCode::kInvalidArgument,
                   dataset.images[i].path.string() +
                       ": has no stamp, and its name is not a Unix time in s, ms, us or ns"};
    }
    order.emplace_back(*time, i);
  }
  std::ranges::sort(order);
  std::size_t groups = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || (order[i].first - order[i - 1].first).to_seconds() >= gap_s) ++groups;
    dataset.images[order[i].second].sequence = "group_" + std::to_string(groups);
  }
  return groups;
}

}  // namespace furrow::vision
