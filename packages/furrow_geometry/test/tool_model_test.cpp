#include "furrow_geometry/tool_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "furrow_core/error.hpp"
#include "furrow_core/random.hpp"

namespace furrow::geometry {
namespace {

const std::filesystem::path kBonnbot = std::filesystem::path(FURROW_URDF_DIR) / "bonnbot.urdf";

const std::string kLimit =
    R"(<limit effort="1" lower="-0.5" upper="0.7" velocity="5" acceleration="50" jerk="2000"/>)";

struct AxisText {
  std::string name = "a";
  std::string mount = R"(<origin xyz="0.1 0 0.6"/>)";
  std::string axis = R"(<axis xyz="0 1 0"/>)";
  std::string limit = kLimit;
};

/// One axis below the base: base_link -> NAME (prismatic) -> NAME_nozzle (fixed).
std::string axis_text(const AxisText& a) {
  return "<link name='" + a.name + "_carriage'/><link name='" + a.name +
         "_nozzle'/>\n<joint name='" + a.name +
         "' type='prismatic'><parent link='base_link'/><child link='" + a.name + "_carriage'/>" +
         a.mount + a.axis + a.limit + "</joint>\n<joint name='" + a.name +
         "_tip' type='fixed'><parent link='" + a.name + "_carriage'/><child link='" + a.name +
         "_nozzle'/></joint>\n";
}

std::string nozzle_text(const std::string& axis) {
  return "<nozzle link='" + axis + "_nozzle' footprint_radius='0.025'/>";
}

std::string robot(const std::string& body, const std::string& furrow) {
  return "<robot name='r'>\n<link name='base_link'/>\n" + body + "<furrow>" + furrow +
         "</furrow>\n</robot>\n";
}

std::string error_of(const std::string& urdf) {
  try {
    (void)parse_tool_model(urdf, "tool.urdf");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

void expect_error(const std::string& urdf, std::initializer_list<const char*> parts) {
  const std::string error = error_of(urdf);
  EXPECT_EQ(error.rfind("tool.urdf", 0), 0u) << error;
  for (const char* part : parts) EXPECT_NE(error.find(part), std::string::npos) << error;
}

TEST(BonnbotUrdf, HoldsTheFiguresOfThePaper) {
  const ToolModel tool = load_tool_model(kBonnbot);
  EXPECT_EQ(tool.robot, "bonnbot_i_plus");
  EXPECT_EQ(tool.base_link, "base_link");
  ASSERT_EQ(tool.axes.size(), 4u);
  const double x_m[] = {0.18, 0.06, -0.06, -0.18};
  for (int i = 0; i < 4; ++i) {
    const AxisModel& axis = tool.axes[i];
    EXPECT_EQ(axis.name, "axis_" + std::to_string(i + 1));
    EXPECT_NEAR((axis.p_BN0 - Eigen::Vector3d(x_m[i], 0, 0.6)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((axis.direction_B - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-12);
    EXPECT_DOUBLE_EQ(axis.upper_m - axis.lower_m, 1.39);
    EXPECT_DOUBLE_EQ(axis.lower_m, -0.695);
    EXPECT_DOUBLE_EQ(axis.max_velocity_mps, 5.0);
    EXPECT_DOUBLE_EQ(axis.max_acceleration_mps2, 50.0);
    EXPECT_DOUBLE_EQ(axis.max_jerk_mps3, 2000.0);
    EXPECT_DOUBLE_EQ(axis.nozzle.footprint_radius_m, 0.025);
    EXPECT_NEAR(axis.nozzle.height_m, 0.6, 1e-12);
    EXPECT_NEAR(axis.nozzle_position_B(0.3).y(), 0.3, 1e-12);
  }
}

TEST(BonnbotUrdf, CameraLooksDownWithTravelTowardsTheUpperEdge) {
  const ToolModel tool = load_tool_model(kBonnbot);
  ASSERT_EQ(tool.cameras.size(), 1u);
  const CameraModel& model = tool.cameras[0];
  const PinholeCamera camera(model.intrinsics);
  const auto pixel_of = [&](double x_m, double y_m) {
    return camera.project(model.X_BC.inverse() * Eigen::Vector3d(x_m, y_m, 0.0)).value();
  };
  EXPECT_EQ(model.intrinsics.width_px, 1280);
  EXPECT_EQ(model.intrinsics.height_px, 960);
  EXPECT_NEAR((model.X_BC.translation() - Eigen::Vector3d(1.2, 0, 1)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((pixel_of(1.2, 0) - Eigen::Vector2d(639.5, 479.5)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((pixel_of(1.3, 0) - Eigen::Vector2d(639.5, 479.5 - 87)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((pixel_of(1.2, 0.1) - Eigen::Vector2d(639.5 - 87, 479.5)).norm(), 0.0, 1e-9);
}

TEST(ToolModel, TakesAnyNumberOfAxesFrontFirstThenByName) {
  std::string body;
  std::string furrow;
  const std::vector<std::pair<std::string, std::string>> axes = {{"c", "-0.3 0 0.6"},
                                                                 {"b", "0.2 0.5 0.6"},
                                                                 {"a", "0.2 -0.5 0.6"},
                                                                 {"d", "0.9 0 0.5"},
                                                                 {"e", "0 0 0.6"}};
  for (const auto& [name, xyz] : axes) {
    body += axis_text({.name = name, .mount = "<origin xyz='" + xyz + "'/>"});
    furrow += nozzle_text(name);
  }
  const ToolModel tool = parse_tool_model(robot(body, furrow), "tool.urdf");
  std::string order;
  for (const AxisModel& axis : tool.axes) order += axis.name;
  EXPECT_EQ(order, "dabec");
  EXPECT_DOUBLE_EQ(tool.axes[0].nozzle.height_m, 0.5);
  EXPECT_TRUE(tool.cameras.empty());
}

TEST(ToolModel, FollowsRotatedMountsAndOffsetsOnBothSidesOfTheJoint) {
  // base -> plate: at (1, 0, 0.8), turned left by 90 degrees. plate -> axis: 0.2 along the plate's
  // x, running along its x. carriage -> nozzle: 0.1 to the plate's left and 0.3 down.
  const std::string body = R"(
    <link name="plate"/><link name="carriage"/><link name="tip"/>
    <joint name="mount" type="fixed"><parent link="base_link"/><child link="plate"/>
      <origin xyz="1 0 0.8" rpy="0 0 1.5707963267948966"/></joint>
    <joint name="slide" type="prismatic"><parent link="plate"/><child link="carriage"/>
      <origin xyz="0.2 0 0"/><axis xyz="2 0 0"/>)" +
                           kLimit + R"(</joint>
    <joint name="hang" type="fixed"><parent link="carriage"/><child link="tip"/>
      <origin xyz="0 0.1 -0.3"/></joint>)";
  const ToolModel tool =
      parse_tool_model(robot(body, "<nozzle link='tip' footprint_radius='0.02'/>"), "tool.urdf");
  ASSERT_EQ(tool.axes.size(), 1u);
  // The plate's x is the base's y, its y the base's -x.
  EXPECT_NEAR((tool.axes[0].p_BN0 - Eigen::Vector3d(0.9, 0.2, 0.5)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((tool.axes[0].direction_B - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((tool.axes[0].nozzle_position_B(0.5) - Eigen::Vector3d(0.9, 0.7, 0.5)).norm(), 0.0,
              1e-12);
}

TEST(ToolModel, TheBaseMayHangBelowAnotherLinkAndHaveAnotherName) {
  const std::string urdf = R"(<robot name="r"><link name="odom"/><link name="chassis"/>
    <joint name="drive" type="planar"><parent link="odom"/><child link="chassis"/>
      <axis xyz="0 0 1"/></joint>
    <link name="carriage"/><joint name="slide" type="prismatic"><parent link="chassis"/>
      <child link="carriage"/><origin xyz="0.1 0 0.6"/><axis xyz="0 1 0"/>)" +
                           kLimit + R"(</joint>
    <furrow base_link="chassis"><nozzle link="carriage" footprint_radius="0.02"/></furrow></robot>)";
  const ToolModel tool = parse_tool_model(urdf, "tool.urdf");
  EXPECT_EQ(tool.base_link, "chassis");
  EXPECT_NEAR(tool.axes.at(0).p_BN0.x(), 0.1, 1e-12);
}

TEST(ToolModelErrors, NotAUrdf) {
  expect_error("", {"xml"});
  expect_error("{}", {"xml"});
  expect_error("<robot name='r'>\n<link name='base_link'>\n</robot>", {"tool.urdf:", "xml"});
  expect_error("<sdf/>", {"<robot>"});
  expect_error(std::string("<robot\0/>", 9), {"zero byte"});
  EXPECT_THROW((void)load_tool_model("no_such_file.urdf"), ConfigError);
}

TEST(ToolModelErrors, WhatUrdfdomRefusesIsPassedOn) {
  const std::string twice = robot(axis_text({}) + "<link name='a_nozzle'/>", nozzle_text("a"));
  expect_error(twice, {"a_nozzle", "not unique"});
  expect_error(robot(axis_text({}) + "<joint name='j' type='fixed'><parent link='nowhere'/>"
                                     "<child link='base_link'/></joint>",
                     nozzle_text("a")),
               {"nowhere"});
}

TEST(ToolModelErrors, TheFurrowElement) {
  expect_error("<robot name='r'>\n<link name='base_link'/></robot>",
               {":1:", "<furrow>", "missing"});
  expect_error(robot("", ""), {"no axis"});
  expect_error(robot(axis_text({}), nozzle_text("a") + "<nozle link='x'/>"),
               {":6:", "<nozle>", "not known"});
  expect_error("<robot name='r'><link name='base_link'/><furrow/><furrow/></robot>", {"second"});
  expect_error("<robot name='r'><link name='b'/><furrow/></robot>", {"no base link 'base_link'"});
  expect_error("<robot name='r'><link name='b'/><furrow base='b'/></robot>",
               {"'base' is not known"});
}

TEST(ToolModelErrors, Limits) {
  const auto with = [](const std::string& limit) {
    return robot(axis_text({.limit = limit}), nozzle_text("a"));
  };
  expect_error(with(""), {":4:", "joint 'a'", "needs a <limit>"});
  struct Case {
    std::string from;
    std::string to;
    std::string expected;
  };
  for (const Case& c : {
           Case{R"(lower="-0.5")", "", "'lower' is missing"},
           Case{R"(upper="0.7")", R"(upper="nan")", "not a finite number"},
           Case{R"(upper="0.7")", R"(upper="-0.5")", "below the upper"},
           Case{R"(velocity="5")", R"(velocity="0")", "'velocity' must be positive"},
           Case{R"(velocity="5")", R"(velocity="5 m/s")", "'5 m/s', not a finite number"},
           Case{R"(acceleration="50")", "", "'acceleration' is missing"},
           Case{R"(acceleration="50")", R"(acceleration="-50")", "must be positive"},
           Case{R"(jerk="2000")", R"(jerk="")", "'jerk' is missing"},
           Case{R"(jerk="2000")", R"(jerk="inf")", "not a finite number"},
           Case{R"(effort="1")", "", "effort"},
       }) {
    std::string limit = kLimit;
    limit.replace(limit.find(c.from), c.from.size(), c.to);
    expect_error(with(limit), {c.expected.c_str()});
  }
}

TEST(ToolModelErrors, AxesAndNozzles) {
  expect_error(robot(axis_text({.axis = "<axis xyz='0 0 0'/>"}), nozzle_text("a")),
               {"joint 'a'", "zero"});
  expect_error(robot(axis_text({.axis = "<axis xyz='0 0 1'/>"}), nozzle_text("a")),
               {"joint 'a'", "level"});
  expect_error(robot(axis_text({.mount = "<origin xyz='0 0 -0.1'/>"}), nozzle_text("a")),
               {"link 'a_nozzle'", "above the ground"});
  expect_error(robot(axis_text({}), ""), {":4:", "joint 'a'", "without a <nozzle>"});
  expect_error(robot(axis_text({}), nozzle_text("a") + "<nozzle link='a_carriage' "
                                                       "footprint_radius='0.1'/>"),
               {"joint 'a'", "two nozzles"});
  expect_error(robot(axis_text({}), nozzle_text("b")), {"link 'b_nozzle'", "no such link"});
  expect_error(robot(axis_text({}), "<nozzle link='base_link' footprint_radius='0.1'/>"),
               {"link 'base_link'", "one prismatic joint"});
  expect_error(robot(axis_text({}), "<nozzle link='a_nozzle' footprint_radius='0'/>"),
               {"<nozzle>", "must be positive"});
  expect_error(robot(axis_text({}), "<nozzle footprint_radius='0.1'/>"), {"'link' is missing"});
  expect_error(robot(axis_text({.limit = kLimit + "<mimic joint='b'/>"}), nozzle_text("a")),
               {"joint 'a'", "mimics"});
  const std::string second_joint =
      "<link name='arm'/><joint name='lift' type='revolute'><parent link='a_carriage'/>"
      "<child link='arm'/><axis xyz='0 0 1'/><limit effort='1' velocity='1' lower='0' upper='1'/>"
      "</joint>";
  expect_error(robot(axis_text({}) + second_joint, "<nozzle link='arm' footprint_radius='0.1'/>"),
               {"link 'arm'", "one prismatic joint"});
}

TEST(ToolModelErrors, Cameras) {
  const auto with = [](const std::string& camera) {
    return robot(axis_text({}) +
                     "<link name='eye'/><joint name='look' type='fixed'>"
                     "<parent link='base_link'/><child link='eye'/></joint>",
                 nozzle_text("a") + camera);
  };
  const std::string good =
      "<camera link='eye' width='640' height='480' fx='500' fy='500' cx='319.5' cy='239.5'/>";
  EXPECT_EQ(error_of(with(good)), "");
  expect_error(with(good + good), {"link 'eye'", "two cameras"});
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string camera = good;
    camera.replace(camera.find(from), from.size(), to);
    return with(camera);
  };
  expect_error(changed("width='640'", ""), {"<camera>", "'width' is missing"});
  expect_error(changed("640", "640.5"), {"whole number"});
  expect_error(changed("480", "0"), {"must be positive"});
  expect_error(changed("480", "1e9"), {"up to 100000"});
  expect_error(changed("fx='500'", "fx='-1'"), {"must be positive"});
  expect_error(changed("cx='319.5'", "cx=''"), {"'cx' is missing"});
  expect_error(changed("eye", "ear"), {"link 'ear'", "no such link"});
  expect_error(changed("eye", "a_nozzle"), {"link 'a_nozzle'", "'a' moves the camera"});
  expect_error(changed("fx='500'", "fx='500' hfov='1'"), {"'hfov' is not known"});
}

TEST(ToolModelErrors, TruncatedAndDamagedFilesGiveAnErrorOrAModelNeverAnythingElse) {
  std::ifstream stream(kBonnbot);
  const std::string whole((std::istreambuf_iterator<char>(stream)), {});
  ASSERT_FALSE(whole.empty());
  const std::size_t end = whole.rfind('>');
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const auto length =
        static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(end) - 1));
    EXPECT_NE(error_of(whole.substr(0, length)), "") << length;
  }
  for (int i = 0; i < 200; ++i) {
    std::string damaged = whole;
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(
          random.integer(0, static_cast<std::int64_t>(damaged.size()) - 1));
      damaged[at] = static_cast<char>(random.integer(32, 126));
    }
    const std::string error = error_of(damaged);
    EXPECT_TRUE(error.empty() || error.rfind("tool.urdf", 0) == 0) << error;
  }
}

}  // namespace
}  // namespace furrow::geometry
