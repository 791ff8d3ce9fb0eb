#include "furrow_recording/cdr_table.hpp"

#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include "cdr_cursor.hpp"

namespace furrow::recording {

struct CdrTable::Node {
  const MessageField* field = nullptr;
  bool json = false;                                          ///< one column, however many values
  std::shared_ptr<const std::vector<Node>> fields = nullptr;  ///< of a flattened struct
};

namespace {

using Node = CdrTable::Node;

constexpr std::size_t kMaxColumns = 4096;
constexpr std::size_t kMaxFlatArray = 64;
constexpr std::size_t kMaxShownBytes = 64;
/// CDR payloads may be padded to a multiple of four bytes.
constexpr std::size_t kMaxPadding = 3;

class ColumnPlanner {
 public:
  explicit ColumnPlanner(const MessageSchema& schema) : schema_(schema) {}

  std::vector<Node> plan(const std::string& struct_name, const std::string& prefix) {
    std::vector<Node> nodes;
    for (const MessageField& field : schema_.structs.at(struct_name).fields) {
      if (columns.size() > kMaxColumns) {
        break;
      }
      nodes.push_back(plan(field, prefix + field.name));
    }
    return nodes;
  }

  std::vector<std::string> columns;

 private:
  Node plan(const MessageField& field, const std::string& name) {
    Node node;
    node.field = &field;
    const bool is_struct = field.kind == FieldKind::kStruct;
    const bool many = field.sequence || field.array_size > 0;
    node.json = field.sequence || field.array_size > kMaxFlatArray || (is_struct && many) ||
                (is_struct && count(field.struct_name) > kMaxColumns);
    if (node.json || (!is_struct && !many)) {
      columns.push_back(name);
    } else if (is_struct) {
      node.fields = std::make_shared<const std::vector<Node>>(plan(field.struct_name, name + "."));
    } else {
      for (std::size_t i = 0; i < field.array_size; ++i) {
        columns.push_back(name + "[" + std::to_string(i) + "]");
      }
    }
    return node;
  }

  /// Columns of a struct, or some number above the limit.
  std::size_t count(const std::string& struct_name) {
    if (const auto known = counts_.find(struct_name); known != counts_.end()) {
      return known->second;
    }
    std::size_t total = 0;
    for (const MessageField& field : schema_.structs.at(struct_name).fields) {
      const bool flat = !field.sequence && field.array_size <= kMaxFlatArray;
      if (field.kind == FieldKind::kStruct && !field.sequence && field.array_size == 0) {
        total += count(field.struct_name);
      } else {
        total +=
            flat && field.kind != FieldKind::kStruct && field.array_size > 0 ? field.array_size : 1;
      }
      total = std::min(total, kMaxColumns + 1);
    }
    return counts_[struct_name] = total;
  }

  const MessageSchema& schema_;
  std::map<std::string, std::size_t> counts_;
};

template <class T>
std::string number_text(T value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string json_text(std::string_view text) {
  std::string json = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      json += '\\';
      json += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      constexpr std::string_view kDigits = "0123456789abcdef";
      json += "\\u00";
      json += kDigits[static_cast<unsigned char>(c) >> 4U];
      json += kDigits[static_cast<unsigned char>(c) & 0xFU];
    } else {
      json += c;
    }
  }
  return json + "\"";
}

/// Writes the cells of one message.
class RowReader {
 public:
  RowReader(const MessageSchema& schema, std::span<const std::byte> cdr)
      : schema_(schema), in_(cdr) {}

  Result<std::vector<std::string>> run(const std::vector<Node>& nodes) {
    if (!in_.ok()) {
      return Error{ErrorCode::kParse, "the message is not plain CDR"};
    }
    read(nodes);
    if (!in_.ok()) {
      return Error{ErrorCode::kParse, "the message is cut short, or of another type"};
    }
    if (in_.left() > kMaxPadding) {
      return Error{ErrorCode::kParse, "the message is longer than its type"};
    }
    return std::move(cells_);
  }

 private:
  void read(const std::vector<Node>& nodes) {
    if (nodes.empty()) {
      (void)in_.number<std::uint8_t>();  // rosidl gives a struct without fields one byte
    }
    for (const Node& node : nodes) {
      if (!in_.ok()) {
        return;
      }
      if (node.fields) {
        read(*node.fields);
      } else if (node.json) {
        cells_.push_back(json(*node.field));
      } else {
        for (std::size_t i = 0; i < std::max<std::size_t>(1, node.field->array_size); ++i) {
          cells_.push_back(cell(*node.field));
        }
      }
    }
  }

  std::string cell(const MessageField& field) {
    return field.kind == FieldKind::kString ? std::string(in_.string()) : scalar(field.kind);
  }

  std::string scalar(FieldKind kind) {
    switch (kind) {
      case FieldKind::kBool:
        return in_.number<std::uint8_t>() != 0 ? "true" : "false";
      case FieldKind::kInt8:
        return number_text(int{in_.number<std::int8_t>()});
      case FieldKind::kUint8:
        return number_text(int{in_.number<std::uint8_t>()});
      case FieldKind::kInt16:
        return number_text(in_.number<std::int16_t>());
      case FieldKind::kUint16:
        return number_text(in_.number<std::uint16_t>());
      case FieldKind::kInt32:
        return number_text(in_.number<std::int32_t>());
      case FieldKind::kUint32:
        return number_text(in_.number<std::uint32_t>());
      case FieldKind::kInt64:
        return number_text(in_.number<std::int64_t>());
      case FieldKind::kUint64:
        return number_text(in_.number<std::uint64_t>());
      case FieldKind::kFloat32:
        return number_text(in_.number<float>());
      case FieldKind::kFloat64:
        return number_text(in_.number<double>());
      default:
        in_.fail();  // wide strings, and kinds of ROS 1
        return {};
    }
  }

  std::string json(const MessageField& field) {
    if (!field.sequence && field.array_size == 0) {
      return json_value(field);
    }
    const std::size_t count = field.sequence ? in_.count() : field.array_size;
    if (size_of(field.kind) == 1 && count > kMaxShownBytes) {
      (void)in_.raw(count);
      return std::to_string(count) + " bytes";
    }
    std::string text = "[";
    for (std::size_t i = 0; i < count && in_.ok(); ++i) {
      text += (i > 0 ? "," : "") + json_value(field);
    }
    return text + "]";
  }

  std::string json_value(const MessageField& field) {
    if (field.kind == FieldKind::kString) {
      return json_text(in_.string());
    }
    if (field.kind != FieldKind::kStruct) {
      const std::string text = scalar(field.kind);
      // JSON has no infinities and no NaN.
      const bool real = field.kind == FieldKind::kFloat32 || field.kind == FieldKind::kFloat64;
      const bool finite = text.find_first_of("nN") == std::string::npos;
      return real && !finite ? "null" : text;
    }
    const auto& fields = schema_.structs.at(field.struct_name).fields;
    if (fields.empty()) {
      (void)in_.number<std::uint8_t>();
    }
    std::string text = "{";
    for (std::size_t i = 0; i < fields.size() && in_.ok(); ++i) {
      text += (i > 0 ? "," : "") + json_text(fields[i].name) + ":" + json(fields[i]);
    }
    return text + "}";
  }

  const MessageSchema& schema_;
  CdrCursor in_;
  std::vector<std::string> cells_;
};

}  // namespace

Result<CdrTable> CdrTable::make(MessageSchema schema) {
  CdrTable table;
  table.schema_ = std::make_shared<const MessageSchema>(std::move(schema));
  ColumnPlanner planner(*table.schema_);
  auto nodes = planner.plan(table.schema_->root, "");
  if (planner.columns.size() > kMaxColumns) {
    return Error{ErrorCode::kOutOfRange, table.schema_->root + " has more than " +
                                             std::to_string(kMaxColumns) + " columns"};
  }
  table.nodes_ = std::make_shared<const std::vector<Node>>(std::move(nodes));
  table.columns_ = std::move(planner.columns);
  return table;
}

Result<std::vector<std::string>> CdrTable::row(std::span<const std::byte> cdr) const {
  return RowReader(*schema_, cdr).run(*nodes_);
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += i > 0 ? "," : "";
    if (cells[i].find_first_of(",\"\r\n") == std::string::npos) {
      line += cells[i];
      continue;
    }
    line += '"';
    for (const char c : cells[i]) {
      line += c == '"' ? "\"\"" : std::string(1, c);
    }
    line += '"';
  }
  return line + "\r\n";
}

}  // namespace furrow::recording
