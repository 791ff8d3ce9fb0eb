#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "furrow_field/annotations.hpp"

namespace furrow::field {
namespace {

using Json = nlohmann::json;

constexpr double kLargestSide_px = 100'000.0;

struct Category {
  CategoryMeaning meaning;
  std::optional<std::size_t> stem_keypoint;
};

class CocoReader {
 public:
  CocoReader(std::string_view file, const std::map<std::string, CategoryMeaning>& meanings)
      : file_(file), meanings_(meanings) {}

  Result<std::vector<AnnotatedImage>> read(const Json& root) {
    if (!root.is_object()) return fail("file", "is not a JSON object");
    for (const char* key : {"images", "annotations", "categories"}) {
      if (!root.contains(key) || !root[key].is_array()) return fail(key, "is not a list");
    }
    if (root["annotations"].size() > kMaxPlants) return fail("annotations", "more than 1000000");
    if (Status status = each(root, "categories", &CocoReader::read_category); !status.ok()) {
      return status.error();
    }
    if (Status status = each(root, "images", &CocoReader::read_image); !status.ok()) {
      return status.error();
    }
    if (Status status = each(root, "annotations", &CocoReader::read_annotation); !status.ok()) {
      return status.error();
    }
    return std::move(images_);
  }

 private:
  [[nodiscard]] Error fail(const std::string& key, const std::string& message,
                           ErrorCode code = ErrorCode::kParse) const {
    return {code, file_ + ": " + where_ + key + ": " + message};
  }

  Status each(const Json& root, const std::string& list,
              Status (CocoReader::*read_entry)(const Json&)) {
    const Json& entries = root[list];
    for (std::size_t i = 0; i < entries.size(); ++i) {
      where_ = list + "[" + std::to_string(i) + "]: ";
      if (!entries[i].is_object()) return fail("entry", "is not an object");
      if (Status status = (this->*read_entry)(entries[i]); !status.ok()) return status;
    }
    where_.clear();
    return {};
  }

  Result<std::int64_t> integer(const Json& object, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) return fail(key, "is missing");
    if (!found->is_number_integer()) return fail(key, "is not a whole number");
    return found->get<std::int64_t>();
  }
  Result<std::string> text(const Json& object, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) return fail(key, "is missing");
    if (!found->is_string()) return fail(key, "is not a text");
    return found->get<std::string>();
  }

  /// Categories are resolved only when an annotation uses them.
  Status read_category(const Json& entry) {
    const auto id = integer(entry, "id");
    if (!id.ok()) return id.error();
    const auto name = text(entry, "name");
    if (!name.ok()) return name.error();
    if (!categories_.emplace(*id, *name).second) return fail("id", "is not unique");
    if (const auto keypoints = entry.find("keypoints"); keypoints != entry.end()) {
      if (!keypoints->is_array()) return fail("keypoints", "is not a list");
      for (std::size_t i = 0; i < keypoints->size(); ++i) {
        if ((*keypoints)[i] == "stem") stem_keypoint_[*id] = i;
      }
    }
    return {};
  }

  Result<Category> category_of(std::int64_t id) const {
    const auto name = categories_.find(id);
    if (name == categories_.end()) {
      return fail("category_id", "there is no category " + std::to_string(id));
    }
    Category category;
    if (const auto stem = stem_keypoint_.find(id); stem != stem_keypoint_.end()) {
      category.stem_keypoint = stem->second;
    }
    if (const auto found = meanings_.find(name->second); found != meanings_.end()) {
      category.meaning = found->second;
    } else if (const auto kind = plant_kind_from(name->second); kind) {
      category.meaning.kind = *kind;
    } else {
      return fail("category_id",
                  "it is not said whether '" + name->second + "' is a crop or a weed",
                  ErrorCode::kNotFound);
    }
    return category;
  }

  Status read_image(const Json& entry) {
    const auto id = integer(entry, "id");
    if (!id.ok()) return id.error();
    const auto name = text(entry, "file_name");
    if (!name.ok()) return name.error();
    AnnotatedImage image;
    image.name = *name;
    for (auto [key, target] :
         {std::pair("width", &image.width_px), std::pair("height", &image.height_px)}) {
      const auto size = integer(entry, key);
      if (!size.ok()) return size.error();
      if (*size < 1 || *size > static_cast<std::int64_t>(kLargestSide_px)) {
        return fail(key, "must be in [1, 100000]", ErrorCode::kOutOfRange);
      }
      *target = static_cast<int>(*size);
    }
    if (!image_index_.emplace(*id, images_.size()).second) return fail("id", "is not unique");
    images_.push_back(std::move(image));
    return {};
  }

  Status read_annotation(const Json& entry) {
    const auto image_id = integer(entry, "image_id");
    if (!image_id.ok()) return image_id.error();
    const auto image = image_index_.find(*image_id);
    if (image == image_index_.end()) {
      return fail("image_id", "there is no image " + std::to_string(*image_id));
    }
    const auto category_id = integer(entry, "category_id");
    if (!category_id.ok()) return category_id.error();
    if (const auto crowd = entry.find("iscrowd"); crowd != entry.end()) {
      if (*crowd == 1 || *crowd == true) return {};
    }
    const auto category = category_of(*category_id);
    if (!category.ok()) return category.error();
    AnnotatedPlant plant;
    plant.kind = category->meaning.kind;
    plant.species = category->meaning.species;
    if (Status status = read_polygons(entry, plant); !status.ok()) return status;
    if (category->stem_keypoint) {
      if (Status s = read_stem(entry, *category->stem_keypoint, plant); !s.ok()) return s;
    }
    images_[image->second].plants.push_back(std::move(plant));
    return {};
  }

  Status read_polygons(const Json& entry, AnnotatedPlant& plant) const {
    const auto parts = entry.find("segmentation");
    if (parts == entry.end()) return fail("segmentation", "is missing");
    if (parts->is_object())
      return fail("segmentation", "run-length masks are not read; polygons are");
    if (!parts->is_array() || parts->empty()) return fail("segmentation", "holds no polygon");
    for (const Json& part : *parts) {
      if (!part.is_array() || part.size() < 6 || part.size() % 2 != 0) {
        return fail("segmentation", "a polygon needs an even number of coordinates, at least six");
      }
      Polygon polygon;
      polygon.reserve(part.size() / 2);
      for (std::size_t i = 0; i < part.size(); i += 2) {
        const auto point = pixel(part[i], part[i + 1]);
        if (!point) return fail("segmentation", "a coordinate is no number in [-100000, 100000]");
        polygon.push_back(*point);
      }
      plant.polygons_px.push_back(std::move(polygon));
    }
    return {};
  }

  Status read_stem(const Json& entry, std::size_t index, AnnotatedPlant& plant) const {
    const auto keypoints = entry.find("keypoints");
    if (keypoints == entry.end()) return {};
    if (!keypoints->is_array() || keypoints->size() < 3 * index + 3) {
      return fail("keypoints", "has fewer entries than the category's keypoints");
    }
    const Json& visibility = (*keypoints)[3 * index + 2];
    if (!visibility.is_number()) return fail("keypoints", "a visibility is not a number");
    if (visibility.get<double>() <= 0.0) return {};
    plant.stem_px = pixel((*keypoints)[3 * index], (*keypoints)[3 * index + 1]);
    return plant.stem_px ? Status()
                         : fail("keypoints", "a coordinate is no number in [-100000, 100000]");
  }

  /// COCO counts from the upper left corner of the image; here pixel (0, 0) is a pixel's centre.
  static std::optional<Eigen::Vector2d> pixel(const Json& u, const Json& v) {
    if (!u.is_number() || !v.is_number()) return std::nullopt;
    const Eigen::Vector2d point(u.get<double>() - 0.5, v.get<double>() - 0.5);
    if (!(point.cwiseAbs().maxCoeff() <= kLargestSide_px)) return std::nullopt;
    return point;
  }

  std::string file_;
  const std::map<std::string, CategoryMeaning>& meanings_;
  std::string where_;
  std::map<std::int64_t, std::string> categories_;
  std::map<std::int64_t, std::size_t> stem_keypoint_;
  std::map<std::int64_t, std::size_t> image_index_;
  std::vector<AnnotatedImage> images_;
};

}  // namespace

Result<std::vector<AnnotatedImage>> parse_coco(
    std::string_view json, std::string_view file,
    const std::map<std::string, CategoryMeaning>& meanings) {
  try {
    return CocoReader(file, meanings).read(Json::parse(json));
  } catch (const Json::exception& error) {
    return Error{ErrorCode::kParse, std::string(file) + ": " + error.what()};
  }
}

}  // namespace furrow::field
