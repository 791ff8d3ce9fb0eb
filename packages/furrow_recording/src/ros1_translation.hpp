#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_recording/message_schema.hpp"

namespace furrow::recording {

/// The ROS 2 message types that Furrow was built with, by "pkg/Type", with all types in them.
[[nodiscard]] const std::map<std::string, MessageStruct>& known_ros2_structs();

/// The ROS 2 definition text of a schema ("ros2msg"), with all types in it.
[[nodiscard]] std::string ros2_definition_text(const MessageSchema& schema);

/// Translates serialized ROS 1 messages of one type into CDR of its ROS 2 form. std_msgs/Header has
/// no `seq`, times are builtin_interfaces, field names are snake case. Types that ROS 2 renamed
/// have their new names. Where Furrow knows the ROS 2 type, fields are matched by name. Fields that
/// only ROS 1 has are left out, and fields that only ROS 2 has are zero or empty.
class Ros1Translator {
 public:
  /// From a bag's definition text. kParse for text that is not a definition, and for a type whose
  /// ROS 2 form has its fields in another order or of other kinds.
  [[nodiscard]] static Result<Ros1Translator> make(
      std::string_view type, std::string_view definition,
      const std::map<std::string, MessageStruct>& known);

  /// Writes the CDR form, with its encapsulation header, into `cdr`, whose memory is reused. kParse
  /// when the message is not exactly of the type, kOutOfRange above `max_bytes`.
  [[nodiscard]] Status translate(std::span<const std::byte> message, std::size_t max_bytes,
                                 std::vector<std::byte>& cdr) const;

  /// "pkg/msg/Type" of ROS 2.
  [[nodiscard]] const std::string& type_name() const { return type_name_; }
  /// The ROS 2 layout.
  [[nodiscard]] const MessageSchema& schema() const { return schema_; }
  /// What is left out or filled in, a sentence each; empty when the forms hold the same.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  /// How one field is translated; for the implementation only.
  struct Step;
  using Steps = std::shared_ptr<const std::vector<Step>>;
  struct Step {
    enum class Action : std::uint8_t { kTranslate, kDrop, kFill };
    Action action = Action::kTranslate;
    FieldKind kind = FieldKind::kStruct;  ///< in ROS 1; of kFill in ROS 2
    bool sequence = false;
    std::size_t array_size = 0;
    bool log_level = false;  ///< of rosgraph_msgs/Log: ROS 2 numbers levels differently
    Steps steps = nullptr;   ///< of kStruct
  };

 private:
  std::string type_name_;
  MessageSchema schema_;
  Steps steps_;
  std::vector<std::string> notes_;
};

}  // namespace furrow::recording
