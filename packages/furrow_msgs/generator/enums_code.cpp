#include <algorithm>
#include <cctype>
#include <map>

#include "generated_code.hpp"

namespace furrow::msgs {
namespace {

struct Enumeration {
  const IdlFile* file;
  std::string name;
  std::span<const IdlConstant> constants;
  std::string comment;
};

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// "SAFE_STATE" becomes "kSafeState".
std::string enumerator(const std::string& constant) {
  std::string name = "k";
  bool first = true;
  for (const char c : constant) {
    if (c != '_') name += first ? c : lower({c})[0];
    first = c == '_';
  }
  return name;
}

/// Replaces each "$KEY" of the text.
std::string filled(std::string text, const std::map<std::string, std::string>& values) {
  for (const auto& [key, value] : values) {
    for (auto at = text.find("$" + key); at != std::string::npos;
         at = text.find("$" + key, at + value.size())) {
      text.replace(at, key.size() + 1, value);
    }
  }
  return text;
}

constexpr const char* kDeclaration = R"code($COMMENTenum class $NAME : std::uint8_t {
$ENUMERATORS};
/// The constant's name in lower case, such as "$EXAMPLE".
[[nodiscard]] std::string_view to_string($NAME value);
/// The same of a message; "unknown (200)" where it holds none of the constants.
[[nodiscard]] std::string to_string(const $MESSAGE& message);
[[nodiscard]] $MESSAGE to_msg($NAME value);
/// False for a message that holds none of the constants.
[[nodiscard]] bool operator==(const $MESSAGE& message, $NAME value);
/// kOutOfRange: the message holds none of the constants.
[[nodiscard]] Result<$NAME> from_msg(const $MESSAGE& message);

)code";

constexpr const char* kDefinition = R"code(std::string_view to_string($NAME value) {
  switch (value) {
$TEXTS  }
  return "unknown";
}

std::string to_string(const $MESSAGE& message) {
  const auto value = from_msg(message);
  return value.ok() ? std::string(to_string(*value))
                    : "unknown (" + std::to_string(message.value()) + ")";
}

$MESSAGE to_msg($NAME value) {
  $MESSAGE message;
  message.value(static_cast<std::uint8_t>(value));
  return message;
}

bool operator==(const $MESSAGE& message, $NAME value) {
  return message.value() == static_cast<std::uint8_t>(value);
}

Result<$NAME> from_msg(const $MESSAGE& message) {
  switch (message.value()) {
$CASES      return static_cast<$NAME>(message.value());
    default:
      return unknown_value("$MODULE/$NAME", message.value());
  }
}

)code";

std::map<std::string, std::string> values_of(const Enumeration& e) {
  std::map<std::string, std::string> values = {{"NAME", e.name},
                                               {"MODULE", e.file->module},
                                               {"MESSAGE", e.file->scoped(e.name)},
                                               {"EXAMPLE", lower(e.constants.front().name)}};
  for (std::size_t at = 0; at < e.comment.size();) {
    const auto end = e.comment.find('\n', at);
    values["COMMENT"] += "/// " + e.comment.substr(at, end - at) + "\n";
    at = end + 1;
  }
  values.try_emplace("COMMENT");
  for (const IdlConstant& constant : e.constants) {
    values["ENUMERATORS"] += "  " + enumerator(constant.name) + " = " + constant.value + "," +
                             (constant.comment.empty() ? "" : "  ///< " + constant.comment) + "\n";
    values["TEXTS"] += "    case " + e.name + "::" + enumerator(constant.name) +
                       ":\n      return \"" + lower(constant.name) + "\";\n";
    values["CASES"] += "    case " + constant.value + ":\n";
  }
  return values;
}

std::vector<Enumeration> enumerations_of(const std::vector<IdlFile>& files) {
  std::vector<Enumeration> found;
  for (const IdlFile& file : files) {
    for (const std::string& name : file.names) {
      const std::string scoped = file.scoped(name);
      if (!file.schema.is_enumeration(scoped)) continue;
      found.push_back({&file, name, file.schema.constants_of(scoped),
                       file.schema.comment_of_constants(scoped)});
    }
  }
  return found;
}

/// The enumerations' message classes, by module.
std::string forward_declarations(const std::vector<Enumeration>& enumerations) {
  std::map<std::string, std::string> classes;
  for (const Enumeration& e : enumerations) classes[e.file->module] += "class " + e.name + ";\n";
  std::string text;
  for (const auto& [module, names] : classes) {
    text += "namespace " + module + "::msg {\n" + names + "}  // namespace " + module + "::msg\n\n";
  }
  return text;
}

}  // namespace

GeneratedCode enums_code(const std::vector<IdlFile>& files) {
  const std::vector<Enumeration> found = enumerations_of(files);
  std::string header =
      "// Generated from the IDL files.\n#pragma once\n\n#include <cstdint>\n#include <string>\n"
      "#include <string_view>\n\n#include \"furrow_core/result.hpp\"\n\n" +
      forward_declarations(found) + "namespace furrow::msgs {\n\n";
  std::string includes, definitions;
  const IdlFile* last = nullptr;
  for (const Enumeration& e : found) {
    if (e.file != last) includes += "#include \"furrow_msgs/" + e.file->stem + ".h\"\n";
    last = e.file;
    const auto values = values_of(e);
    header += filled(kDeclaration, values);
    definitions += filled(kDefinition, values);
  }
  header += "}  // namespace furrow::msgs\n";
  std::string source =
      "// Generated from the IDL files.\n#include \"furrow_msgs/enums.hpp\"\n\n" + includes +
      "\nnamespace furrow::msgs {\nnamespace {\n\n"
      "Error unknown_value(const char* type, int value) {\n  return {ErrorCode::kOutOfRange,\n"
      "          std::string(type) + \" has no value \" + std::to_string(value)};\n}\n\n"
      "}  // namespace\n\n" +
      definitions + "}  // namespace furrow::msgs\n";
  return {std::move(header), std::move(source)};
}

}  // namespace furrow::msgs
