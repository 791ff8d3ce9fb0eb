#include <algorithm>
#include <cmath>

#include "furrow_core/statistics.hpp"
#include "furrow_core/text.hpp"
#include "furrow_diagnosis/diagnosis.hpp"

namespace furrow::diagnosis {
namespace {

constexpr double kContradiction = 0.2;

/// From the camera along its optical axis to the ground; empty: it looks at no ground.
std::optional<double> distance_of(const std::optional<geometry::CameraModel>& camera) {
  if (!camera) return std::nullopt;
  const double height_m = camera->X_BC.translation().z();
  const double down = -camera->X_BC.linear().col(2).z();
  constexpr double kSteepEnough = 0.3;
  if (height_m <= 0.0 || down < kSteepEnough) return std::nullopt;
  return height_m / down;
}

std::string unit_remedy(const DepthObservation& depth, double ratio, double unit_m) {
  if (depth.encoding != "32FC1") {
    return "set perception.depth_unit_m; " + fixed(unit_m / ratio, 6) +
           " would fit; or correct the camera's height in the URDF";
  }
  return "let the driver publish metres, as 32FC1 is read; or correct the camera's height in the "
         "URDF";
}

/// Least differences between the stamps of a colour image and a depth image, while both came.
std::vector<double> pair_distances_s(const TopicObservation& image, const TopicObservation& depth) {
  std::vector<double> stamps_s;
  for (const MessageTimes& times : depth.times) stamps_s.push_back(times.stamp.to_seconds());
  std::ranges::sort(stamps_s);
  std::vector<double> distances_s;
  for (const MessageTimes& times : image.times) {
    if (times.arrival < depth.times.front().arrival || times.arrival > depth.times.back().arrival) {
      continue;
    }
    const double stamp_s = times.stamp.to_seconds();
    const auto after = std::ranges::lower_bound(stamps_s, stamp_s);
    double nearest_s = after == stamps_s.end() ? stamp_s - stamps_s.back() : *after - stamp_s;
    if (after != stamps_s.begin()) nearest_s = std::min(nearest_s, stamp_s - *(after - 1));
    distances_s.push_back(nearest_s);
  }
  return distances_s;
}

std::optional<Finding> unpaired(const TopicObservation& image, const TopicObservation& depth,
                                double tolerance_s) {
  if (depth.times.empty()) return std::nullopt;
  const auto distances_s = pair_distances_s(image, depth);
  const auto apart = std::ranges::count_if(
      distances_s, [&](double distance_s) { return distance_s > tolerance_s; });
  constexpr double kFew = 0.1;
  const auto count = static_cast<double>(distances_s.size());
  if (distances_s.empty() || static_cast<double>(apart) <= kFew * count) return std::nullopt;
  return Finding{Rank::kValue, depth.topic, "depth.pairing",
                 std::to_string(apart) + " of " + std::to_string(distances_s.size()) +
                     " images have no depth within " + fixed(1e3 * tolerance_s, 0) +
                     " ms; the median difference of stamps is " +
                     fixed(1e3 * median(distances_s), 0) + " ms",
                 "trigger colour and depth together, or widen perception.depth_tolerance_s"};
}

Findings check_content(const Observations& seen, const Expectation& expected,
                       const std::string& topic) {
  const DepthObservation& depth = *seen.depth;
  Findings findings;
  const auto add = [&](Rank rank, const char* check, std::string problem, std::string remedy) {
    findings.push_back({rank, topic, check, std::move(problem), std::move(remedy)});
  };
  if (!depth.problem.empty()) {
    add(Rank::kFormat, "depth.encoding", depth.problem, "let the driver publish 32FC1 or 16UC1");
    return findings;
  }
  if (seen.image &&
      (depth.width_px != seen.image->width_px || depth.height_px != seen.image->height_px)) {
    add(Rank::kFormat, "depth.size",
        "the depth image is " + std::to_string(depth.width_px) + " x " +
            std::to_string(depth.height_px) + " px, the colour image " +
            std::to_string(seen.image->width_px) + " x " + std::to_string(seen.image->height_px) +
            " px",
        "let the driver align depth to colour");
  }
  const auto distance_m = distance_of(expected.camera);
  if (!depth.median_m) {
    add(Rank::kValue, "depth.empty", "no pixel has a depth",
        "check the range of the depth camera and the light");
  } else if (distance_m && std::abs(*depth.median_m / *distance_m - 1.0) > kContradiction) {
    add(Rank::kValue, "depth.distance",
        "the median depth is " + fixed(*depth.median_m, 3) + " m, the URDF's camera is " +
            fixed(*distance_m, 3) + " m from the ground",
        unit_remedy(depth, *depth.median_m / *distance_m, expected.depth_unit_m));
  }
  return findings;
}

}  // namespace

Findings check_depth(const Observations& seen, const Expectation& expected) {
  Findings findings;
  const TopicObservation* depth = seen.find(Role::kDepth);
  const TopicObservation* image = seen.find(Role::kImage);
  if (depth != nullptr && seen.depth) findings = check_content(seen, expected, depth->topic);
  const auto distance_m = distance_of(expected.camera);
  if (image != nullptr && distance_m &&
      std::abs(expected.ground_distance_m / *distance_m - 1.0) > kContradiction) {
    findings.push_back({Rank::kValue, image->topic, "depth.ground_distance",
                        "perception.ground_distance_m is " + fixed(expected.ground_distance_m, 3) +
                            " m, the URDF's camera is " + fixed(*distance_m, 3) +
                            " m from the ground",
                        "set perception.ground_distance_m, or correct the URDF"});
  }
  if (depth == nullptr || image == nullptr || !seen.depth || !seen.image) return findings;
  if (check_stamps(*image).empty() && check_stamps(*depth).empty()) {
    if (auto finding = unpaired(*image, *depth, expected.depth_tolerance_s)) {
      findings.push_back(std::move(*finding));
    }
  }
  if (depth->frame != image->frame) {
    findings.push_back({Rank::kFrame, depth->topic, "frame.depth",
                        "frame_id is '" + depth->frame + "', that of the images '" + image->frame +
                            "': the depth is not registered to the colour image",
                        "use the driver's depth that is aligned to colour"});
  }
  return findings;
}

}  // namespace furrow::diagnosis
