#!/usr/bin/env python3
"""Checks the language of comments, error and help texts and documents, and the size of sources.

    check_language.py [ROOT] [--file PATH...]

Reported as FILE:LINE are sentences of more than 30 words, words that docs/glossary.md rules out,
and functions and files that are too long. Exit code 1 when there is a finding.
"""

import argparse
import collections
import pathlib
import re
import sys

import source_size
import text_sources
from sentences import count_words, neutralize, split_sentences

MAX_WORDS = 30
FOLDERS = ("packages", "test", "tools", "launch_scripts", "idl", "params", "urdf", "docs", "models",
           "ros2", ".ci")
GENERATED = {f"docs/reference/{name}.md" for name in ("topics", "parameters", "command_line")}
GLOSSARY = "docs/glossary.md"

Finding = collections.namedtuple("Finding", "path line message")
Rule = collections.namedtuple("Rule", "pattern wrong right except_in")


def read_glossary(text):
    """The rules of a glossary: code spans in the column "not" of its tables are ruled out.

    A `*` stands for any end of a word. "(except in A, B)" behind a span names folders below which
    the word keeps its ordinary meaning.
    """
    rules, columns = [], {}
    for line in text.split("\n"):
        if not line.startswith("|"):
            columns = {}
            continue
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if not columns:
            columns = {name.lower(): index for index, name in enumerate(cells)}
        elif "not" in columns and len(cells) > columns["not"]:
            right = text_sources.plain(cells[0])
            for wrong, folders in re.findall(r"`([^`]+)`(?: \(except in ([^)]*)\))?",
                                             cells[columns["not"]]):
                rules.append(Rule(_pattern(wrong), wrong, right,
                                  tuple(name.strip() for name in folders.split(",") if name)))
    return rules


def _pattern(wrong):
    words = [re.escape(word).replace(r"\*", r"\w*") for word in re.split(r"[\s_-]+", wrong)]
    return re.compile(r"(?<![^\W_])" + r"[\s_-]+".join(words) + r"s?(?![^\W_])", re.IGNORECASE)


def check_text(path, line, text, rules):
    """Findings of one paragraph, list item, cell or literal."""
    for offset, sentence in split_sentences(text):
        words = count_words(sentence)
        if words > MAX_WORDS:
            yield Finding(path, line + text.count("\n", 0, offset),
                          f"a sentence of {words} words; at most {MAX_WORDS}: "
                          f"\"{' '.join(sentence.split()[:6])} ...\"")
    bare = neutralize(text)
    for rule in rules:
        for match in rule.pattern.finditer(bare):
            yield Finding(path, line + text.count("\n", 0, match.start()),
                          f"'{' '.join(match.group().split())}': write '{rule.right}'")


WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
IDENTIFIER = re.compile(r"\b[A-Za-z_]\w*\b")


def check_identifiers(path, text, rules):
    """One finding for each identifier of C++ that holds a word which is ruled out."""
    seen = set()
    code = text_sources.code_only(text)
    for match in IDENTIFIER.finditer(code):
        name = match.group()
        if name in seen:
            continue
        seen.add(name)
        words = " ".join(WORDS.findall(name))
        for rule in rules:
            if rule.pattern.search(words):
                yield Finding(path, code.count("\n", 0, match.start()) + 1,
                              f"identifier '{name}' holds '{rule.wrong}': use '{rule.right}'")


def check_file(root, path, rules):
    """All findings of one file, by line."""
    file = root / path
    text = file.read_text(errors="replace")
    rules = [rule for rule in rules if not path.startswith(rule.except_in or "\0")]
    findings = []
    if file.name == "CMakeLists.txt" or file.suffix != ".txt":
        for line, part in text_sources.texts(file.suffix, text):
            findings += check_text(path, line, part, rules)
    if file.suffix in {".hpp", ".cpp", ".h", ".c"}:
        findings += check_identifiers(path, text, rules)
    findings += [Finding(path, line, message)
                 for line, message in source_size.too_long(file.suffix, text)]
    return sorted(findings, key=lambda finding: (finding.line, finding.message))


def source_files(root):
    """Paths of all files that are checked, relative to the root."""
    candidates = [path for path in root.glob("*.md")]
    for folder in FOLDERS:
        candidates += (root / folder).rglob("*")
    for path in sorted(candidates):
        shown = path.relative_to(root).as_posix()
        if (path.is_file() and path.suffix in text_sources.EXTRACTORS
                and shown not in GENERATED and "__pycache__" not in path.parts):
            yield shown


def totals(findings):
    """A line for each package or folder, the one with most findings first."""
    counts = collections.Counter()
    for finding in findings:
        parts = finding.path.split("/")
        counts["/".join(parts[:2]) if parts[0] == "packages" else parts[0]] += 1
    for name, count in counts.most_common():
        yield f"{count:6} {name}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("root", type=pathlib.Path, nargs="?",
                        default=pathlib.Path(__file__).resolve().parents[2])
    parser.add_argument("--file", nargs="+", default=[""], metavar="PATH",
                        help="check only these files or folders, relative to ROOT")
    arguments = parser.parse_args()
    root = arguments.root

    rules = read_glossary((root / GLOSSARY).read_text())
    if not rules:
        print(f"{GLOSSARY}: no table with a column \"not\" was found")
        return 1
    paths = list(source_files(root))
    for chosen in arguments.file:
        if not any(path.startswith(chosen) for path in paths):
            print(f"--file {chosen}: no file that is checked begins with this path")
            return 2
    findings = [finding for path in paths if path.startswith(tuple(arguments.file))
                for finding in check_file(root, path, rules)]
    for finding in findings:
        print(f"{finding.path}:{finding.line}: {finding.message}")
    for line in totals(findings):
        print(line)
    print(f"{len(findings)} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
