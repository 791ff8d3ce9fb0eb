#pragma once

#include <string>

namespace furrow {

/// A number with exactly `decimals` digits after the point, without "-0.00"; "-" when it is not
/// finite. The same on every locale.
[[nodiscard]] std::string fixed(double value, int decimals);

}  // namespace furrow
