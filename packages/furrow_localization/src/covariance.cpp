#include "covariance.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace furrow::localization {
namespace {

double spread(const Eigen::Matrix2d& c) {
  return std::hypot(0.5 * (c(0, 0) - c(1, 1)), c(0, 1));
}

}  // namespace

bool is_semi_definite(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return false;
  const double scale = covariance.cwiseAbs().maxCoeff();
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > 1e-6 * scale) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(0) >= -1e-9 * scale;
}

bool is_definite(const Eigen::Matrix2d& covariance) {
  return covariance.allFinite() &&
         std::abs(covariance(0, 1) - covariance(1, 0)) <= 1e-6 * std::abs(covariance.trace()) &&
         least_variance(covariance) > 0.0;
}

double greatest_variance(const Eigen::Matrix2d& covariance) {
  return 0.5 * covariance.trace() + spread(covariance);
}

double least_variance(const Eigen::Matrix2d& covariance) {
  return 0.5 * covariance.trace() - spread(covariance);
}

}  // namespace furrow::localization
