#include <cmath>

#include "furrow_core/text.hpp"
#include "furrow_diagnosis/diagnosis.hpp"

namespace furrow::diagnosis {
namespace {

using geometry::CameraIntrinsics;

std::string size_text(int width_px, int height_px) {
  return std::to_string(width_px) + " x " + std::to_string(height_px) + " px";
}

Findings check_image(const Observations& seen, const Expectation& expected,
                     const TopicObservation& topic) {
  const ImageObservation& image = *seen.image;
  Findings findings;
  const auto add = [&](Rank rank, const char* check, std::string problem, std::string remedy) {
    findings.push_back({rank, topic.topic, check, std::move(problem), std::move(remedy)});
  };
  if (!image.problem.empty()) {
    add(Rank::kFormat, "image.encoding", image.problem, "let the driver publish bgr8 or rgb8");
  } else if (image.grey) {
    add(expected.grey_is_refused ? Rank::kFormat : Rank::kValue, "image.grey",
        "the images are grey (" + image.encoding + ")",
        "let the driver publish colour: bgr8, rgb8, or the camera's Bayer pattern");
  }
  if (image.uniform) {
    add(Rank::kValue, "image.uniform", "all pixels are equal",
        "remove the lens cap; check exposure and trigger");
  }
  if (seen.calibration) {
    const CameraIntrinsics& said = seen.calibration->intrinsics;
    if (said.width_px != image.width_px || said.height_px != image.height_px) {
      add(Rank::kFormat, "image.size",
          "the image is " + size_text(image.width_px, image.height_px) + ", camera_info says " +
              size_text(said.width_px, said.height_px),
          "publish the camera_info of this stream");
    }
  }
  return findings;
}

/// The first of the faults of K; empty: none.
std::optional<Finding> intrinsics_fault(const CameraIntrinsics& k) {
  constexpr double kNarrowest = 10.0;  // focal length by width: 6 degrees
  constexpr double kWidest = 0.2;      // 136 degrees of a pinhole, or a fisheye
  constexpr double kSquare = 0.05;
  constexpr double kCentre = 0.15;
  Finding finding{.rank = Rank::kFormat};
  finding.remedy = "calibrate the camera (camera_calibration) and load the file in the driver";
  const double width = k.width_px;
  if (k.fx_px == 0.0 || k.fy_px == 0.0) {
    finding.check = "camera_info.uncalibrated";
    finding.problem = "the focal length in K is zero: the camera is not calibrated";
  } else if (!(k.fx_px > kWidest * width && k.fx_px < kNarrowest * width)) {
    finding.check = "camera_info.focal_length";
    finding.problem = "fx is " + fixed(k.fx_px, 1) + " px for a width of " + fixed(width, 0) +
                      " px, which no lens has";
  } else if (!(std::abs(k.fy_px / k.fx_px - 1.0) < kSquare)) {
    finding.check = "camera_info.aspect";
    finding.problem = "fx is " + fixed(k.fx_px, 1) + " px and fy " + fixed(k.fy_px, 1) +
                      " px, but pixels are square";
  } else if (!(std::abs(k.cx_px / width - 0.5) < kCentre &&
               std::abs(k.cy_px / k.height_px - 0.5) < kCentre)) {
    finding.check = "camera_info.centre";
    finding.problem = "the centre (" + fixed(k.cx_px, 1) + ", " + fixed(k.cy_px, 1) +
                      ") is far from the middle of " + size_text(k.width_px, k.height_px);
  } else {
    return std::nullopt;
  }
  return finding;
}

/// The tracker takes the intrinsics from the URDF, the detector those of camera_info.
std::optional<Finding> contradiction(const CameraIntrinsics& said, const CameraIntrinsics& urdf) {
  constexpr double kSame = 0.05;
  const bool same_size = said.width_px == urdf.width_px && said.height_px == urdf.height_px;
  if (same_size && std::abs(said.fx_px / urdf.fx_px - 1.0) <= kSame &&
      std::abs(said.fy_px / urdf.fy_px - 1.0) <= kSame) {
    return std::nullopt;
  }
  Finding finding{.rank = Rank::kValue, .check = "camera_info.urdf"};
  finding.problem = "camera_info says " + size_text(said.width_px, said.height_px) + " with fx " +
                    fixed(said.fx_px, 1) + " px, the URDF " +
                    size_text(urdf.width_px, urdf.height_px) + " with fx " + fixed(urdf.fx_px, 1) +
                    " px";
  finding.remedy = "set the <camera> element of the URDF (common.tool_file) to camera_info";
  return finding;
}

Findings check_calibration(const Observations& seen, const Expectation& expected,
                           const std::string& topic) {
  Findings findings;
  const CalibrationObservation& calibration = *seen.calibration;
  auto fault = intrinsics_fault(calibration.intrinsics);
  if (!fault && expected.camera) {
    fault = contradiction(calibration.intrinsics, expected.camera->intrinsics);
  }
  if (fault) findings.push_back(std::move(*fault));
  if (!calibration.problem.empty()) {
    findings.push_back({Rank::kFormat, "", "camera_info.distortion", calibration.problem,
                        "calibrate with plumb_bob, rational_polynomial or equidistant"});
  }
  for (Finding& finding : findings) finding.topic = topic;
  return findings;
}

}  // namespace

Findings check_camera(const Observations& seen, const Expectation& expected) {
  Findings findings;
  const TopicObservation* image = seen.find(Role::kImage);
  const TopicObservation* info = seen.find(Role::kCameraInfo);
  if (image != nullptr && seen.image) findings = check_image(seen, expected, *image);
  if (info != nullptr && seen.calibration) {
    for (Finding& finding : check_calibration(seen, expected, info->topic)) {
      findings.push_back(std::move(finding));
    }
  }
  if (image == nullptr || !seen.image) return findings;
  if (expected.camera && image->frame != expected.camera->link) {
    findings.push_back({Rank::kFrame, image->topic, "frame.urdf",
                        "frame_id is '" + image->frame + "', the camera of the URDF is link '" +
                            expected.camera->link + "'",
                        "set the driver's frame_id, or the link of <camera> in the URDF"});
  }
  if (info != nullptr && seen.calibration && info->frame != image->frame) {
    findings.push_back(
        {Rank::kFrame, info->topic, "frame.camera_info",
         "frame_id is '" + info->frame + "', that of the images '" + image->frame + "'",
         "use the camera_info of this stream"});
  }
  return findings;
}

}  // namespace furrow::diagnosis
