#include "furrow_msgs/idl_schema.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace furrow::msgs {
namespace {

constexpr std::array<std::string_view, 12> kPrimitives = {
    "boolean",       "octet",          "char",
    "short",         "unsigned short", "long",
    "unsigned long", "long long",      "unsigned long long",
    "float",         "double",         "string"};

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
  explicit Parser(std::string_view idl) : tokens_(tokenize(idl)) {}

  Result<Structs> parse() {
    while (at_ < tokens_.size() && !fault_) definition("");
    if (fault_) return *fault_;
    return structs_;
  }

 private:
  [[nodiscard]] std::string_view peek() const {
    return at_ < tokens_.size() ? std::string_view(tokens_[at_].text) : std::string_view();
  }
  std::string take() {
    if (at_ < tokens_.size()) return tokens_[at_++].text;
    fail("the text ends too early");
    return "";
  }
  void fail(const std::string& what) {
    if (fault_) return;
    const int line = tokens_.empty() ? 1 : tokens_[std::min(at_, tokens_.size() - 1)].line;
    fault_ = Error{ErrorCode::kParse, "IDL line " + std::to_string(line) + ": " + what};
  }
  void expect(std::string_view text) {
    if (peek() != text)
      fail("'" + std::string(text) + "' is needed, not '" + std::string(peek()) + "'");
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
      structs_[name] = std::move(members);
    } else {
      fail("'" + keyword + "' is not understood");
    }
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
        take();
      }
      expect(">");
    } else {
      member.type = type();
    }
    member.name = take();
    if (peek() == "[") {
      take();
      const std::string size = take();
      const bool number =
          !size.empty() && size.size() < 9 &&
          std::ranges::all_of(size, [](unsigned char c) { return std::isdigit(c) != 0; });
      if (!number || size == "0") fail("'" + size + "' is not an array's size");
      if (!fault_) member.array_size = std::stoul(size);
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
    if (!known && !structs_.contains(name)) fail("type '" + name + "' is not known");
    return name;
  }

  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  Structs structs_;
  std::optional<Error> fault_;
};

}  // namespace

Result<IdlSchema> IdlSchema::parse(std::string_view idl) {
  auto structs = Parser(idl).parse();
  if (!structs.ok()) return structs.error();
  IdlSchema schema;
  schema.structs_ = std::move(structs).value();
  return schema;
}

const std::vector<IdlMember>* IdlSchema::find(const std::string& struct_name) const {
  const auto it = structs_.find(struct_name);
  return it == structs_.end() ? nullptr : &it->second;
}

}  // namespace furrow::msgs
