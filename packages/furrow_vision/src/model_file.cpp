#include "furrow_vision/model_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "furrow_core/file.hpp"
#include "sha256.hpp"

namespace furrow::vision {
namespace {

/// On its way to the Error that names the file.
struct Malformed {
  int line = 0;
  std::string key;
  std::string message;
};

int line_of(const YAML::Node& node) {
  return std::max(0, node.Mark().line + 1);
}

YAML::Node needed(const YAML::Node& map, const std::string& key) {
  const YAML::Node value = map[key];
  if (!value.IsDefined() || value.IsNull()) throw Malformed{line_of(map), key, "is missing"};
  return value;
}

std::string text(const YAML::Node& map, const std::string& key) {
  const YAML::Node value = needed(map, key);
  if (!value.IsScalar() || value.Scalar().empty()) {
    throw Malformed{line_of(value), key, "is not a text"};
  }
  return value.Scalar();
}

template <class Number>
Number number(const YAML::Node& value, const std::string& key, Number low, Number high) {
  Number result{};
  if (!value.IsScalar() || !YAML::convert<Number>::decode(value, result)) {
    throw Malformed{line_of(value), key, "is not a number"};
  }
  if (!(result >= low && result <= high)) {
    throw Malformed{line_of(value), key, "is out of range"};
  }
  return result;
}

std::vector<double> numbers(const YAML::Node& map, const std::string& key, double low,
                            double high) {
  const YAML::Node list = needed(map, key);
  constexpr std::size_t kMost = 16;
  if (!list.IsSequence() || list.size() == 0 || list.size() > kMost) {
    throw Malformed{line_of(list), key, "is not a list of 1 to 16 numbers"};
  }
  std::vector<double> result;
  for (const YAML::Node& entry : list) result.push_back(number<double>(entry, key, low, high));
  return result;
}

void check_keys(const YAML::Node& map, const std::set<std::string>& known,
                const std::string& where) {
  if (!map.IsMap()) throw Malformed{line_of(map), where, "is not a map of keys"};
  for (const auto& entry : map) {
    if (!entry.first.IsScalar() || !known.contains(entry.first.Scalar())) {
      throw Malformed{line_of(entry.first),
                      entry.first.IsScalar() ? entry.first.Scalar() : std::string(),
                      "is not a key of a model file"};
    }
  }
}

std::vector<SubClass> classes_of(const YAML::Node& root) {
  const YAML::Node list = needed(root, "classes");
  constexpr std::size_t kMost = 1000;
  if (!list.IsSequence() || list.size() == 0 || list.size() > kMost) {
    throw Malformed{line_of(list), "classes", "is not a list of 1 to 1000 classes"};
  }
  std::vector<SubClass> classes;
  std::set<std::string> names;
  for (const YAML::Node& entry : list) {
    check_keys(entry, {"name", "kind"}, "classes");
    const std::string kind = text(entry, "kind");
    if (kind != "crop" && kind != "weed") {
      throw Malformed{line_of(entry), "kind", "is '" + kind + "', not crop or weed"};
    }
    classes.push_back(
        {text(entry, "name"), kind == "crop" ? SubClassKind::kCrop : SubClassKind::kWeed});
    if (!names.insert(classes.back().name).second) {
      throw Malformed{line_of(entry), "name", "'" + classes.back().name + "' stands twice"};
    }
  }
  return classes;
}

ModelPart part(const YAML::Node& root, const std::string& name,
               const std::filesystem::path& folder) {
  ModelPart part{.name = name, .path = folder / text(root, name)};
  const YAML::Node bytes = root[name + "_bytes"];
  if (bytes.IsDefined()) {
    part.bytes = number<std::int64_t>(bytes, name + "_bytes", std::int64_t{1}, kMaxNetworkBytes);
  }
  const YAML::Node sha256 = root[name + "_sha256"];
  if (sha256.IsDefined()) {
    part.sha256 = text(root, name + "_sha256");
    if (part.sha256.size() != 64 ||
        part.sha256.find_first_not_of("0123456789abcdef") != std::string::npos) {
      throw Malformed{line_of(sha256), name + "_sha256", "is not 64 lower-case hexadecimal digits"};
    }
  }
  if (part.bytes == 0 && part.sha256.empty()) {
    throw Malformed{line_of(root), name, "has neither " + name + "_bytes nor " + name + "_sha256"};
  }
  return part;
}

AnchorLayout anchors_of(const YAML::Node& root) {
  constexpr double kMost_px = 4096.0;
  const YAML::Node map = needed(root, "anchors");
  check_keys(map, {"sizes_px", "strides_px", "aspect_ratios"}, "anchors");
  AnchorLayout anchors{.sizes_px = numbers(map, "sizes_px", 1.0, kMost_px),
                       .strides_px = numbers(map, "strides_px", 1.0, kMost_px),
                       .aspect_ratios = numbers(map, "aspect_ratios", 0.01, 100.0)};
  if (anchors.sizes_px.size() != anchors.strides_px.size()) {
    throw Malformed{line_of(map), "anchors", "has not one size for each stride"};
  }
  return anchors;
}

ModelFile parse(const std::string& content, const std::filesystem::path& folder) {
  const YAML::Node root = YAML::Load(content);
  if (!root.IsMap()) throw Malformed{1, "", "is not a model file: no map of keys"};
  ModelFile model;
  const std::string kind = root["kind"].IsDefined() ? text(root, "kind") : "one_stage";
  std::set<std::string> known = {
      "kind", "name", "classes", "ground_resolution_mm_per_px", "input_channels", "crop_log_odds"};
  std::vector<std::string> parts;
  if (kind == "one_stage") {
    parts = {"network"};
    known.insert({"stride", "offset_unit_px"});
  } else if (kind == "mask_rcnn") {
    model.kind = ModelFile::Kind::kMaskRcnn;
    parts = {"backbone", "box_head", "mask_head"};
    known.insert({"anchors", "feature_levels", "stems"});
  } else {
    throw Malformed{line_of(root["kind"]), "kind", "'" + kind + "' is not one_stage or mask_rcnn"};
  }
  for (const std::string& name : parts) known.insert({name, name + "_bytes", name + "_sha256"});
  check_keys(root, known, "");
  model.name = text(root, "name");
  model.classes = classes_of(root);
  if (const YAML::Node channels = root["input_channels"]; channels.IsDefined()) {
    (void)number<int>(channels, "input_channels", 3, 3);
  }
  model.ground_resolution_mm_per_px = number<double>(needed(root, "ground_resolution_mm_per_px"),
                                                     "ground_resolution_mm_per_px", 0.01, 100.0);
  if (const YAML::Node odds = root["crop_log_odds"]; odds.IsDefined()) {
    model.crop_log_odds = number<double>(odds, "crop_log_odds", -10.0, 10.0);
  }
  if (model.kind == ModelFile::Kind::kOneStage) {
    model.stride_px = number<int>(needed(root, "stride"), "stride", 1, 32);
    model.offset_unit_px =
        number<double>(needed(root, "offset_unit_px"), "offset_unit_px", 0.1, 1e4);
  } else {
    model.anchors = anchors_of(root);
    model.feature_levels = number<int>(needed(root, "feature_levels"), "feature_levels", 1, 8);
    if (const YAML::Node stems = root["stems"]; stems.IsDefined()) {
      if (!stems.IsScalar() || !YAML::convert<bool>::decode(stems, model.stems)) {
        throw Malformed{line_of(stems), "stems", "is not true or false"};
      }
    }
  }
  for (const std::string& name : parts) model.parts.push_back(part(root, name, folder));
  return model;
}

}  // namespace

Result<ModelFile> read_model_file(const std::filesystem::path& path) {
  constexpr std::size_t kMaxBytes = 1 << 20;
  if (path.extension() == ".onnx" || path.extension() == ".pt") {
    auto model_file = path;
    return Error{ErrorCode::kInvalidArgument,
                 path.string() + ": a network; give the model file that describes it, such as " +
                     model_file.replace_extension(".yaml").string()};
  }
  const auto content = read_file(path, kMaxBytes);
  if (!content.ok()) return content.error();
  try {
    return parse(*content, path.parent_path());
  } catch (const Malformed& fault) {
    return Error{ErrorCode::kParse, path.string() + ":" + std::to_string(fault.line) + ": " +
                                        (fault.key.empty() ? "" : fault.key + ": ") +
                                        fault.message};
  } catch (const YAML::Exception& fault) {
    return Error{ErrorCode::kParse, path.string() + ":" + std::to_string(fault.mark.line + 1) +
                                        ": is not YAML: " + fault.msg};
  }
}

Result<std::string> read_model_part(const ModelPart& part) {
  auto content = read_file(part.path, static_cast<std::size_t>(kMaxNetworkBytes));
  if (!content.ok()) return content;
  if (part.bytes != 0 && static_cast<std::int64_t>(content->size()) != part.bytes) {
    return Error{ErrorCode::kParse,
                 part.path.string() + ": has " + std::to_string(content->size()) +
                     " bytes, the model file "
                     "says " +
                     std::to_string(part.bytes) + ": truncated, or of another model"};
  }
  if (!part.sha256.empty() && sha256_hex(*content) != part.sha256) {
    return Error{ErrorCode::kParse, part.path.string() +
                                        ": its SHA-256 is not that of the model file: damaged, or "
                                        "of another model"};
  }
  return content;
}

const ModelPart& part_of(const ModelFile& model, const std::string& name) {
  return *std::find_if(model.parts.begin(), model.parts.end(),
                       [&](const ModelPart& part) { return part.name == name; });
}

Status check_classes(const ModelFile& model, const std::vector<std::string>& expected) {
  if (expected.empty()) return {};
  const bool same =
      std::equal(expected.begin(), expected.end(), model.classes.begin(), model.classes.end(),
                 [](const std::string& name, const SubClass& c) { return name == c.name; });
  if (same) return {};
  const auto join = [](const auto& list, const auto& name_of) {
    std::string joined;
    for (const auto& entry : list) joined += (joined.empty() ? "" : ", ") + name_of(entry);
    return joined;
  };
  return Error{ErrorCode::kInvalidArgument,
               "model '" + model.name + "' has the classes " +
                   join(model.classes, [](const SubClass& c) { return c.name; }) + ", not " +
                   join(expected, [](const std::string& name) { return name; })};
}

}  // namespace furrow::vision
