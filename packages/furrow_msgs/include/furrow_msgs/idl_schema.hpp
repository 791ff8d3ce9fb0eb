#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::msgs {

/// A member of a struct: a primitive, a string or a struct. It is single, an array or a sequence.
struct IdlMember {
  std::string name;
  std::string type;  ///< "double", "string", or the scoped name of a struct
  bool sequence = false;
  std::size_t bound = 0;       ///< of a sequence; 0: unbounded
  std::size_t array_size = 0;  ///< 0: no array
};

struct IdlConstant {
  std::string type;  ///< a primitive
  std::string name;
  std::string value;         ///< as the text has it; string constants are not supported
  std::string comment = {};  ///< at the end of its line, without "//"
};

/// The structs of an IDL text, by their scoped names ("sensor_msgs::msg::Image"), and the constants
/// that belong to them. It supports what ROS 2's message types need: modules, structs, constants,
/// primitives, string, sequence and one-dimensional arrays. Other annotations than @final are
/// skipped. The one parser of IDL: the build generates message types with it, and programs print
/// messages.
class IdlSchema {
 public:
  /// kParse with the line for anything else, and for a type that is not defined before its use.
  [[nodiscard]] static Result<IdlSchema> parse(std::string_view idl);

  /// Null when there is no such struct.
  [[nodiscard]] const std::vector<IdlMember>* find(const std::string& struct_name) const;
  /// The constants of module "NAME_Constants" beside struct NAME, as rosidl attaches them.
  [[nodiscard]] std::span<const IdlConstant> constants_of(const std::string& struct_name) const;
  /// Whether a struct is an enumeration: constants, and the one member `value` of a primitive.
  [[nodiscard]] bool is_enumeration(const std::string& struct_name) const;
  /// The lines of comment right before module "NAME_Constants", each with its line break and
  /// without
  /// "//"; empty: none.
  [[nodiscard]] std::string comment_of_constants(const std::string& struct_name) const;
  [[nodiscard]] bool is_final(const std::string& struct_name) const;
  /// In the order of the text.
  [[nodiscard]] const std::vector<std::string>& struct_names() const { return order_; }

 private:
  std::map<std::string, std::vector<IdlMember>> structs_;
  std::map<std::string, std::vector<IdlConstant>> constants_;  ///< by the name of their struct
  std::map<std::string, std::string> comments_;                ///< likewise
  std::set<std::string> final_;
  std::vector<std::string> order_;
};

struct PrintLimits {
  std::size_t max_elements = 16;  ///< of a sequence or array; the rest is counted
  std::size_t max_text = 200;     ///< of a string
};

/// A message as indented text, one "name: value" on each line. Enumerations print as
/// "name: value (CONSTANT)".
/// kNotFound: the schema has no such struct. kParse: the CDR form (XCDR1, with its encapsulation
/// header) is truncated or of another type.
[[nodiscard]] Result<std::string> print_cdr(const IdlSchema& schema, const std::string& struct_name,
                                            std::span<const std::byte> cdr,
                                            const PrintLimits& limits = {});

}  // namespace furrow::msgs
