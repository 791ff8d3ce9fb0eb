#!/usr/bin/env python3
"""Checks that links between documents, and paths of documents named in sources, lead somewhere.

    check_links.py [ROOT]

Prints FILE:LINE for a relative link to a file or heading that does not exist, and for a path such as
docs/NAME.md in any source that does not exist. Exit code 1 when there is one.
"""

import pathlib
import re
import sys

from check_language import FOLDERS
from text_sources import EXTRACTORS, plain

LINK = re.compile(r"\]\(([^)\s]+)\)")
PATH = re.compile(r"(?<![\w/.])docs/[\w/.-]+\.(?:md|svg|png)\b")
EXTERNAL = re.compile(r"^[a-z]+:")


def lines_outside_code(text):
    """(number, line) of Markdown, without code blocks and code spans."""
    fence = False
    for number, line in enumerate(text.split("\n"), 1):
        if re.match(r"^\s*(```|~~~)", line):
            fence = not fence
        elif not fence:
            yield number, re.sub(r"`[^`]*`", "", line)


def anchor(heading):
    """The anchor that GitHub gives a heading."""
    text = plain(heading).replace("`", "").strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def anchors(file):
    found, fence = set(), False
    for line in file.read_text(errors="replace").split("\n"):
        if re.match(r"^\s*(```|~~~)", line):
            fence = not fence
        elif not fence and re.match(r"^#+ ", line):
            found.add(anchor(line.lstrip("#")))
    return found


def check_markdown(root, file):
    for number, line in lines_outside_code(file.read_text(errors="replace")):
        for target in LINK.findall(line):
            if EXTERNAL.match(target):
                continue
            path, _, heading = target.partition("#")
            goal = (file.parent / path).resolve() if path else file
            where = f"{file.relative_to(root)}:{number}: the link {target}"
            if not goal.exists():
                yield f"{where} leads to no file"
            elif heading and goal.suffix == ".md" and heading not in anchors(goal):
                yield f"{where} leads to no heading"


def check_paths(root, file):
    for number, line in enumerate(file.read_text(errors="replace").split("\n"), 1):
        for path in PATH.findall(LINK.sub("", line)):
            if not (root / path).exists():
                yield f"{file.relative_to(root)}:{number}: {path} does not exist"


def check(root):
    """Every broken link below the root."""
    files = sorted(root.glob("*.md"))
    for folder in FOLDERS:
        files += sorted((root / folder).rglob("*"))
    for file in files:
        if not file.is_file() or file.suffix not in EXTRACTORS or "__pycache__" in file.parts:
            continue
        if file.suffix == ".md":
            yield from check_markdown(root, file)
        # The changelog names files of earlier versions, the tests make them up.
        if file.name != "CHANGELOG.md" and "format" not in file.parts:
            yield from check_paths(root, file)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__).resolve()
    broken = list(check(root if len(sys.argv) > 1 else root.parents[2]))
    print("\n".join([*broken, f"{len(broken)} broken links"]))
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
