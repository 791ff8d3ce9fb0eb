#include "furrow_recording/message_schema.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <set>
#include <utility>

#include "furrow_core/text.hpp"
#include "furrow_msgs/idl_schema.hpp"

namespace furrow::recording {
namespace {

constexpr std::size_t kMaxTextBytes = 4u << 20;
constexpr std::size_t kMaxDepth = 64;
constexpr std::string_view kBlank = " \t\r\v\f";

struct Primitive {
  std::string_view name;
  FieldKind kind;
};
constexpr std::array kPrimitives = {
    Primitive{"bool", FieldKind::kBool},       Primitive{"byte", FieldKind::kUint8},
    Primitive{"char", FieldKind::kUint8},      Primitive{"int8", FieldKind::kInt8},
    Primitive{"uint8", FieldKind::kUint8},     Primitive{"int16", FieldKind::kInt16},
    Primitive{"uint16", FieldKind::kUint16},   Primitive{"int32", FieldKind::kInt32},
    Primitive{"uint32", FieldKind::kUint32},   Primitive{"int64", FieldKind::kInt64},
    Primitive{"uint64", FieldKind::kUint64},   Primitive{"float32", FieldKind::kFloat32},
    Primitive{"float64", FieldKind::kFloat64}, Primitive{"string", FieldKind::kString},
};
constexpr std::array kIdlPrimitives = {
    Primitive{"boolean", FieldKind::kBool},
    Primitive{"octet", FieldKind::kUint8},
    Primitive{"char", FieldKind::kUint8},
    Primitive{"short", FieldKind::kInt16},
    Primitive{"unsigned short", FieldKind::kUint16},
    Primitive{"long", FieldKind::kInt32},
    Primitive{"unsigned long", FieldKind::kUint32},
    Primitive{"long long", FieldKind::kInt64},
    Primitive{"unsigned long long", FieldKind::kUint64},
    Primitive{"float", FieldKind::kFloat32},
    Primitive{"double", FieldKind::kFloat64},
    Primitive{"string", FieldKind::kString},
};

template <class Table>
std::optional<FieldKind> find_primitive(const Table& table, std::string_view name) {
  const auto at = std::ranges::find(table, name, &Primitive::name);
  return at == table.end() ? std::nullopt : std::optional(at->kind);
}

bool is_word(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

std::optional<std::size_t> number(std::string_view text) {
  std::size_t value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = failure == std::errc() && end == text.data() + text.size();
  return whole ? std::optional(value) : std::nullopt;
}

/// Reads the lines of a definition.
class DefinitionParser {
 public:
  DefinitionParser(std::string_view text, std::string_view root, RosVersion version)
      : text_(text), version_(version) {
    schema_.root = short_type_name(root);
    type_ = schema_.root;
    package_ = type_.substr(0, type_.find('/'));
  }

  Result<MessageSchema> run() {
    if (text_.size() > kMaxTextBytes) {
      return Error{ErrorCode::kParse, "a message definition is longer than 4 MiB"};
    }
    schema_.structs[type_];
    if (version_ == RosVersion::kRos2) {
      add_time_types();
    }
    while (!text_.empty() && !fault_) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      ++line_;
      take_line(trimmed(text_.substr(0, end), kBlank));
      text_.remove_prefix(std::min(end + 1, text_.size()));
    }
    if (fault_) {
      return *fault_;
    }
    return std::move(schema_);
  }

 private:
  void fail(const std::string& what) {
    if (!fault_) {
      fault_ = Error{ErrorCode::kParse, "definition of " + schema_.root + ", line " +
                                            std::to_string(line_) + ": " + what};
    }
  }

  /// Definitions of ROS 2 need not hold these.
  void add_time_types() {
    for (const auto& [name, sec] : {std::pair("builtin_interfaces/Time", FieldKind::kInt32),
                                    std::pair("builtin_interfaces/Duration", FieldKind::kInt32)}) {
      schema_.structs[name].fields = {{"sec", sec, "", false, 0},
                                      {"nanosec", FieldKind::kUint32, "", false, 0}};
    }
  }

  void take_line(std::string_view line) {
    if (line.starts_with("===")) {
      return;
    }
    if (line.starts_with("MSG:")) {
      begin_type(trimmed(line.substr(4), kBlank));
      return;
    }
    if (line.empty() || line.starts_with('#')) {
      return;
    }
    const std::size_t space = line.find_first_of(kBlank);
    if (space == std::string_view::npos) {
      fail("'" + std::string(line.substr(0, 60)) + "' is not a field");
      return;
    }
    take_member(line.substr(0, space), trimmed(line.substr(space), kBlank));
  }

  void begin_type(std::string_view name) {
    type_ = short_type_name(name);
    const std::size_t slash = type_.find('/');
    if (slash == std::string::npos || !is_word(type_.substr(0, slash)) ||
        !is_word(type_.substr(slash + 1))) {
      fail("'" + type_.substr(0, 60) + "' is not a type");
      return;
    }
    package_ = type_.substr(0, slash);
    schema_.structs[type_] = {};
  }

  /// A field with its type, name and perhaps default, or a constant.
  void take_member(std::string_view type, std::string_view rest) {
    const std::size_t name_end = std::min(rest.find_first_of(" \t=#"), rest.size());
    const std::string_view name = rest.substr(0, name_end);
    const std::string_view behind = trimmed(rest.substr(name_end), kBlank);
    if (!is_word(name)) {
      fail("'" + std::string(name.substr(0, 60)) + "' is not a name");
      return;
    }
    MessageStruct& current = schema_.structs[type_];
    if (behind.starts_with('=')) {
      // A "#" is a part of a text, and begins a comment behind a number.
      const std::size_t comment = type.starts_with("string") ? behind.npos : behind.find('#');
      current.constants.push_back(
          std::string(type) + " " + std::string(name) + "=" +
          std::string(trimmed(behind.substr(0, comment).substr(1), kBlank)));
      return;
    }
    MessageField field;
    field.name = name;
    if (take_multiplicity(type, field) && take_type(type, field)) {
      current.fields.push_back(std::move(field));
    }
  }

  /// Takes "[]", "[N]" or "[<=N]" off the end of a type.
  bool take_multiplicity(std::string_view& type, MessageField& field) {
    const std::size_t open = type.find('[');
    if (open == std::string_view::npos) {
      return true;
    }
    std::string_view size = type.substr(open + 1);
    if (!size.ends_with(']')) {
      fail("'" + std::string(type.substr(0, 60)) + "' is not a type");
      return false;
    }
    size.remove_suffix(1);
    type = type.substr(0, open);
    field.sequence = size.empty() || size.starts_with("<=");
    if (!field.sequence) {
      const auto count = number(size);
      if (!count || *count == 0) {
        fail("'" + std::string(size.substr(0, 60)) + "' is not the size of an array");
        return false;
      }
      field.array_size = *count;
    }
    return true;
  }

  bool take_type(std::string_view type, MessageField& field) {
    const std::string_view name = type.substr(0, type.find("<="));  // of a bounded string
    if (const auto kind = find_primitive(kPrimitives, name)) {
      field.kind = *kind;
      return true;
    }
    if (version_ == RosVersion::kRos1 && (name == "time" || name == "duration")) {
      field.kind = name == "time" ? FieldKind::kTime : FieldKind::kDuration;
      return true;
    }
    if (version_ == RosVersion::kRos2 && name == "wstring") {
      field.kind = FieldKind::kWstring;
      return true;
    }
    field.struct_name = short_type_name(name);
    if (field.struct_name == "Header" && version_ == RosVersion::kRos1) {
      field.struct_name = "std_msgs/Header";
    }
    if (field.struct_name.find('/') == std::string::npos) {
      field.struct_name.insert(0, package_ + "/");
    }
    return true;
  }

  std::string_view text_;
  RosVersion version_;
  MessageSchema schema_;
  std::string type_;
  std::string package_;
  int line_ = 0;
  std::optional<Error> fault_;
};

/// Every struct is defined and none contains itself.
class Checker {
 public:
  explicit Checker(const MessageSchema& schema) : schema_(schema) {}

  Status check(const std::string& name) {
    if (checked_.contains(name)) {
      return {};
    }
    const auto type = schema_.structs.find(name);
    if (type == schema_.structs.end()) {
      return Error{ErrorCode::kParse, "definition of " + schema_.root + ": type '" +
                                          name.substr(0, 60) + "' is not defined"};
    }
    if (std::ranges::find(path_, name) != path_.end() || path_.size() >= kMaxDepth) {
      return Error{ErrorCode::kParse, "definition of " + schema_.root + ": type '" +
                                          name.substr(0, 60) + "' contains itself"};
    }
    path_.push_back(name);
    for (const MessageField& field : type->second.fields) {
      if (field.kind == FieldKind::kStruct) {
        if (Status status = check(field.struct_name); !status) {
          return status;
        }
      }
    }
    path_.pop_back();
    checked_.insert(name);
    return {};
  }

 private:
  const MessageSchema& schema_;
  std::vector<std::string> path_;
  std::set<std::string> checked_;
};

Result<MessageSchema> checked(Result<MessageSchema> schema) {
  if (schema) {
    if (Status status = Checker(*schema).check(schema->root); !status) {
      return status.error();
    }
  }
  return schema;
}

/// Adds an IDL struct and all in it.
Status add_idl_struct(const msgs::IdlSchema& idl, const std::string& name, std::size_t depth,
                      MessageSchema& schema) {
  const auto* members = idl.find(name);
  if (members == nullptr || depth > kMaxDepth) {
    return Error{ErrorCode::kParse,
                 "the IDL has no struct '" + name.substr(0, 60) + "', or it is nested too deeply"};
  }
  const auto [type, added] = schema.structs.try_emplace(short_type_name(name));
  if (!added) {
    return {};
  }
  for (const msgs::IdlMember& member : *members) {
    MessageField field;
    field.name = member.name;
    field.sequence = member.sequence;
    field.array_size = member.array_size;
    auto kind = find_primitive(kIdlPrimitives, member.type);
    if (!kind) {
      kind = find_primitive(kPrimitives, member.type);  // IDL 4.2: int8, uint8, ...
    }
    if (kind) {
      field.kind = *kind;
    } else {
      field.struct_name = short_type_name(member.type);
      if (Status status = add_idl_struct(idl, member.type, depth + 1, schema); !status) {
        return status;
      }
    }
    type->second.fields.push_back(std::move(field));
  }
  return {};
}

Result<MessageSchema> parse_idl(std::string_view text, std::string_view type_name) {
  if (text.size() > kMaxTextBytes) {
    return Error{ErrorCode::kParse, "an IDL text is longer than 4 MiB"};
  }
  const auto idl = msgs::IdlSchema::parse(text);
  if (!idl) {
    return idl.error();
  }
  const std::string root = short_type_name(type_name);
  const std::size_t slash = root.find('/');
  const std::string scoped = slash == std::string::npos
                                 ? root
                                 : root.substr(0, slash) + "::msg::" + root.substr(slash + 1);
  MessageSchema schema;
  schema.root = root;
  if (Status status = add_idl_struct(*idl, scoped, 0, schema); !status) {
    return status.error();
  }
  return schema;
}

}  // namespace

std::size_t size_of(FieldKind kind) {
  switch (kind) {
    case FieldKind::kBool:
    case FieldKind::kInt8:
    case FieldKind::kUint8:
      return 1;
    case FieldKind::kInt16:
    case FieldKind::kUint16:
      return 2;
    case FieldKind::kInt32:
    case FieldKind::kUint32:
    case FieldKind::kFloat32:
      return 4;
    case FieldKind::kInt64:
    case FieldKind::kUint64:
    case FieldKind::kFloat64:
    case FieldKind::kTime:
    case FieldKind::kDuration:
      return 8;
    case FieldKind::kString:
    case FieldKind::kWstring:
    case FieldKind::kStruct:
      return 0;
  }
  return 0;
}

Result<MessageSchema> parse_message_definition(std::string_view text, std::string_view root,
                                               RosVersion version) {
  return checked(DefinitionParser(text, root, version).run());
}

Result<MessageSchema> parse_schema_text(std::string_view encoding, std::string_view text,
                                        std::string_view type_name) {
  if (encoding == "ros2msg") {
    return parse_message_definition(text, type_name, RosVersion::kRos2);
  }
  if (encoding == "omgidl") {
    return checked(parse_idl(text, type_name));
  }
  return Error{ErrorCode::kParse, "the schema encoding '" + std::string(encoding.substr(0, 40)) +
                                      "' is not supported"};
}

std::string short_type_name(std::string_view name) {
  std::string text(name);
  for (const std::string_view scope : {"/msg/", "::msg::"}) {
    if (const std::size_t at = text.find(scope); at != std::string::npos) {
      text.replace(at, scope.size(), "/");
    }
  }
  return text;
}

}  // namespace furrow::recording
