#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_recording/message_schema.hpp"

namespace furrow::recording {

/// Serialized messages of one type as rows of text. Structs are flattened ("header.stamp.sec"), and
/// so are arrays of up to 64 numbers or strings ("pose.covariance[0]"). Sequences, larger arrays,
/// arrays of structs, and structs of more than 4096 columns are one column of JSON each. Sequences
/// of more than 64 bytes are only measured: "6291456 bytes".
class CdrTable {
 public:
  /// kOutOfRange for a type of more than 4096 columns.
  [[nodiscard]] static Result<CdrTable> make(MessageSchema schema);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  /// One cell for each column. kParse when the message is cut short, is not XCDR1, or is longer
  /// than its type and padding.
  [[nodiscard]] Result<std::vector<std::string>> row(std::span<const std::byte> cdr) const;

  /// How a field becomes columns; for the implementation only.
  struct Node;

 private:
  std::shared_ptr<const MessageSchema> schema_;
  std::shared_ptr<const std::vector<Node>> nodes_;
  std::vector<std::string> columns_;
};

/// A line of CSV (RFC 4180), with its line break.
[[nodiscard]] std::string csv_line(const std::vector<std::string>& cells);

}  // namespace furrow::recording
