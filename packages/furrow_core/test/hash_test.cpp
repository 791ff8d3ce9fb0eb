#include "furrow_core/hash.hpp"

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(Fnv1a, AgreesWithThePublishedVectors) {
  // From the test suite of the algorithm's authors (isthe.com/chongo/tech/comp/fnv).
  static_assert(fnv1a_64("") == 0xcbf29ce484222325ull);
  EXPECT_EQ(fnv1a_64("a"), 0xaf63dc4c8601ec8cull);
  EXPECT_EQ(fnv1a_64("foobar"), 0x85944171f73967e8ull);
}

}  // namespace
}  // namespace furrow
