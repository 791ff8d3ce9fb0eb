// How ROS 1 types become ROS 2 types; ros1_translation.cpp does the same to their messages.
#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "furrow_msgs/message_types.hpp"
#include "ros1_translation.hpp"

namespace furrow::recording {
namespace {

using Step = Ros1Translator::Step;
using Steps = Ros1Translator::Steps;

constexpr std::string_view kHeader = "std_msgs/Header";
constexpr std::string_view kTime = "builtin_interfaces/Time";
constexpr std::string_view kDuration = "builtin_interfaces/Duration";
constexpr std::string_view kLog = "rosgraph_msgs/Log";
/// rosidl gives structs without fields this one.
constexpr std::string_view kDummyField = "structure_needs_at_least_one_member";

/// "pkg/Type" of ROS 2.
std::string ros2_name(const std::string& name) {
  if (name == "tf/tfMessage") {
    return "tf2_msgs/TFMessage";
  }
  return name == kLog ? "rcl_interfaces/Log" : name;
}

/// ROS 2 admits no upper case in field names: "frameId" becomes "frame_id", "K" becomes "k".
std::string snake_case(std::string_view name) {
  std::string text;
  char before = '_';
  for (const char c : name) {
    const bool upper = c >= 'A' && c <= 'Z';
    const bool after_word = (before >= 'a' && before <= 'z') || (before >= '0' && before <= '9');
    if (upper && after_word) {
      text += '_';
    }
    text += upper ? static_cast<char>(c - 'A' + 'a') : c;
    before = c;
  }
  return text;
}

MessageField field_of(std::string name, FieldKind kind, std::string struct_name = {}) {
  MessageField field;
  field.name = std::move(name);
  field.kind = kind;
  field.struct_name = std::move(struct_name);
  return field;
}

MessageStruct time_struct() {
  return {{field_of("sec", FieldKind::kInt32), field_of("nanosec", FieldKind::kUint32)}, {}};
}

/// rcl_interfaces/msg/Log of ROS 2.
MessageStruct log_struct() {
  return {{field_of("stamp", FieldKind::kStruct, std::string(kTime)),
           field_of("level", FieldKind::kUint8), field_of("name", FieldKind::kString),
           field_of("msg", FieldKind::kString), field_of("file", FieldKind::kString),
           field_of("function", FieldKind::kString), field_of("line", FieldKind::kUint32)},
          {}};
}

/// Builds the ROS 2 layout of a ROS 1 type, and the steps from one to the other.
class Planner {
 public:
  Planner(const MessageSchema& source, const std::map<std::string, MessageStruct>& known)
      : source_(source), known_(known) {}

  Result<Steps> plan() {
    target.root = ros2_name(source_.root);
    Steps steps = steps_of(source_.root);
    if (error_) {
      return *error_;
    }
    return steps;
  }

  MessageSchema target;
  std::vector<std::string> notes;

 private:
  Steps steps_of(const std::string& source_name) {
    if (const auto known = plans_.find(source_name); known != plans_.end()) {
      return known->second;
    }
    const MessageStruct source = source_struct(source_name);
    const std::string name = ros2_name(source_name);
    const MessageStruct* ros2 = known_struct(name);
    auto steps = std::make_shared<std::vector<Step>>();
    if (ros2 != nullptr) {
      add_known(name);
      match(name, source.fields, ros2->fields, *steps);
    } else {
      MessageStruct& derived = target.structs[name];
      derived.constants = source.constants;
      for (const MessageField& field : source.fields) {
        derived.fields.push_back(derive(field));
        steps->push_back(translate(field));
      }
    }
    plans_[source_name] = steps;
    return steps;
  }

  /// rosgraph_msgs/Log has its stamp in a header, ROS 2's has it itself.
  [[nodiscard]] MessageStruct source_struct(const std::string& name) const {
    MessageStruct source = source_.structs.at(name);
    if (name != kLog) {
      return source;
    }
    std::vector<MessageField> fields;
    for (const MessageField& field : source.fields) {
      if (field.struct_name == kHeader) {
        const auto& header = source_.structs.at(field.struct_name).fields;
        fields.insert(fields.end(), header.begin(), header.end());
      } else {
        fields.push_back(field);
      }
    }
    source.fields = std::move(fields);
    return source;
  }

  [[nodiscard]] const MessageStruct* known_struct(const std::string& name) const {
    const auto at = known_.find(name);
    return at == known_.end() ? nullptr : &at->second;
  }

  /// Takes a ROS 2 type over into the target's schema, with all types in it.
  void add_known(const std::string& name) {
    const MessageStruct* known = known_struct(name);
    if (known == nullptr || !target.structs.try_emplace(name, *known).second) {
      return;
    }
    for (const MessageField& field : known->fields) {
      if (field.kind == FieldKind::kStruct) {
        add_known(field.struct_name);
      }
    }
  }

  MessageField derive(MessageField field) {
    field.name = snake_case(field.name);
    if (field.kind == FieldKind::kTime || field.kind == FieldKind::kDuration) {
      field.struct_name = field.kind == FieldKind::kTime ? kTime : kDuration;
      field.kind = FieldKind::kStruct;
      target.structs[field.struct_name] = time_struct();
    } else if (field.kind == FieldKind::kStruct) {
      field.struct_name = ros2_name(field.struct_name);
    }
    return field;
  }

  Step translate(const MessageField& field, Step::Action action = Step::Action::kTranslate) {
    Step step;
    step.action = action;
    step.kind = field.kind;
    step.sequence = field.sequence;
    step.array_size = field.array_size;
    if (field.kind == FieldKind::kStruct) {
      step.steps = steps_of(field.struct_name);
    }
    return step;
  }

  /// Steps for a target field that ROS 1 does not have.
  Step fill(const MessageField& field) {
    Step step;
    step.action = Step::Action::kFill;
    step.kind = field.kind;
    step.sequence = field.sequence;
    step.array_size = field.array_size;
    if (field.kind == FieldKind::kStruct && !field.sequence) {
      auto& known = fills_[field.struct_name];
      if (!known) {
        auto steps = std::make_shared<std::vector<Step>>();
        for (const MessageField& inner : target.structs.at(field.struct_name).fields) {
          steps->push_back(fill(inner));
        }
        known = std::move(steps);
      }
      step.steps = known;
    }
    return step;
  }

  void match(const std::string& name, const std::vector<MessageField>& source,
             const std::vector<MessageField>& wanted, std::vector<Step>& steps) {
    std::size_t next = 0;
    for (const MessageField& field : wanted) {
      const auto same_name = [&field](const MessageField& other) {
        return snake_case(other.name) == field.name || other.name == field.name;
      };
      const auto begin = source.begin() + static_cast<std::ptrdiff_t>(next);
      const auto at = std::find_if(begin, source.end(), same_name);
      if (at == source.end()) {
        if (std::find_if(source.begin(), begin, same_name) != begin) {
          fail(name + ": ROS 2 has its fields in another order");
          return;
        }
        steps.push_back(fill(field));
        if (field.name != kDummyField) {
          note(name, field.name, "exists in ROS 2 only and stays empty");
        }
        continue;
      }
      for (auto dropped = begin; dropped != at; ++dropped) {
        drop(name, *dropped, steps);
      }
      if (!compatible(*at, field)) {
        fail(name + ": field " + field.name + " has another type in ROS 2");
        return;
      }
      steps.push_back(translate(*at));
      steps.back().log_level = name == "rcl_interfaces/Log" && field.name == "level";
      next = static_cast<std::size_t>(at - source.begin()) + 1;
    }
    for (; next < source.size(); ++next) {
      drop(name, source[next], steps);
    }
  }

  void drop(const std::string& name, const MessageField& field, std::vector<Step>& steps) {
    steps.push_back(translate(field, Step::Action::kDrop));
    if (field.name != "seq") {
      note(name, field.name, "exists in ROS 1 only and is left out");
    }
  }

  static bool compatible(const MessageField& from, const MessageField& to) {
    if (from.sequence != to.sequence || from.array_size != to.array_size) {
      return false;
    }
    switch (from.kind) {
      case FieldKind::kTime:
        return to.struct_name == kTime;
      case FieldKind::kDuration:
        return to.struct_name == kDuration;
      case FieldKind::kStruct:
        return to.struct_name == ros2_name(from.struct_name);
      default:
        // "byte" and "char" became other one-byte numbers.
        return from.kind == to.kind ||
               (size_of(from.kind) == 1 && size_of(to.kind) == 1 && to.kind != FieldKind::kBool);
    }
  }

  void note(const std::string& type, const std::string& field, const char* what) {
    notes.push_back(type + ": field " + field + " " + what);
  }
  void fail(const std::string& what) {
    if (!error_) {
      error_ = Error{ErrorCode::kParse, what};
    }
  }

  const MessageSchema& source_;
  const std::map<std::string, MessageStruct>& known_;
  std::map<std::string, Steps> plans_;  ///< by ROS 1 type
  std::map<std::string, Steps> fills_;  ///< by ROS 2 type
  std::optional<Error> error_;
};

std::string_view ros2_kind_name(FieldKind kind) {
  constexpr std::array<std::string_view, 13> kNames = {
      "bool",  "int8",   "uint8",   "int16",   "uint16", "int32",  "uint32",
      "int64", "uint64", "float32", "float64", "string", "wstring"};
  return kNames.at(static_cast<std::size_t>(kind));
}

void append_struct(const MessageStruct& type, std::string& text) {
  for (const std::string& constant : type.constants) {
    text += constant + "\n";
  }
  for (const MessageField& field : type.fields) {
    if (field.name == kDummyField) {
      continue;
    }
    text += field.kind == FieldKind::kStruct ? field.struct_name
                                             : std::string(ros2_kind_name(field.kind));
    if (field.sequence) {
      text += "[]";
    } else if (field.array_size > 0) {
      text += "[" + std::to_string(field.array_size) + "]";
    }
    text += " " + field.name + "\n";
  }
}

std::map<std::string, MessageStruct> make_known_structs() {
  std::map<std::string, MessageStruct> structs;
  for (const msgs::MessageType* type : msgs::all_message_types()) {
    if (auto schema = parse_schema_text("omgidl", type->idl, type->ros_name)) {
      structs.merge(schema->structs);
    }
  }
  structs.try_emplace(std::string(kTime), time_struct());
  structs.try_emplace(std::string(kDuration), time_struct());
  structs.try_emplace(std::string(kHeader),
                      MessageStruct{{field_of("stamp", FieldKind::kStruct, std::string(kTime)),
                                     field_of("frame_id", FieldKind::kString)},
                                    {}});
  structs.try_emplace("rcl_interfaces/Log", log_struct());
  return structs;
}

}  // namespace

const std::map<std::string, MessageStruct>& known_ros2_structs() {
  // Constant, and 20 ms of parsing.
  static const auto structs = make_known_structs();
  return structs;
}

std::string ros2_definition_text(const MessageSchema& schema) {
  std::string text;
  std::vector<std::string> wanted = {schema.root};
  std::set<std::string> seen = {schema.root};
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::string name = wanted[i];
    const MessageStruct& type = schema.structs.at(name);
    if (i > 0) {
      text += std::string(80, '=') + "\nMSG: " + name + "\n";
    }
    append_struct(type, text);
    for (const MessageField& field : type.fields) {
      if (field.kind == FieldKind::kStruct && seen.insert(field.struct_name).second) {
        wanted.push_back(field.struct_name);
      }
    }
  }
  return text;
}

Result<Ros1Translator> Ros1Translator::make(std::string_view type, std::string_view definition,
                                            const std::map<std::string, MessageStruct>& known) {
  const auto source = parse_message_definition(definition, type, RosVersion::kRos1);
  if (!source) {
    return source.error();
  }
  Planner planner(*source, known);
  auto steps = planner.plan();
  if (!steps) {
    return steps.error();
  }
  Ros1Translator translator;
  translator.schema_ = std::move(planner.target);
  translator.steps_ = std::move(*steps);
  translator.notes_ = std::move(planner.notes);
  const std::string& root = translator.schema_.root;
  const std::size_t slash = root.find('/');
  if (slash == std::string::npos) {
    return Error{ErrorCode::kParse, "'" + root.substr(0, 60) + "' is not a ROS message type"};
  }
  translator.type_name_ = root.substr(0, slash) + "/msg" + root.substr(slash);
  return translator;
}

}  // namespace furrow::recording
