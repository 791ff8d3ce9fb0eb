#include "generated_code.hpp"

namespace furrow::msgs {
namespace {

std::string declarations(const IdlFile& file) {
  std::string text = "namespace " + file.module + "::msg {\n";
  for (const std::string& name : file.names) text += "class " + name + ";\n";
  return text + "}  // namespace " + file.module + "::msg\n\n";
}

std::string message_type_function(const IdlFile& file, const std::string& name) {
  const std::string type = file.scoped(name);
  return "template <>\nconst MessageType& message_type<" + type + ">() {\n" +
         "  static const MessageType type = make_message_type<" + type + ">(\n" + "      \"" +
         file.module + "::msg::dds_::" + name + "_\", \"" + file.module + "/msg/" + name +
         "\", k_" + file.stem + ");\n  return type;\n}\n\n";
}

}  // namespace

GeneratedCode message_types_code(const std::vector<IdlFile>& files) {
  std::string header =
      "// Generated from the IDL files.\n#pragma once\n\n"
      "#include \"furrow_msgs/message_type.hpp\"\n\n";
  std::string specializations, includes, texts, functions, table;
  std::size_t count = 0;
  for (const IdlFile& file : files) {
    header += declarations(file);
    includes += "#include \"furrow_msgs/" + file.stem + ".h\"\n";
    texts += "constexpr char k_" + file.stem + "[] =\n    R\"idl(" + file.text + ")idl\";\n\n";
    for (const std::string& name : file.names) {
      const std::string function = "message_type<" + file.scoped(name) + ">()";
      specializations += "template <>\n[[nodiscard]] const MessageType& " + function + ";\n";
      functions += message_type_function(file, name);
      table += "      &" + function + ",\n";
      ++count;
    }
  }
  header += "namespace furrow::msgs {\n\n" + specializations +
            "\n/// Every type that Furrow was built with.\n"
            "[[nodiscard]] std::span<const MessageType* const> all_message_types();\n\n"
            "}  // namespace furrow::msgs\n";
  std::string source =
      "// Generated from the IDL files.\n#include \"furrow_msgs/message_types.hpp\"\n\n"
      "#include \"furrow_msgs/cdr.hpp\"\n\n" +
      includes + "\nnamespace furrow::msgs {\nnamespace {\n\n" + texts + "}  // namespace\n\n" +
      functions + "std::span<const MessageType* const> all_message_types() {\n" +
      "  static const std::array<const MessageType*, " + std::to_string(count) + "> types = {\n" +
      table + "  };\n  return types;\n}\n\n}  // namespace furrow::msgs\n";
  return {std::move(header), std::move(source)};
}

}  // namespace furrow::msgs
