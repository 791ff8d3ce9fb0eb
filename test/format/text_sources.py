"""Extracts what people read from source files: comments, error and help texts, documents.

Each extractor yields pairs of line number and text. A text is one paragraph, list item, table cell
or string literal; its line breaks are those of the file, so that an offset gives a line.
"""

import ast
import io
import re
import tokenize

LIST_ITEM = re.compile(r"^\s*(?:[-*+•]|\d+[.)]|[a-z]\))\s+")
# Lines of a comment that are no prose: tables, rulers, tool directives.
NO_PROSE = re.compile(r"^\s*(?:\||[-=#*~+_/\\]{3,}|NOLINT|clang-format|noqa|shellcheck|pylint|SPDX|"
                      r"@|\\\w)")
TABLE_RULE = re.compile(r"^\s*\|[\s|:-]+\|?\s*$")


def paragraphs(lines):
    """Joins (line number, text) pairs into paragraphs; lists and blank lines separate them.

    An indented line is a formula or an example and is left out, unless it continues a list item.
    """
    held, in_item = [], False
    for number, text in lines:
        starts_item = LIST_ITEM.match(text)
        if not starts_item and not text.startswith("  "):
            in_item = False
        example = text.startswith("  ") and not starts_item and not in_item
        skip = not text.strip() or NO_PROSE.match(text) or example
        gap = held and number != held[-1][0] + 1
        if held and (skip or starts_item or gap):
            yield held[0][0], "\n".join(part for _, part in held)
            held = []
        if starts_item:
            in_item = True
        if not skip:
            held.append((number, LIST_ITEM.sub("", text) if starts_item else text.strip()))
    if held:
        yield held[0][0], "\n".join(part for _, part in held)


# --- C++, C, IDL ---------------------------------------------------------------------------------

CPP_TOKEN = re.compile(
    r'(?P<line>//[^\n]*)|(?P<block>/\*.*?\*/)'
    r'|(?P<raw>(?:u8|[uUL])?R"(?P<delimiter>[^()\\\s]{0,16})\(.*?\)(?P=delimiter)")'
    r'|(?P<string>(?:u8|[uUL])?"(?:[^"\\\n]|\\.)*")'
    r"|(?P<char>(?<![0-9A-Fa-f])'(?:[^'\\\n]|\\.[^']*)')"
    r"|(?P<include>^[ \t]*#[ \t]*include[^\n]*)", re.DOTALL | re.MULTILINE)


def cpp_tokens(text):
    """(kind, start, end) of comments, literals and includes, in order."""
    for match in CPP_TOKEN.finditer(text):
        kind = "raw" if match.lastgroup == "delimiter" else match.lastgroup
        yield kind, match.start(), match.end()


def code_only(text):
    """C++ with comments and literals blanked; same length and lines."""
    parts, last = [], 0
    for _, start, end in cpp_tokens(text):
        parts.append(text[last:start])
        parts.append(re.sub(r"[^\n]", " ", text[start:end]))
        last = end
    return "".join(parts + [text[last:]])


def cpp_comments(text):
    lines = []
    columns = {}
    for kind, start, end in cpp_tokens(text):
        number = text.count("\n", 0, start) + 1
        column = start - (text.rfind("\n", 0, start) + 1)
        if kind == "line":
            body = re.sub(r"^///?!?<?", "", text[start:end])
            before = text[start - column:start].strip()
            # A comment behind code starts a text, which goes on below only at the same column.
            continues = columns.get(number - 1) == column and not before
            if not continues and lines:
                lines.append((number - 1, ""))
            lines.append((number, body[1:] if body.startswith(" ") else body))
            columns[number] = column
        elif kind == "block":
            lines.append((number - 1, ""))
            for offset, line in enumerate(text[start + 2:end - 2].split("\n")):
                lines.append((number + offset, re.sub(r"^\s*\*+ ?<?", "", line)))
            lines.append((number, ""))
    yield from _separated(lines)


def _separated(lines):
    """Paragraphs of lines in which an empty text is a separator whatever its number."""
    part = []
    for number, text in lines + [(0, "")]:
        if text.strip():
            part.append((number, text))
        elif part:
            yield from paragraphs(part)
            part = []


GAP = re.compile(r"^\s*(?:\+|<<)[^;{}]*(?:\+|<<)\s*$")


def cpp_strings(text):
    """String literals as texts. Neighbours and those joined by + or << are one, with X between."""
    held, held_line, held_end = "", 0, 0
    for kind, start, end in cpp_tokens(text):
        if kind != "string":
            continue
        gap = text[held_end:start]
        body = unescape(text[start:end])
        if held and not gap.strip():
            held += body
        elif held and GAP.match(gap) and gap.count("(") == gap.count(")"):
            held += "X" + body
        else:
            if held:
                yield held_line, held
            held, held_line = body, text.count("\n", 0, start) + 1
        held_end = end
    if held:
        yield held_line, held


def unescape(literal):
    body = literal[literal.index('"') + 1:-1]
    # A line break in an output ends a sentence, as a paragraph does.
    return body.replace("\\n", ". ").replace("\\t", " ").replace('\\"', '"').replace("\\'", "'")


def is_prose(text):
    """Whether a literal is a text for people: several words, not a path, key or pattern."""
    words = re.findall(r"(?<![\w/.<])[A-Za-z][a-z']+(?![\w/=(])", text)
    return len(words) >= 3 and " " in text.strip() and not re.search(r"[{}<>]|::|\w\(|=\"|;$", text)


# --- Python, shell, YAML, CMake, XML -------------------------------------------------------------

def python_texts(text):
    lines = []
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT and not token.string.startswith("#!"):
            own = not token.line[:token.start[1]].strip()
            if not own or (lines and lines[-1][0] != token.start[0] - 1):
                lines.append((0, ""))
            lines.append((token.start[0], token.string.lstrip("#")[1:]))
    yield from _separated(lines)
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)):
            doc = ast.get_docstring(node, clean=False)
            if doc:
                first = node.body[0].lineno
                indent = " " * node.body[0].col_offset
                yield from paragraphs([(first + i, line[len(indent):] if line.startswith(indent)
                                        else line) for i, line in enumerate(doc.split("\n"))])


def hash_comments(text):
    """Comments of shell, YAML and CMake."""
    lines = []
    for number, line in enumerate(text.split("\n"), 1):
        for match in re.finditer(r"(?:^|(?<=\s))#(?!!)\s?", line):
            before = line[:match.start()]
            if before.count('"') % 2 == 0 and before.count("'") % 2 == 0:
                apart = [(0, "")] if before.strip() else []
                lines += [*apart, (number, line[match.end():]), *apart]
                break
    yield from _separated(lines)


def xml_comments(text):
    for match in re.finditer(r"<!--(.*?)-->", text, re.DOTALL):
        first = text.count("\n", 0, match.start()) + 1
        yield from paragraphs([(first + i, line.strip())
                               for i, line in enumerate(match[1].split("\n"))])


# --- Markdown ------------------------------------------------------------------------------------

def markdown_texts(text):
    """Paragraphs, list items, headings and table cells; no code blocks, HTML or link targets."""
    lines, fence = [], None
    for number, line in enumerate(text.split("\n"), 1):
        mark = re.match(r"^\s*(```+|~~~+)", line)
        if fence:
            fence = None if mark and mark[1].startswith(fence) else fence
            continue
        if mark:
            fence = mark[1]
            lines.append((0, ""))
            continue
        if line.lstrip().startswith("|"):
            lines.append((0, ""))
            if not TABLE_RULE.match(line):
                for cell in re.split(r"(?<!\\)\|", line.strip().strip("|")):
                    lines += [(number, plain(cell).strip()), (0, "")]
            continue
        if re.match(r"^#+ ", line):
            lines += [(0, ""), (number, plain(line.lstrip("# "))), (0, "")]
            continue
        lines.append((number, plain(re.sub(r"^\s*>\s?", "", line))))
    # A list item may be indented; a formula is in a code block here.
    for number, paragraph in _separated([(n, t if LIST_ITEM.match(t) else t.strip())
                                         for n, t in lines]):
        yield number, paragraph


def plain(text):
    """Markdown without images' and links' targets, HTML and emphasis."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"<!--.*?-->|</?[a-zA-Z][^>]*>", " ", text)
    return re.sub(r"\*\*|(?<!\w)[*_](?=\w)|(?<=\w)[*_](?!\w)", "", text)


EXTRACTORS = {
    ".hpp": (cpp_comments, cpp_strings), ".cpp": (cpp_comments, cpp_strings),
    ".h": (cpp_comments, cpp_strings), ".c": (cpp_comments, cpp_strings),
    ".idl": (cpp_comments,), ".py": (python_texts,), ".sh": (hash_comments,),
    ".yaml": (hash_comments,), ".yml": (hash_comments,), ".cmake": (hash_comments,),
    ".txt": (hash_comments,), ".urdf": (xml_comments,), ".xml": (xml_comments,),
    ".md": (markdown_texts,),
}


def texts(suffix, text):
    """All texts of a file: (line, text)."""
    for extractor in EXTRACTORS.get(suffix, ()):
        for number, part in extractor(text):
            if extractor is not cpp_strings or is_prose(part):
                yield number, part
