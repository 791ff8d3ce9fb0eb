#include "crc32.hpp"

#include <gtest/gtest.h>

#include "furrow_core/random.hpp"
#include "mcap_test_support.hpp"

namespace furrow::mcap {
namespace {

// The definition, a bit at a time.
std::uint32_t by_definition(std::span<const std::byte> bytes) {
  std::uint32_t crc = ~0U;
  for (const std::byte byte : bytes) {
    crc ^= std::to_integer<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
  }
  return ~crc;
}

TEST(Crc32, GivesTheStandardsCheckValue) {
  EXPECT_EQ(crc32(bytes_of("123456789")), 0xCBF43926U);
  EXPECT_EQ(crc32({}), 0U);
}

TEST(Crc32, EqualsItsDefinitionAtEveryLengthAndInParts) {
  Random random(1, "crc");
  Bytes bytes(400);
  for (auto& byte : bytes) {
    byte = static_cast<std::byte>(random.next());
  }
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    const auto view = std::span<const std::byte>(bytes).first(size);
    const std::uint32_t whole = by_definition(view);
    ASSERT_EQ(crc32(view), whole);
    const std::size_t cut = size / 3;
    ASSERT_EQ(crc32(view.subspan(cut), crc32(view.first(cut))), whole);
    ASSERT_EQ(crc32_combine(crc32(view.first(cut)), crc32(view.subspan(cut)), size - cut), whole);
  }
}

}  // namespace
}  // namespace furrow::mcap
