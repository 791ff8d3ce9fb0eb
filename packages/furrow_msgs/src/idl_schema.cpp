#include "furrow_msgs/idl_schema.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace furrow::msgs {
namespace {

constexpr std::array<std::string_view, 20> kPrimitives = {"boolean",
                                                          "octet",
                                                          "char",
                                                          "short",
                                                          "unsigned short",
                                                          "long",
                                                          "unsigned long",
                                                          "int8",
                                                          "uint8",
                                                          "int16",
                                                          "uint16",
                                                          "int32",
                                                          "uint32",
                                                          "int64",
                                                          "uint64",
                                                          "float",
                                                          "long long",
                                                          "double",
                                                          "unsigned long long",
                                                          "string"};
constexpr std::string_view kConstants = "_Constants";

struct Token {
  std::string text;
  int line = 1;
};

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::vector<Token> tokenize(std::string_view idl) {
  std::vector<Token> tokens;
  int line = 1;
  for (std::size_t i = 0; i < idl.size();) {
    const char c = idl[i];
    if (c == '\n') ++line;
    if (idl.substr(i, 2) == "//" || c == '#') {
      while (i < idl.size() && idl[i] != '\n') ++i;
    } else if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++i;
    } else if (is_word(c)) {
      const std::size_t start = i;
      while (i < idl.size() && is_word(idl[i])) ++i;
      tokens.push_back({std::string(idl.substr(start, i - start)), line});
    } else if (idl.substr(i, 2) == "::") {
      tokens.push_back({"::", line});
      i += 2;
    } else {
      tokens.push_back({std::string(1, c), line});
      ++i;
    }
  }
  return tokens;
}

/// A recursive descent over the tokens; the first fault ends it.
class Parser {
 public:
  using Structs = std::map<std::string, std::vector<IdlMember>>;
  using Constants = std::map<std::string, std::vector<IdlConstant>>;
  explicit Parser(std::string_view idl) : tokens_(tokenize(idl)) {}

  Status parse() {
    while (at_ < tokens_.size() && !fault_) definition("");
    if (fault_) return *fault_;
    return {};
  }
  Structs structs;
  Constants constants;

 private:
  [[nodiscard]] std::string_view peek() const {
    return at_ < tokens_.size() ? std::string_view(tokens_[at_].text) : std::string_view();
  }
  std::string take() {
    if (at_ < tokens_.size()) return tokens_[at_++].text;
    fail("unexpected end of the text");
    return "";
  }
  void fail(const std::string& what) {
    if (fault_) return;
    const int line = tokens_.empty() ? 1 : tokens_[std::min(at_, tokens_.size() - 1)].line;
    fault_ = Error{ErrorCode::kParse, "IDL line " + std::to_string(line) + ": " + what};
  }
  void expect(std::string_view text) {
    if (peek() != text)
      fail("expected '" + std::string(text) + "', found '" + std::string(peek()) + "'");
    if (!fault_) ++at_;
  }

  void definition(const std::string& scope) {
    while (peek() == "@" && !fault_) annotation();
    const std::string keyword = take();
    if (keyword == "module") {
      const std::string inner = scope + take() + "::";
      expect("{");
      while (peek() != "}" && !fault_) definition(inner);
      expect("}");
      expect(";");
    } else if (keyword == "struct") {
      const std::string name = scope + take();
      expect("{");
      std::vector<IdlMember> members;
      while (peek() != "}" && !fault_) members.push_back(member());
      expect("}");
      expect(";");
      structs[name] = std::move(members);
    } else if (keyword == "const") {
      constant(scope);
    } else {
      fail("'" + keyword + "' is not supported");
    }
  }

  /// Only inside a module NAME_Constants, which ROS 2 attaches to struct NAME.
  void constant(std::string_view scope) {
    if (scope.ends_with("::")) scope.remove_suffix(2);
    if (!scope.ends_with(kConstants)) {
      fail("a constant must be in a module NAME_Constants");
      return;
    }
    scope.remove_suffix(kConstants.size());
    IdlConstant constant{.type = type()};
    if (constant.type == "string" || structs.contains(constant.type)) {
      fail("a constant of type '" + constant.type + "' is not supported");
    }
    constant.name = take();
    expect("=");
    if (peek() == "-") constant.value = take();
    constant.value += take();
    expect(";");
    constants[std::string(scope)].push_back(std::move(constant));
  }

  /// A size or bound: at most eight digits, not 0.
  std::size_t count(const char* what) {
    const std::string size = take();
    const bool number =
        !size.empty() && size.size() < 9 &&
        std::ranges::all_of(size, [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!number || size == "0") fail("'" + size + "' is not the " + what);
    return fault_ ? 0 : std::stoul(size);
  }

  void annotation() {
    expect("@");
    take();
    if (peek() != "(") return;
    while (peek() != ")" && !fault_) take();
    expect(")");
  }

  IdlMember member() {
    while (peek() == "@" && !fault_) annotation();
    IdlMember member;
    if (peek() == "sequence") {
      take();
      expect("<");
      member.sequence = true;
      member.type = type();
      if (peek() == ",") {
        take();
        member.bound = count("bound of a sequence");
      }
      expect(">");
    } else {
      member.type = type();
    }
    member.name = take();
    if (peek() == "[") {
      take();
      member.array_size = count("size of an array");
      expect("]");
    }
    expect(";");
    return member;
  }

  std::string type() {
    std::string name = take();
    if (name == "unsigned") name += " " + take();
    if (name.ends_with("long") && peek() == "long") name += " " + take();
    while (peek() == "::" && !fault_) {
      take();
      name += "::" + take();
    }
    const bool known = std::ranges::find(kPrimitives, name) != kPrimitives.end();
    if (!known && !structs.contains(name)) fail("type '" + name + "' is unknown");
    return name;
  }

  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::optional<Error> fault_;
};

}  // namespace

Result<IdlSchema> IdlSchema::parse(std::string_view idl) {
  Parser parser(idl);
  if (const Status parsed = parser.parse(); !parsed.ok()) return parsed.error();
  IdlSchema schema;
  schema.structs_ = std::move(parser.structs);
  schema.constants_ = std::move(parser.constants);
  return schema;
}

const std::vector<IdlMember>* IdlSchema::find(const std::string& struct_name) const {
  const auto it = structs_.find(struct_name);
  return it == structs_.end() ? nullptr : &it->second;
}

std::span<const IdlConstant> IdlSchema::constants_of(const std::string& struct_name) const {
  const auto it = constants_.find(struct_name);
  return it == constants_.end() ? std::span<const IdlConstant>() : std::span(it->second);
}

bool IdlSchema::is_enumeration(const std::string& struct_name) const {
  const auto* members = find(struct_name);
  if (members == nullptr || members->size() != 1 || constants_of(struct_name).empty()) return false;
  const IdlMember& member = members->front();
  return member.name == "value" && !member.sequence && member.array_size == 0 &&
         find(member.type) == nullptr;
}

std::vector<std::string> IdlSchema::struct_names() const {
  std::vector<std::string> names;
  names.reserve(structs_.size());
  for (const auto& [name, members] : structs_) names.push_back(name);
  return names;
}

}  // namespace furrow::msgs
