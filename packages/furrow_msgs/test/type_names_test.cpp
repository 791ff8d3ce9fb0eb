#include "furrow_msgs/type_names.hpp"

#include <gtest/gtest.h>

namespace furrow::msgs {
namespace {

TEST(TypeNames, GoBothWays) {
  EXPECT_EQ(ros_type_name("sensor_msgs::msg::dds_::Image_"), "sensor_msgs/msg/Image");
  EXPECT_EQ(dds_type_name("sensor_msgs/msg/Image"), "sensor_msgs::msg::dds_::Image_");
  EXPECT_EQ(ros_type_name("sensor_msgs/msg/Image"), "sensor_msgs/msg/Image");
  for (const char* foreign : {"Thing", "a::b::Thing", "", "a::msg::dds_::Thing"}) {
    EXPECT_EQ(ros_type_name(foreign), foreign);
    EXPECT_EQ(dds_type_name(foreign), foreign);
  }
}

}  // namespace
}  // namespace furrow::msgs
