#include "cdr_type.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <vector>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/sensor_msgs.h"

namespace furrow::dds {
namespace {

using sensor_msgs::msg::Image;
using ImagePtr = std::shared_ptr<const Image>;

constexpr std::size_t kLarge = 300'000;
constexpr std::size_t kLarger = 700'000;

const msgs::MessageType& image_type() {
  return msgs::message_type<Image>();
}

std::vector<std::byte> cdr_form(std::size_t pixels, std::uint8_t value) {
  Image image;
  image.data().assign(pixels, value);
  std::vector<std::byte> bytes(image_type().serialized_size(&image));
  bytes.resize(image_type().serialize(&image, bytes).value());
  return bytes;
}

ImagePtr receive(IncomingMessage& incoming, std::size_t pixels, std::uint8_t value) {
  incoming.deserialize(cdr_form(pixels, value));
  return std::static_pointer_cast<const Image>(incoming.take());
}

bool holds(const Image& image, std::size_t pixels, std::uint8_t value) {
  return image.data() == std::vector<std::uint8_t>(pixels, value);
}

TEST(IncomingMessage, ReusesAMessageOfTheSameSize) {
  IncomingMessage incoming(image_type());
  const Image* large = receive(incoming, kLarge, 1).get();
  const Image* larger = receive(incoming, kLarger, 2).get();
  EXPECT_NE(large, larger);
  for (std::uint8_t i = 3; i < 9; i += 2) {
    EXPECT_EQ(receive(incoming, kLarge, i).get(), large);
    EXPECT_EQ(receive(incoming, kLarger, i).get(), larger);
  }
}

TEST(IncomingMessage, DoesNotReuseAMessageWithAHolder) {
  IncomingMessage incoming(image_type());
  std::vector<ImagePtr> held;
  std::set<const Image*> distinct;
  for (std::uint8_t i = 0; i < 20; ++i) {
    held.push_back(receive(incoming, i % 2 == 0 ? kLarge : kLarger, i));
    distinct.insert(held.back().get());
  }
  EXPECT_EQ(distinct.size(), held.size());
  for (std::uint8_t i = 0; i < 20; ++i) {
    EXPECT_TRUE(holds(*held[i], i % 2 == 0 ? kLarge : kLarger, i)) << int{i};
  }
}

TEST(IncomingMessage, ReadsMoreSizesThanItKeeps) {
  IncomingMessage incoming(image_type());
  for (std::uint8_t i = 0; i < 30; ++i) {
    const std::size_t pixels = kLarge + std::size_t{50'000} * (i % 7);
    EXPECT_TRUE(holds(*receive(incoming, pixels, i), pixels, i)) << int{i};
  }
}

TEST(IncomingMessage, ReadsTheNextMessageAfterAMalformedOne) {
  IncomingMessage incoming(image_type());
  std::vector<std::byte> cut = cdr_form(kLarge, 1);
  cut.resize(cut.size() / 2);
  incoming.deserialize(cut);
  EXPECT_EQ(incoming.take(), nullptr);
  EXPECT_TRUE(holds(*receive(incoming, kLarge, 2), kLarge, 2));
}

}  // namespace
}  // namespace furrow::dds
