#include "furrow_core/result.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace furrow {
namespace {

Result<std::unique_ptr<int>> make(bool well) {
  if (!well) return Error{ErrorCode::kNoSolution, "none"};
  return std::make_unique<int>(7);
}

TEST(Result, HoldsValueOrError) {
  auto value = make(true);
  ASSERT_TRUE(value.ok());
  EXPECT_EQ(**value, 7);
  const std::unique_ptr<int> moved = std::move(value).value();
  EXPECT_EQ(*moved, 7);

  const auto error = make(false);
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().code, ErrorCode::kNoSolution);
}

TEST(Result, StatusIsOkUntilAnErrorIsPutIn) {
  EXPECT_TRUE(Status().ok());
  EXPECT_FALSE(Status(Error{ErrorCode::kIo, "x"}).ok());
}

TEST(ConfigError, SaysFileLineAndKey) {
  EXPECT_STREQ(ConfigError({"a.yaml", 3}, "planner.rho", "too large").what(),
               "a.yaml:3: planner.rho: too large");
  EXPECT_STREQ(ConfigError({"a.urdf", 0}, "", "no links").what(), "a.urdf: no links");
}

}  // namespace
}  // namespace furrow
