#include <algorithm>
#include <cmath>
#include <functional>

#include "furrow_core/statistics.hpp"
#include "furrow_core/text.hpp"
#include "furrow_diagnosis/diagnosis.hpp"

namespace furrow::diagnosis {
namespace {

constexpr double kLargestSigma_m = 0.3;

bool finite_fix(const GnssSample& fix) {
  return std::isfinite(fix.latitude_deg) && std::isfinite(fix.longitude_deg) &&
         std::isfinite(fix.altitude_m);
}

double sigma_m(const GnssSample& fix) {
  return std::sqrt(std::max({fix.covariance_m2(0, 0), fix.covariance_m2(1, 1), 0.0}));
}

/// A known covariance that is not positive definite, and so refused.
bool bad_covariance(const GnssSample& fix) {
  return fix.covariance_known &&
         !(fix.covariance_m2.allFinite() && fix.covariance_m2.determinant() > 0.0 &&
           fix.covariance_m2(0, 0) > 0.0);
}

}  // namespace

Findings check_gnss(const Observations& seen, const Expectation& expected) {
  const TopicObservation* topic = seen.find(Role::kGnss);
  if (topic == nullptr || seen.gnss.empty()) return {};
  Findings findings;
  const auto add = [&](Rank rank, const char* check, std::string problem, std::string remedy) {
    findings.push_back({rank, topic->topic, check, std::move(problem), std::move(remedy)});
  };
  const auto count = [&](const std::function<bool(const GnssSample&)>& holds) {
    return std::ranges::count_if(seen.gnss, holds);
  };
  const std::string of_all = " of " + std::to_string(seen.gnss.size()) + " fixes";
  if (const auto none = count([](const auto& fix) { return fix.status < 0; }); none > 0) {
    add(Rank::kFormat, "gnss.no_fix",
        std::to_string(none) + of_all + " have status -1: no position",
        "give the antenna a free view of the sky; wait for the receiver");
    return findings;
  }
  if (const auto bad = count([](const auto& fix) { return !finite_fix(fix); }); bad > 0) {
    add(Rank::kFormat, "gnss.not_finite", std::to_string(bad) + of_all + " hold NaN or infinity",
        "let the driver publish status -1 while it has no position");
    return findings;
  }
  const auto at_zero = count([](const auto& fix) {
    return std::abs(fix.latitude_deg) < 1e-6 && std::abs(fix.longitude_deg) < 1e-6;
  });
  if (at_zero > 0) {
    add(Rank::kFormat, "gnss.zero", std::to_string(at_zero) + of_all + " are at (0, 0)",
        "let the driver publish status -1 while it has no position");
    return findings;
  }
  if (const auto bad = count(bad_covariance); bad > 0) {
    add(Rank::kFormat, "gnss.covariance",
        "the covariance of " + std::to_string(bad) + of_all +
            " is zero or not positive definite, although its type says that it is known",
        "give a covariance in m2, or set position_covariance_type to 0");
  }
  const Eigen::Vector2d& p = seen.gnss.back().p_FA_m;
  if (!(p.cwiseAbs().maxCoeff() <= expected.max_field_m)) {
    add(Rank::kValue, "gnss.origin",
        "the fix is " + fixed(p.norm() / 1e3, 1) + " km from the origin of the field",
        "set common.origin_latitude_deg and common.origin_longitude_deg to a place in the field");
  }
  std::vector<double> sigmas_m;
  for (const GnssSample& fix : seen.gnss) {
    if (fix.covariance_known && !bad_covariance(fix)) sigmas_m.push_back(sigma_m(fix));
  }
  if (!sigmas_m.empty() && median(sigmas_m) > kLargestSigma_m) {
    add(Rank::kValue, "gnss.accuracy",
        "the standard deviation is " + fixed(median(sigmas_m), 2) + " m (status " +
            std::to_string(seen.gnss.back().status) + "); rows need an RTK fix",
        "check the corrections of the base station (NTRIP, radio)");
  }
  return findings;
}

}  // namespace furrow::diagnosis
