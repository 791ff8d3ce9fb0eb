#include "furrow_msgs/idl_schema.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <utility>

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
  std::string before = {};  ///< lines of comment right before its line
  std::string after = {};   ///< comment behind it on its line
};

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Splits a text into tokens, with the comments at them.
class Tokenizer {
 public:
  explicit Tokenizer(std::string_view idl) : idl_(idl) {}

  std::vector<Token> run() {
    while (at_ < idl_.size()) {
      const char c = idl_[at_];
      if (c == '\n') {
        line_end();
      } else if (idl_.substr(at_, 2) == "//") {
        comment(rest_of_line());
      } else if (c == '#') {
        (void)rest_of_line();
      } else if (std::isspace(static_cast<unsigned char>(c)) != 0) {
        ++at_;
      } else {
        token(idl_.substr(at_, length_of_token()));
      }
    }
    return std::move(tokens_);
  }

 private:
  [[nodiscard]] std::size_t length_of_token() const {
    std::size_t length = 0;
    while (at_ + length < idl_.size() && is_word(idl_[at_ + length])) ++length;
    if (length > 0) return length;
    return idl_.substr(at_, 2) == "::" ? 2 : 1;
  }
  void token(std::string_view text) {
    tokens_.push_back({std::string(text), line_, std::exchange(pending_, {})});
    at_ += text.size();
    empty_line_ = false;
  }
  void line_end() {
    if (empty_line_) pending_.clear();
    empty_line_ = true;
    ++line_;
    ++at_;
  }
  std::string_view rest_of_line() {
    const std::string_view rest = idl_.substr(at_, idl_.find('\n', at_) - at_);
    at_ += rest.size();
    empty_line_ = false;
    return rest;
  }
  void comment(std::string_view text) {
    const std::size_t first = text.find_first_not_of("/ \t");
    text = first == std::string_view::npos ? std::string_view() : text.substr(first);
    if (!tokens_.empty() && tokens_.back().line == line_) {
      tokens_.back().after = text;
    } else {
      pending_.append(text).append("\n");
    }
  }

  std::string_view idl_;
  std::size_t at_ = 0;
  int line_ = 1;
  bool empty_line_ = true;
  std::string pending_;  ///< comment before the next token
  std::vector<Token> tokens_;
};

/// A recursive descent parser; it stops at the first error.
class Parser {
 public:
  using Structs = std::map<std::string, std::vector<IdlMember>>;
  using Constants = std::map<std::string, std::vector<IdlConstant>>;
  explicit Parser(std::string_view idl) : tokens_(Tokenizer(idl).run()) {}

  Status parse() {
    while (at_ < tokens_.size() && !fault_) definition("");
    if (fault_) return *fault_;
    return {};
  }
  Structs structs;
  Constants constants;
  std::map<std::string, std::string> comments;  ///< of modules NAME_Constants, by NAME
  std::set<std::string> final;
  std::vector<std::string> order;

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
    bool is_final = false;
    while (peek() == "@" && !fault_) is_final |= annotation() == "final";
    const std::string comment = at_ < tokens_.size() ? tokens_[at_].before : "";
    const std::string keyword = take();
    if (keyword == "module") {
      const std::string name = take();
      const std::string inner = scope + name + "::";
      if (name.ends_with(kConstants)) {
        comments[scope + name.substr(0, name.size() - kConstants.size())] = comment;
      }
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
      order.push_back(name);
      if (is_final) final.insert(name);
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
    if (at_ < tokens_.size()) constant.comment = tokens_[at_].after;
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

  /// The name of the annotation.
  std::string annotation() {
    expect("@");
    std::string name = take();
    if (peek() != "(") return name;
    while (peek() != ")" && !fault_) take();
    expect(")");
    return name;
  }

  IdlMember member() {
    while (peek() == "@" && !fault_) (void)annotation();
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
  schema.comments_ = std::move(parser.comments);
  schema.final_ = std::move(parser.final);
  schema.order_ = std::move(parser.order);
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

std::string IdlSchema::comment_of_constants(const std::string& struct_name) const {
  const auto it = comments_.find(struct_name);
  return it == comments_.end() ? std::string() : it->second;
}

bool IdlSchema::is_final(const std::string& struct_name) const {
  return final_.contains(struct_name);
}

}  // namespace furrow::msgs
