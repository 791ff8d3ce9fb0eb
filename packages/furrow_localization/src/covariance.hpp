#pragma once

#include <Eigen/Core>

namespace furrow::localization {

/// Finite, symmetric and positive semi-definite.
[[nodiscard]] bool is_semi_definite(const Eigen::Matrix3d& covariance);
/// Finite, symmetric and positive definite.
[[nodiscard]] bool is_definite(const Eigen::Matrix2d& covariance);
/// The greatest and the least variance of a symmetric 2 x 2 covariance, over all directions.
[[nodiscard]] double greatest_variance(const Eigen::Matrix2d& covariance);
[[nodiscard]] double least_variance(const Eigen::Matrix2d& covariance);

}  // namespace furrow::localization
