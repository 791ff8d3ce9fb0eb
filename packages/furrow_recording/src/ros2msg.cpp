#include "ros2msg.hpp"

#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace furrow::recording {
namespace {

struct Field {
  std::string type;    ///< of ROS, or "pkg::msg::Type"
  std::string suffix;  ///< "[]", "[9]", "[<=5]"
  std::string name;
};
using Structs = std::map<std::string, std::vector<Field>>;  ///< by "pkg::msg::Type"

std::vector<std::string> tokens_of(std::string_view idl) {
  std::vector<std::string> tokens;
  std::size_t at = 0;
  while (at < idl.size()) {
    const auto is_word = [&](std::size_t i) {
      return i < idl.size() && (std::isalnum(static_cast<unsigned char>(idl[i])) != 0 ||
                                idl[i] == '_' || idl[i] == '@');
    };
    if (std::isspace(static_cast<unsigned char>(idl[at])) != 0) {
      ++at;
    } else if (idl.substr(at, 2) == "//") {
      at = std::min(idl.find('\n', at), idl.size());
    } else if (is_word(at)) {
      // Scoped names are one token.
      const std::size_t start = at;
      while (is_word(at) || (idl.substr(at, 2) == "::" && is_word(at + 2))) {
        at += idl[at] == ':' ? 2 : 1;
      }
      tokens.emplace_back(idl.substr(start, at - start));
    } else {
      tokens.emplace_back(1, idl[at++]);
    }
  }
  return tokens;
}

const std::map<std::string, std::string, std::less<>>& primitive_types() {
  static const std::map<std::string, std::string, std::less<>> types = {
      {"boolean", "bool"},    {"octet", "uint8"},          {"char", "char"},
      {"float", "float32"},   {"double", "float64"},       {"string", "string"},
      {"wstring", "wstring"}, {"short", "int16"},          {"unsigned short", "uint16"},
      {"long", "int32"},      {"unsigned long", "uint32"}, {"long long", "int64"},
      {"int8", "int8"},       {"uint8", "uint8"},          {"int16", "int16"},
      {"uint16", "uint16"},   {"int32", "int32"},          {"uint32", "uint32"},
      {"int64", "int64"},     {"uint64", "uint64"},        {"unsigned long long", "uint64"},
  };
  return types;
}

/// Modules and structs with fields of names, sequences, strings and arrays of one dimension.
class Parser {
 public:
  explicit Parser(std::string_view idl) : tokens_(tokens_of(idl)) {}

  std::optional<Structs> run() {
    while (at_ < tokens_.size()) {
      if (accept("module")) {
        scopes_.push_back(take());
        if (!accept("{")) {
          return std::nullopt;
        }
      } else if (accept("struct")) {
        if (!parse_struct()) {
          return std::nullopt;
        }
      } else if (accept("}")) {
        if (scopes_.empty() || !accept(";")) {
          return std::nullopt;
        }
        scopes_.pop_back();
      } else if (!tokens_[at_].starts_with('@')) {
        return std::nullopt;
      } else {
        ++at_;
      }
    }
    return scopes_.empty() ? std::optional(std::move(structs_)) : std::nullopt;
  }

 private:
  [[nodiscard]] bool accept(std::string_view token) {
    const bool is_it = at_ < tokens_.size() && tokens_[at_] == token;
    at_ += is_it ? 1 : 0;
    return is_it;
  }
  std::string take() { return at_ < tokens_.size() ? tokens_[at_++] : std::string(); }

  bool parse_struct() {
    std::string name;
    for (const std::string& scope : scopes_) {
      name += scope + "::";
    }
    name += take();
    if (!accept("{")) {
      return false;
    }
    std::vector<Field> fields;
    while (!accept("}")) {
      auto field = parse_field();
      if (!field) {
        return false;
      }
      fields.push_back(std::move(*field));
    }
    structs_[name] = std::move(fields);
    return accept(";");
  }

  std::optional<Field> parse_field() {
    Field field;
    if (accept("sequence")) {
      if (!accept("<")) {
        return std::nullopt;
      }
      field.type = parse_type();
      field.suffix = accept(",") ? "[<=" + take() + "]" : "[]";
      if (!accept(">")) {
        return std::nullopt;
      }
    } else {
      field.type = parse_type();
    }
    field.name = take();
    if (accept("[")) {
      if (!field.suffix.empty()) {
        return std::nullopt;
      }
      field.suffix = "[" + take() + "]";
      if (!accept("]")) {
        return std::nullopt;
      }
    }
    return accept(";") && !field.type.empty() ? std::optional(std::move(field)) : std::nullopt;
  }

  /// Empty when it is none.
  std::string parse_type() {
    std::string type = take();
    while (type == "unsigned" || type == "long" || type == "unsigned long") {
      if (at_ < tokens_.size() && (tokens_[at_] == "long" || tokens_[at_] == "short")) {
        type += " " + take();
      } else {
        break;
      }
    }
    if (const auto at = primitive_types().find(type); at != primitive_types().end()) {
      return at->second;
    }
    return type.find("::") != std::string::npos ? type : std::string();
  }

  std::vector<std::string> tokens_;
  std::size_t at_ = 0;
  std::vector<std::string> scopes_;
  Structs structs_;
};

/// "pkg/msg/Type" for the root's name, "pkg/Type" inside definitions.
std::string slashed(const std::string& scoped, std::string_view between) {
  const std::size_t first = scoped.find("::");
  const std::size_t last = scoped.rfind("::");
  return scoped.substr(0, first) + std::string(between) + scoped.substr(last + 2);
}

}  // namespace

Result<std::string> ros2msg_from_idl(std::string_view idl, std::string_view ros_name) {
  const auto structs = Parser(idl).run();
  if (!structs) {
    return Error{ErrorCode::kParse, "this IDL has no like in ROS 2 messages"};
  }
  std::vector<std::string> wanted;
  for (const auto& [name, fields] : *structs) {
    if (slashed(name, "/msg/") == ros_name) {
      wanted.push_back(name);
    }
  }
  if (wanted.empty()) {
    return Error{ErrorCode::kNotFound, "the IDL does not hold " + std::string(ros_name)};
  }
  std::set<std::string> known(wanted.begin(), wanted.end());
  std::string text;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::string name = wanted[i];
    if (i > 0) {
      text += std::string(80, '=') + "\nMSG: " + slashed(name, "/") + "\n";
    }
    for (const Field& field : structs->at(name)) {
      const bool nested = field.type.find("::") != std::string::npos;
      if (nested && !structs->contains(field.type)) {
        return Error{ErrorCode::kNotFound, "the IDL does not hold " + field.type};
      }
      if (nested && known.insert(field.type).second) {
        wanted.push_back(field.type);
      }
      text +=
          (nested ? slashed(field.type, "/") : field.type) + field.suffix + " " + field.name + "\n";
    }
  }
  return text;
}

}  // namespace furrow::recording
