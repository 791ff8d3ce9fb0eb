#include "furrow_field/field_geojson.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "furrow_geometry/geodetic.hpp"

namespace furrow::field {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

Result<geometry::FieldGeoreference> georeference(const GeoOrigin& origin) {
  return geometry::FieldGeoreference::at(
      {origin.latitude_deg, origin.longitude_deg, origin.altitude_m}, origin.heading_rad);
}

class GeoJsonReader {
 public:
  GeoJsonReader(std::string_view file, const std::optional<GeoOrigin>& origin)
      : file_(file), origin_(origin) {}

  Result<FieldModel> read(const Json& root) {
    if (!root.is_object() || root.value("type", Json()) != "FeatureCollection") {
      return fail("type", "not a FeatureCollection");
    }
    if (root.contains("furrow")) {
      if (Status status = read_header(root["furrow"]); !status.ok()) return status.error();
    } else {
      geographic_ = true;
    }
    if (geographic_ && !origin_) {
      return fail("furrow", "the coordinates are WGS 84: an origin must be given");
    }
    if (geographic_) {
      auto made = georeference(*origin_);
      if (!made) return fail("origin", "is not on the earth: " + made.error().message);
      georeference_ = *made;
    }
    if (!root.contains("features") || !root["features"].is_array()) {
      return fail("features", "is not a list");
    }
    const Json& features = root["features"];
    if (features.size() > kMaxPlants) return fail("features", "more than 1000000 plants");
    field_.plants.reserve(features.size());
    for (std::size_t i = 0; i < features.size(); ++i) {
      where_ = "feature " + std::to_string(i) + ": ";
      if (Status status = read_feature(features[i], i); !status.ok()) return status.error();
    }
    complete();
    if (Status status = validate(field_); !status.ok()) {
      return Error{status.error().code, file_ + ": " + status.error().message};
    }
    return std::move(field_);
  }

 private:
  [[nodiscard]] Error fail(const std::string& key, const std::string& message) const {
    return {ErrorCode::kParse, file_ + ": " + where_ + key + ": " + message};
  }

  /// Puts the member into the target when it is there; an Error when it has another type.
  Status number(const Json& object, const char* key, double& target) const {
    const auto found = object.find(key);
    if (found == object.end()) return {};
    if (!found->is_number()) return fail(key, "is not a number");
    target = found->get<double>();
    return std::isfinite(target) ? Status() : fail(key, "is not finite");
  }
  Status text(const Json& object, const char* key, std::string& target) const {
    const auto found = object.find(key);
    if (found == object.end()) return {};
    if (!found->is_string()) return fail(key, "is not a text");
    target = found->get<std::string>();
    return {};
  }
  template <class Integer>
  Status integer(const Json& object, const char* key, Integer& target) const {
    const auto found = object.find(key);
    if (found == object.end()) return {};
    if (!found->is_number_integer()) return fail(key, "is not a whole number");
    // An unsigned value above the signed range would wrap around.
    if (found->is_number_unsigned() &&
        found->get<std::uint64_t>() > static_cast<std::uint64_t>(kLargest<Integer>)) {
      return fail(key, "is too large");
    }
    const auto value = found->get<std::int64_t>();
    if (value < std::numeric_limits<Integer>::min() || value > kLargest<Integer>) {
      return fail(key, "is out of range");
    }
    target = static_cast<Integer>(value);
    return {};
  }
  template <class Integer>
  static constexpr Integer kLargest = std::numeric_limits<Integer>::max();

  Status read_header(const Json& header) {
    if (!header.is_object()) return fail("furrow", "is not an object");
    std::string coordinates;
    if (Status s = text(header, "coordinates", coordinates); !s.ok()) return s;
    if (coordinates != "field" && coordinates != "wgs84") {
      return fail("furrow.coordinates", "must be 'field' or 'wgs84'");
    }
    geographic_ = coordinates == "wgs84";
    if (Status s = text(header, "name", field_.name); !s.ok()) return s;
    if (Status s = text(header, "source", field_.source); !s.ok()) return s;
    if (Status s = number(header, "length_m", field_.length_m); !s.ok()) return s;
    if (Status s = number(header, "width_m", field_.width_m); !s.ok()) return s;
    has_extent_ = header.contains("length_m") && header.contains("width_m");
    if (const auto rows = header.find("row_y_m"); rows != header.end()) {
      if (!rows->is_array()) return fail("row_y_m", "is not a list");
      for (const Json& row : *rows) {
        if (!row.is_number()) return fail("row_y_m", "holds something else than numbers");
        field_.row_y_m.push_back(row.get<double>());
      }
    }
    return geographic_ && !origin_ ? read_origin(header) : Status();
  }

  Status read_origin(const Json& header) {
    const auto origin = header.find("origin");
    if (origin == header.end() || !origin->is_object()) return fail("origin", "is missing");
    for (const char* key : {"latitude_deg", "longitude_deg", "heading_rad"}) {
      if (!origin->contains(key)) return fail(std::string("origin.") + key, "is missing");
    }
    GeoOrigin value;
    if (Status s = number(*origin, "latitude_deg", value.latitude_deg); !s.ok()) return s;
    if (Status s = number(*origin, "longitude_deg", value.longitude_deg); !s.ok()) return s;
    if (Status s = number(*origin, "heading_rad", value.heading_rad); !s.ok()) return s;
    if (Status s = number(*origin, "altitude_m", value.altitude_m); !s.ok()) return s;
    origin_ = value;
    return {};
  }

  Status read_feature(const Json& feature, std::size_t index) {
    if (!feature.is_object()) return fail("feature", "is not an object");
    const auto geometry = feature.find("geometry");
    if (geometry == feature.end() || !geometry->is_object() ||
        geometry->value("type", Json()) != "Point") {
      return fail("geometry", "is not a Point");
    }
    const auto coordinates = geometry->find("coordinates");
    if (coordinates == geometry->end() || !coordinates->is_array() || coordinates->size() < 2 ||
        !(*coordinates)[0].is_number() || !(*coordinates)[1].is_number()) {
      return fail("coordinates", "are not two numbers");
    }
    const Eigen::Vector2d point((*coordinates)[0].get<double>(), (*coordinates)[1].get<double>());
    const auto properties = feature.find("properties");
    if (properties == feature.end() || !properties->is_object()) {
      return fail("properties", "is not an object");
    }
    Plant plant;
    plant.id = static_cast<std::int64_t>(index);
    plant.p_F_m = geographic_ ? georeference_->from_lon_lat_deg(point) : point;
    if (!plant.p_F_m.allFinite()) {
      return fail("coordinates", "are not longitude and latitude of a place near the origin");
    }
    std::string kind;
    if (Status s = text(*properties, "kind", kind); !s.ok()) return s;
    if (!plant_kind_from(kind)) return fail("kind", "must be 'crop' or 'weed'");
    plant.kind = *plant_kind_from(kind);
    if (Status s = text(*properties, "species", plant.species); !s.ok()) return s;
    if (Status s = integer(*properties, "id", plant.id); !s.ok()) return s;
    if (Status s = integer(*properties, "leaves", plant.leaves); !s.ok()) return s;
    if (Status s = number(*properties, "radius_m", plant.radius_m); !s.ok()) return s;
    if (Status s = number(*properties, "area_mm2", plant.area_mm2); !s.ok()) return s;
    if (Status s = number(*properties, "heading_rad", plant.heading_rad); !s.ok()) return s;
    field_.plants.push_back(std::move(plant));
    return {};
  }

  void complete() {
    sort_plants(field_);
    if (field_.source.empty()) field_.source = "imported: " + file_;
    double length_m = 0.0;
    double half_width_m = 0.0;
    for (const Plant& plant : field_.plants) {
      length_m = std::max(length_m, plant.p_F_m.x());
      half_width_m = std::max(half_width_m, std::abs(plant.p_F_m.y()));
    }
    if (!has_extent_) {
      field_.length_m = length_m;
      field_.width_m = 2.0 * half_width_m;
    }
    if (geographic_) {
      for (Plant& plant : field_.plants) pull_inside(plant.p_F_m);
    }
    sort_plants(field_);
  }

  /// A plant on the field's edge may come back from degrees some nanometres outside.
  void pull_inside(Eigen::Vector2d& p_m) const {
    constexpr double kRounding_m = 1e-6;
    const auto pull = [](double value, double low, double high) {
      const double inside = std::clamp(value, low, std::max(low, high));
      return std::abs(inside - value) <= kRounding_m ? inside : value;
    };
    p_m.x() = pull(p_m.x(), 0.0, field_.length_m);
    p_m.y() = pull(p_m.y(), -0.5 * field_.width_m, 0.5 * field_.width_m);
  }

  std::string file_;
  std::optional<GeoOrigin> origin_;
  std::optional<geometry::FieldGeoreference> georeference_;  ///< where the coordinates are WGS 84
  std::string where_;
  FieldModel field_;
  bool geographic_ = false;
  bool has_extent_ = false;
};

OrderedJson header_of(const FieldModel& field, const std::optional<GeoOrigin>& origin) {
  OrderedJson header;
  header["coordinates"] = origin ? "wgs84" : "field";
  header["name"] = field.name;
  header["source"] = field.source;
  header["length_m"] = field.length_m;
  header["width_m"] = field.width_m;
  header["row_y_m"] = field.row_y_m;
  if (origin) {
    header["origin"] = {{"latitude_deg", origin->latitude_deg},
                        {"longitude_deg", origin->longitude_deg},
                        {"altitude_m", origin->altitude_m},
                        {"heading_rad", origin->heading_rad}};
  }
  return header;
}

}  // namespace

Result<std::string> to_geojson(const FieldModel& field, const std::optional<GeoOrigin>& origin) {
  if (Status status = validate(field); !status.ok()) return status.error();
  std::optional<geometry::FieldGeoreference> earth;
  if (origin) {
    auto made = georeference(*origin);
    if (!made) return Error{ErrorCode::kOutOfRange, "the origin: " + made.error().message};
    earth = *made;
  }
  OrderedJson features = OrderedJson::array();
  for (const Plant& plant : field.plants) {
    const Eigen::Vector2d point = earth ? earth->to_lon_lat_deg(plant.p_F_m) : plant.p_F_m;
    OrderedJson feature;
    feature["type"] = "Feature";
    feature["geometry"] = {{"type", "Point"}, {"coordinates", {point.x(), point.y()}}};
    feature["properties"] = {{"id", plant.id},
                             {"kind", to_string(plant.kind)},
                             {"species", plant.species},
                             {"radius_m", plant.radius_m},
                             {"area_mm2", plant.area_mm2},
                             {"leaves", plant.leaves},
                             {"heading_rad", plant.heading_rad}};
    features.push_back(std::move(feature));
  }
  OrderedJson root;
  root["type"] = "FeatureCollection";
  root["furrow"] = header_of(field, origin);
  root["features"] = std::move(features);
  try {
    return root.dump(1) + "\n";
  } catch (const Json::exception& error) {
    return Error{ErrorCode::kInvalidArgument, std::string("a text is not UTF-8: ") + error.what()};
  }
}

Result<FieldModel> from_geojson(std::string_view text, std::string_view file,
                                const std::optional<GeoOrigin>& origin) {
  try {
    return GeoJsonReader(file, origin).read(Json::parse(text));
  } catch (const Json::exception& error) {
    return Error{ErrorCode::kParse, std::string(file) + ": " + error.what()};
  }
}

}  // namespace furrow::field
