#pragma once

#include <cstdint>
#include <span>

/// What the fuzz programs run: each reads any bytes as one kind of file, with every tool, and must
/// neither crash, hang nor take memory without bound. Without clang the same functions run over
/// their seeds and over past findings as a test.
namespace furrow::recording::fuzz {

void read_mcap(std::span<const std::uint8_t> input);
void read_bag(std::span<const std::uint8_t> input);
void read_db3(std::span<const std::uint8_t> input);
/// A message with the definition of its type: "ros1" or "ros2msg" or "omgidl", a line break, the
/// definition, a zero, the message.
void read_message(std::span<const std::uint8_t> input);
/// The metadata.yaml of a rosbag2 folder, and QoS profiles.
void read_yaml(std::span<const std::uint8_t> input);

}  // namespace furrow::recording::fuzz
