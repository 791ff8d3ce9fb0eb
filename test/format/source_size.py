"""Finds functions and source files that are too long."""

import ast
import re

from text_sources import code_only

MAX_FUNCTION_LINES = 60
MAX_FILE_LINES = 400

SCOPE = re.compile(r"\b(?:namespace|class|struct|union|enum|extern)\b")
ACCESS = re.compile(r"\b(?:public|private|protected)\s*:(?!:)")
PREPROCESSOR = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE)


def cpp_functions(text):
    """(line, number of lines, name) of each function with a body, from its name to its brace.

    A tolerant scan of braces: at namespace and class scope a body is what follows a header with
    parentheses. Lambdas and local classes belong to the function around them.
    """
    code = PREPROCESSOR.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), code_only(text))
    position = header = 0
    while position < len(code):
        char = code[position]
        if char in ";}":
            header = position + 1
        elif char == "(":
            position = _matching(code, position, "()")
        elif char == "{":
            head = code[header:position]
            if re.search(r"[\w>]$", head) and not re.search(r"\b(?:const|else|try|do)$", head):
                position = _matching(code, position, "{}")  # an initializer, as in `member_{1}`
            elif SCOPE.search(head) and not _is_function(head):
                header = position + 1
            else:
                end = _matching(code, position, "{}")
                if _is_function(head):
                    head = ACCESS.sub(lambda m: " " * len(m.group()), head)
                    start = header + len(head) - len(head.lstrip())
                    yield (code.count("\n", 0, start) + 1,
                           code.count("\n", start, end) + 1, _name(head))
                    header = end + 1
                position = end
        position += 1


def _is_function(head):
    bare = head
    while (shorter := re.sub(r"\([^()]*\)", "@", bare)) != bare:
        bare = shorter
    bare = re.sub(r"<[^<>]*>", "", bare)
    return "@" in bare and not re.search(r"(?<![=!<>])=(?!=)\s*$", bare) and not re.match(
        r"\s*(?:namespace|enum|extern\s*$)", bare) and not re.search(
            r"\b(?:class|struct|union)\s+(?:\w+\s*)+(?::[^:].*)?$", bare.replace("@", ""))


def _matching(code, position, pair):
    depth = 0
    for index in range(position, len(code)):
        if code[index] == pair[0]:
            depth += 1
        elif code[index] == pair[1]:
            depth -= 1
            if depth == 0:
                return index
    return len(code) - 1


def _name(head):
    match = re.search(r"((?:TEST\w*|TYPED_TEST\w*)\s*\([^)]*\)|[\w:~]+)\s*(?=\(|$)", head)
    return re.sub(r"\s+", " ", match[1]) if match else "function"


def python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield node.lineno, node.end_lineno - node.lineno + 1, node.name


SHELL_FUNCTION = re.compile(r"^([ \t]*)(?:function\s+)?([\w:-]+)\s*\(\)\s*\{[^\n}]*\n"
                            r"(?:.*\n)*?\1\}", re.MULTILINE)


def shell_functions(text):
    """Functions whose closing brace is indented as their name."""
    for match in SHELL_FUNCTION.finditer(text):
        yield text.count("\n", 0, match.start()) + 1, match.group().count("\n") + 1, match[2]


FUNCTIONS = {".hpp": cpp_functions, ".h": cpp_functions, ".cpp": cpp_functions,
             ".c": cpp_functions, ".py": python_functions, ".sh": shell_functions}


def too_long(suffix, text):
    """(line, message) of each function and of the file, where they exceed the limits."""
    if suffix not in FUNCTIONS:
        return
    lines = text.count("\n")
    if lines > MAX_FILE_LINES:
        yield 1, f"{lines} lines; at most {MAX_FILE_LINES}: split the file by purpose"
    for line, count, name in FUNCTIONS[suffix](text):
        if count > MAX_FUNCTION_LINES:
            yield line, (f"function '{name}' has {count} lines; at most {MAX_FUNCTION_LINES}: "
                         "split it")
