#!/usr/bin/env python3
"""Writes message_types.hpp and .cpp: for every struct of the IDL files a MessageType, with its
names, its IDL text and its CDR functions."""

import argparse
import pathlib
import re

STRUCT = re.compile(r"^@final struct (\w+) \{(.*?)^\};", re.MULTILINE | re.DOTALL)
MODULES = re.compile(r"^module (\w+) \{ module msg \{", re.MULTILINE)
INCLUDE = re.compile(r'^#include "(\w+\.idl)"', re.MULTILINE)


def structs(idl):
    text = idl.read_text()
    module = MODULES.search(text)
    if not module:
        raise SystemExit(f"{idl}: no 'module NAME {{ module msg {{'")
    names = [match.group(1) for match in STRUCT.finditer(text)]
    if len(names) != text.count("struct "):
        raise SystemExit(f"{idl}: every struct must be '@final struct NAME {{ ... }};'")
    return module.group(1), names


def with_includes(idl, seen):
    """The file and all that it includes, each once, without preprocessor lines or comments."""
    if idl.name in seen:
        return ""
    seen.add(idl.name)
    text = idl.read_text()
    before = "".join(with_includes(idl.parent / name, seen) for name in INCLUDE.findall(text))
    lines = (re.sub(r"\s*//.*", "", line) for line in text.splitlines())
    return before + "\n".join(line for line in lines if line and not line.startswith("#")) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("idl", type=pathlib.Path, nargs="+")
    arguments = parser.parse_args()

    files = sorted(arguments.idl)
    header = ["// Generated from the IDL files.", "#pragma once", "",
              '#include "furrow_msgs/message_type.hpp"', ""]
    source = ["// Generated from the IDL files.", '#include "furrow_msgs/message_types.hpp"', "",
              '#include "furrow_msgs/cdr.hpp"', ""]
    source += [f'#include "furrow_msgs/{idl.stem}.h"' for idl in files]
    source += ["", "namespace furrow::msgs {", "namespace {", ""]
    functions, table = [], []
    for idl in files:
        module, names = structs(idl)
        header.append(f"namespace {module}::msg {{")
        header += [f"class {name};" for name in names]
        header += [f"}}  // namespace {module}::msg", ""]
        source += [f"constexpr char k_{idl.stem}[] =", f'    R"idl({with_includes(idl, set())})idl";', ""]
        for name in names:
            cpp = f"{module}::msg::{name}"
            functions += [f"template <>", f"const MessageType& message_type<{cpp}>() {{",
                          f"  static const MessageType type = make_message_type<{cpp}>(",
                          f'      "{module}::msg::dds_::{name}_", "{module}/msg/{name}", k_{idl.stem});',
                          "  return type;", "}", ""]
            table.append(f"&message_type<{cpp}>()")
    header += ["namespace furrow::msgs {", ""]
    for idl in files:
        module, names = structs(idl)
        header += [line for name in names for line in
                   ("template <>", f"[[nodiscard]] const MessageType& message_type<{module}::msg::{name}>();")]
    header += ["", "/// Every type that Furrow was built with.",
               "[[nodiscard]] std::span<const MessageType* const> all_message_types();", "",
               "}  // namespace furrow::msgs", ""]
    source += ["}  // namespace", ""] + functions
    source += ["std::span<const MessageType* const> all_message_types() {",
               f"  static const std::array<const MessageType*, {len(table)}> types = {{"]
    source += [f"      {entry}," for entry in table]
    source += ["  };", "  return types;", "}", "", "}  // namespace furrow::msgs", ""]
    (arguments.output / "message_types.hpp").write_text("\n".join(header))
    (arguments.output / "message_types.cpp").write_text("\n".join(source))


if __name__ == "__main__":
    main()
