#include "urdf_extensions.hpp"

#include <tinyxml.h>

#include <charconv>
#include <cmath>
#include <initializer_list>
#include <system_error>

#include "furrow_core/error.hpp"

namespace furrow::geometry {
namespace {

/// Reads attributes of one element; its errors name the file, the line and `subject`.
class ElementReader {
 public:
  ElementReader(std::string_view origin, const TiXmlElement& element, std::string subject)
      : origin_(origin), element_(element), subject_(std::move(subject)) {}

  [[noreturn]] void fail(const std::string& message) const {
    throw ConfigError({origin_, element_.Row()}, subject_, message);
  }

  [[nodiscard]] std::string text(const char* name) const {
    const char* value = element_.Attribute(name);
    if (value == nullptr || *value == '\0')
      fail("the attribute '" + std::string(name) + "' is missing");
    return value;
  }

  [[nodiscard]] double number(const char* name) const {
    const std::string value = text(name);
    double number = 0.0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || end != value.data() + value.size() || !std::isfinite(number)) {
      fail("'" + std::string(name) + "' is '" + value + "', not a finite number");
    }
    return number;
  }

  [[nodiscard]] double positive(const char* name) const {
    const double value = number(name);
    if (!(value > 0.0)) fail("'" + std::string(name) + "' must be positive");
    return value;
  }

  [[nodiscard]] int size_px(const char* name) const {
    constexpr double kLargest = 100'000.0;
    const double value = positive(name);
    if (value != std::floor(value) || value > kLargest) {
      fail("'" + std::string(name) + "' must be a whole number of pixels up to 100000");
    }
    return static_cast<int>(value);
  }

  void allow_only(std::initializer_list<std::string_view> names) const {
    for (const TiXmlAttribute* a = element_.FirstAttribute(); a != nullptr; a = a->Next()) {
      bool known = false;
      for (const std::string_view name : names) known = known || name == a->Name();
      if (!known) fail("the attribute '" + std::string(a->Name()) + "' is not known");
    }
  }

 private:
  std::string origin_;
  const TiXmlElement& element_;
  std::string subject_;
};

PrismaticElement read_prismatic(const TiXmlElement& joint, const std::string& name,
                                std::string_view origin) {
  const std::string subject = "joint '" + name + "'";
  const ElementReader at_joint(origin, joint, subject);
  if (joint.FirstChildElement("mimic") != nullptr) {
    at_joint.fail("a prismatic joint that mimics another cannot be an axis");
  }
  const TiXmlElement* limit = joint.FirstChildElement("limit");
  if (limit == nullptr) at_joint.fail("a prismatic joint needs a <limit>");
  const ElementReader at_limit(origin, *limit, subject);
  PrismaticElement result;
  result.line = joint.Row();
  result.limit.lower_m = at_limit.number("lower");
  result.limit.upper_m = at_limit.number("upper");
  if (!(result.limit.lower_m < result.limit.upper_m)) {
    at_limit.fail("the lower limit must be below the upper one");
  }
  result.limit.velocity_mps = at_limit.positive("velocity");
  result.limit.acceleration_mps2 = at_limit.positive("acceleration");
  result.limit.jerk_mps3 = at_limit.positive("jerk");
  return result;
}

NozzleElement read_nozzle(const TiXmlElement& element, std::string_view origin) {
  const ElementReader reader(origin, element, "<nozzle>");
  reader.allow_only({"link", "footprint_radius"});
  return {element.Row(), reader.text("link"), reader.positive("footprint_radius")};
}

CameraElement read_camera(const TiXmlElement& element, std::string_view origin) {
  const ElementReader reader(origin, element, "<camera>");
  reader.allow_only({"link", "width", "height", "fx", "fy", "cx", "cy"});
  return {element.Row(),
          reader.text("link"),
          {.width_px = reader.size_px("width"),
           .height_px = reader.size_px("height"),
           .fx_px = reader.positive("fx"),
           .fy_px = reader.positive("fy"),
           .cx_px = reader.number("cx"),
           .cy_px = reader.number("cy")}};
}

void read_furrow(const TiXmlElement& furrow, std::string_view origin, UrdfExtensions& result) {
  const ElementReader reader(origin, furrow, "<furrow>");
  reader.allow_only({"base_link"});
  result.line = furrow.Row();
  if (furrow.Attribute("base_link") != nullptr) result.base_link = reader.text("base_link");
  for (const TiXmlElement* child = furrow.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string kind = child->Value();
    if (kind == "nozzle") {
      result.nozzles.push_back(read_nozzle(*child, origin));
    } else if (kind == "camera") {
      result.cameras.push_back(read_camera(*child, origin));
    } else {
      ElementReader(origin, *child, "<furrow>").fail("the element <" + kind + "> is not known");
    }
  }
}

}  // namespace

UrdfExtensions read_urdf_extensions(std::string_view urdf, std::string_view origin) {
  const std::string file(origin);
  TiXmlDocument document;
  // An embedded zero byte would end the text there and hide the rest.
  if (urdf.find('\0') != std::string_view::npos) {
    throw ConfigError({file, 0}, "urdf", "the text holds a zero byte");
  }
  document.Parse(std::string(urdf).c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (document.Error()) {
    throw ConfigError({file, document.ErrorRow()}, "xml", document.ErrorDesc());
  }
  const TiXmlElement* robot = document.FirstChildElement("robot");
  if (robot == nullptr) throw ConfigError({file, 0}, "urdf", "there is no <robot> element");

  UrdfExtensions result;
  for (const TiXmlElement* joint = robot->FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const char* type = joint->Attribute("type");
    if (type == nullptr || std::string_view(type) != "prismatic") continue;
    const std::string name = ElementReader(origin, *joint, "<joint>").text("name");
    result.prismatic[name] = read_prismatic(*joint, name, origin);
  }
  const TiXmlElement* furrow = robot->FirstChildElement("furrow");
  if (furrow == nullptr) {
    throw ConfigError({file, robot->Row()}, "<robot>",
                      "the element <furrow> with the nozzles and cameras is missing");
  }
  read_furrow(*furrow, origin, result);
  if (const TiXmlElement* second = furrow->NextSiblingElement("furrow"); second != nullptr) {
    ElementReader(origin, *second, "<furrow>").fail("there is a second <furrow> element");
  }
  return result;
}

}  // namespace furrow::geometry
