#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace furrow::annotation {

/// A malformed entry, thrown on its way to the Error or the report that names it.
struct Malformed {
  std::string key;      ///< "annotations[3].bbox"
  std::string message;  ///< the same for each entry with this fault
};

/// A JSON value and the key under which it stands. Does not own the value. Accessors throw
/// Malformed.
class JsonNode {
 public:
  JsonNode(const nlohmann::json& json, std::string key);

  /// Whether the object has this member, and not null.
  [[nodiscard]] bool has(const char* name) const;
  [[nodiscard]] JsonNode at(const char* name) const;
  [[nodiscard]] JsonNode entry(std::size_t i) const;
  /// The length of a list.
  [[nodiscard]] std::size_t size() const;
  /// Finite.
  [[nodiscard]] double number() const;
  /// Also a number such as 640.0, which some exporters write.
  [[nodiscard]] std::int64_t integer(std::int64_t low, std::int64_t high) const;
  [[nodiscard]] std::int64_t id() const;
  [[nodiscard]] std::string text() const;
  /// A boolean, 0 or 1.
  [[nodiscard]] bool truth() const;
  /// Whether the object has this member, and it is true.
  [[nodiscard]] bool is_true(const char* name) const;
  /// Whether the object has this member, and it is this text.
  [[nodiscard]] bool is_text(const char* name, const char* text) const;
  [[nodiscard]] bool is_object() const;
  [[nodiscard]] bool is_string() const;
  [[nodiscard]] const std::string& key() const { return key_; }

 private:
  [[nodiscard]] std::string path(const char* name) const;
  const nlohmann::json& json_;
  std::string key_;
};

}  // namespace furrow::annotation
