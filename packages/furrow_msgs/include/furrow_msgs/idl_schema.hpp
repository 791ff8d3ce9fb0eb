#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::msgs {

/// A member of a struct. Exactly one of a primitive, a string or a struct, and that once, a fixed
/// number of times, or as a sequence.
struct IdlMember {
  std::string name;
  std::string type;  ///< "double", "string", or the scoped name of a struct
  bool sequence = false;
  std::size_t array_size = 0;  ///< 0: no array
};

/// The structs of an IDL text, by their scoped names ("sensor_msgs::msg::Image"). Understood is
/// what ROS 2's message types need: modules, structs, primitives, string, sequence and
/// one-dimensional arrays; annotations and comments are passed over.
class IdlSchema {
 public:
  /// kParse with the line for anything else, and for a type that is not defined before its use.
  [[nodiscard]] static Result<IdlSchema> parse(std::string_view idl);

  /// Null when there is no such struct.
  [[nodiscard]] const std::vector<IdlMember>* find(const std::string& struct_name) const;

 private:
  std::map<std::string, std::vector<IdlMember>> structs_;
};

struct PrintLimits {
  std::size_t max_elements = 16;  ///< of a sequence or array; the rest is counted
  std::size_t max_text = 200;     ///< of a string
};

/// A message as indented text, "name: value" a line. kNotFound: the schema has no such struct.
/// kParse: the CDR form (XCDR1, with its encapsulation header) is cut short or does not fit.
[[nodiscard]] Result<std::string> print_cdr(const IdlSchema& schema, const std::string& struct_name,
                                            std::span<const std::byte> cdr,
                                            const PrintLimits& limits = {});

}  // namespace furrow::msgs
