#!/usr/bin/env python3
"""Generates C++ from the IDL files, beside what fastddsgen generates:

    message_types.hpp, .cpp   a MessageType for every struct: names, IDL text, CDR functions
    enums.hpp, .cpp           an enum class for every enumeration, in its ROS 2 form: a struct whose
                              one member is `uint8 value`, after a module NAME_Constants
"""

import argparse
import dataclasses
import pathlib
import re

STRUCT = re.compile(r"^@final struct (\w+) \{(.*?)^\};", re.MULTILINE | re.DOTALL)
ENUM = re.compile(r"((?:^//[^\n]*\n)*)^module (\w+)_Constants \{\n(.*?)^\};\n"
                  r"@final struct (\w+) \{\n  uint8 value;\n\};", re.MULTILINE | re.DOTALL)
CONSTANT = re.compile(r"const uint8 ([A-Z][A-Z0-9_]*) = (\d+);[ ]*(?://[ ]*(.*))?$", re.MULTILINE)
MODULES = re.compile(r"^module (\w+) \{ module msg \{", re.MULTILINE)
INCLUDE = re.compile(r'^#include "(\w+\.idl)"', re.MULTILINE)
GENERATED = "// Generated from the IDL files."


@dataclasses.dataclass
class Enum:
    module: str
    name: str
    comment: list
    values: list  # of (NAME, number, comment)


def structs(idl):
    text = idl.read_text()
    module = MODULES.search(text)
    if not module:
        raise SystemExit(f"{idl}: no 'module NAME {{ module msg {{'")
    names = [match.group(1) for match in STRUCT.finditer(text)]
    code = re.sub(r"//[^\n]*", "", text)
    if len(names) != len(re.findall(r"\bstruct\b", code)):
        raise SystemExit(f"{idl}: every struct must be '@final struct NAME {{ ... }};'")
    return module.group(1), names


def enums(idl):
    module, _ = structs(idl)
    for comment, constants, body, name in ENUM.findall(idl.read_text()):
        if constants != name:
            raise SystemExit(f"{idl}: {constants}_Constants stands before message {name}")
        values = [(value, int(number), text) for value, number, text in CONSTANT.findall(body)]
        numbers = [number for _, number, _ in values]
        if len(values) != body.count(";") or not values:
            raise SystemExit(f"{idl}: {name}: every constant must be 'const uint8 NAME = NUMBER;'")
        if len(set(numbers)) != len(numbers) or max(numbers) > 255:
            raise SystemExit(f"{idl}: {name}: values must differ and be at most 255")
        yield Enum(module, name, [line[2:].strip() for line in comment.splitlines()], values)


def with_includes(idl, seen):
    """The file and all that it includes, each once, without preprocessor lines or comments."""
    if idl.name in seen:
        return ""
    seen.add(idl.name)
    text = idl.read_text()
    before = "".join(with_includes(idl.parent / name, seen) for name in INCLUDE.findall(text))
    lines = (re.sub(r"\s*//.*", "", line) for line in text.splitlines())
    return before + "\n".join(line for line in lines if line and not line.startswith("#")) + "\n"


def message_types(files):
    header = [GENERATED, "#pragma once", "", '#include "furrow_msgs/message_type.hpp"', ""]
    source = [GENERATED, '#include "furrow_msgs/message_types.hpp"', "",
              '#include "furrow_msgs/cdr.hpp"', ""]
    source += [f'#include "furrow_msgs/{idl.stem}.h"' for idl in files]
    source += ["", "namespace furrow::msgs {", "namespace {", ""]
    functions, table = [], []
    for idl in files:
        module, names = structs(idl)
        header.append(f"namespace {module}::msg {{")
        header += [f"class {name};" for name in names]
        header += [f"}}  // namespace {module}::msg", ""]
        source += [f"constexpr char k_{idl.stem}[] =",
                   f'    R"idl({with_includes(idl, set())})idl";', ""]
        for name in names:
            cpp = f"{module}::msg::{name}"
            functions += ["template <>", f"const MessageType& message_type<{cpp}>() {{",
                          f"  static const MessageType type = make_message_type<{cpp}>(",
                          f'      "{module}::msg::dds_::{name}_", "{module}/msg/{name}",'
                          f" k_{idl.stem});",
                          "  return type;", "}", ""]
            table.append(f"&message_type<{cpp}>()")
    header += ["namespace furrow::msgs {", ""]
    for idl in files:
        module, names = structs(idl)
        for name in names:
            header += ["template <>", "[[nodiscard]] const MessageType&"
                       f" message_type<{module}::msg::{name}>();"]
    header += ["", "/// Every type that Furrow was built with.",
               "[[nodiscard]] std::span<const MessageType* const> all_message_types();", "",
               "}  // namespace furrow::msgs", ""]
    source += ["}  // namespace", ""] + functions
    source += ["std::span<const MessageType* const> all_message_types() {",
               f"  static const std::array<const MessageType*, {len(table)}> types = {{"]
    source += [f"      {entry}," for entry in table]
    source += ["  };", "  return types;", "}", "", "}  // namespace furrow::msgs", ""]
    return header, source


def enumerator(name):
    return "k" + "".join(part.capitalize() for part in name.split("_"))


def enum_header(enum):
    lines = [f"/// {line}" for line in enum.comment]
    lines.append(f"enum class {enum.name} : std::uint8_t {{")
    for name, number, comment in enum.values:
        lines.append(f"  {enumerator(name)} = {number}," + (f"  ///< {comment}" if comment else ""))
    message = f"{enum.module}::msg::{enum.name}"
    lines += ["};",
              f'/// The constant\'s name in lower case, such as "{enum.values[0][0].lower()}".',
              f"[[nodiscard]] std::string_view to_string({enum.name} value);",
              '/// The same of a message; "unknown (200)" where it holds none of the constants.',
              f"[[nodiscard]] std::string to_string(const {message}& message);",
              f"[[nodiscard]] {message} to_msg({enum.name} value);",
              "/// False for a message that holds none of the constants.",
              f"[[nodiscard]] bool operator==(const {message}& message, {enum.name} value);",
              "/// kOutOfRange: the message holds none of the constants.",
              f"[[nodiscard]] Result<{enum.name}> from_msg(const {message}& message);", ""]
    return lines


def enum_source(enum):
    message = f"{enum.module}::msg::{enum.name}"
    lines = [f"std::string_view to_string({enum.name} value) {{", "  switch (value) {"]
    for name, _, _ in enum.values:
        lines += [f"    case {enum.name}::{enumerator(name)}:", f'      return "{name.lower()}";']
    lines += ["  }", '  return "unknown";', "}", "",
              f"std::string to_string(const {message}& message) {{",
              "  const auto value = from_msg(message);",
              '  return value.ok() ? std::string(to_string(*value))',
              '                    : "unknown (" + std::to_string(message.value()) + ")";', "}", "",
              f"{message} to_msg({enum.name} value) {{", f"  {message} message;",
              "  message.value(static_cast<std::uint8_t>(value));", "  return message;", "}", "",
              f"bool operator==(const {message}& message, {enum.name} value) {{",
              "  return message.value() == static_cast<std::uint8_t>(value);", "}", "",
              f"Result<{enum.name}> from_msg(const {message}& message) {{",
              "  switch (message.value()) {"]
    lines += [f"    case {number}:" for _, number, _ in enum.values]
    lines += [f"      return static_cast<{enum.name}>(message.value());", "    default:",
              f'      return unknown_value("{enum.module}/{enum.name}", message.value());',
              "  }", "}", ""]
    return lines


def enum_types(files):
    found = [enum for idl in files for enum in enums(idl)]
    header = [GENERATED, "#pragma once", "", "#include <cstdint>", "#include <string>",
              "#include <string_view>", "",
              '#include "furrow_core/result.hpp"', ""]
    for module in sorted({enum.module for enum in found}):
        header.append(f"namespace {module}::msg {{")
        header += [f"class {enum.name};" for enum in found if enum.module == module]
        header += [f"}}  // namespace {module}::msg", ""]
    header += ["namespace furrow::msgs {", ""]
    source = [GENERATED, '#include "furrow_msgs/enums.hpp"', ""]
    source += [f'#include "furrow_msgs/{idl.stem}.h"' for idl in files if any(enums(idl))]
    source += ["", "namespace furrow::msgs {", "namespace {", "",
               "Error unknown_value(const char* type, int value) {",
               "  return {ErrorCode::kOutOfRange,",
               '          std::string(type) + " has no value " + std::to_string(value)};', "}", "",
               "}  // namespace", ""]
    for enum in found:
        header += enum_header(enum)
        source += enum_source(enum)
    header += ["}  // namespace furrow::msgs", ""]
    source += ["}  // namespace furrow::msgs", ""]
    return header, source


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("idl", type=pathlib.Path, nargs="+")
    arguments = parser.parse_args()

    files = sorted(arguments.idl)
    for name, (header, source) in {"message_types": message_types(files),
                                   "enums": enum_types(files)}.items():
        (arguments.output / f"{name}.hpp").write_text("\n".join(header))
        (arguments.output / f"{name}.cpp").write_text("\n".join(source))


if __name__ == "__main__":
    main()
