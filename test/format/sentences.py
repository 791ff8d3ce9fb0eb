"""Splits plain text into sentences and counts their words, tolerant of technical text."""

import re

# A full stop after one of these ends no sentence.
ABBREVIATIONS = re.compile(
    r"\b(?:e\.\s?g|i\.\s?e|etc|vs|cf|al|approx|resp|incl|Fig|fig|Eq|No|St|Dr|Prof|Inc|p|pp)\.")
URL = re.compile(r"\b(?:https?|ftp|file)://[^\s)>\]]+")
# A figure with its unit. Figures are data, so they do not count as words.
FIGURE = re.compile(
    r"(?<![\w.])[-+~<>=±]*\d[\d.,:/x-]*"
    r"(?:\s?(?:%|mm2?|cm|m2?|km|µm|um|ns|us|µs|ms|s|min|h|Hz|kHz|MHz|GHz|B|kB|KB|KiB|MB|MiB|GB|GiB|"
    r"px|mpx|deg|rad|ml|mps|ha|(?:m|mm|rad|ml|MB|GB|ha)/(?:s[23]?|px|h|m2))(?![\w/]))?(?!\w)")
CITATION = re.compile(r"\([^()]*\b(?:19|20)\d\d[a-z]?\)")
END = re.compile(r"[.!?][)\"'”’`]*(?=\s+[\"'“‘(`*_\[]*[A-Z0-9¶]|\s*$)")
WORD = re.compile(r"[^\W\d_][\w'’/.\u2024-]*")
# Stands for code in running text. It counts as one word and may start a sentence.
CODE = "¶"


def _blank_dots(match):
    return match.group().replace(".", "\u2024")


def _same_length(replacement):
    """A replacement that keeps line breaks and length, so that offsets stay valid."""
    def replace(match):
        found = match.group()
        breaks = "".join("\n" if c == "\n" else " " for c in found)
        return replacement + breaks[len(replacement):]
    return replace


def neutralize(text):
    """`text` with CODE for code spans and URLs, and abbreviations without full stops."""
    text = re.sub(r"(`+)[^`]+\1", _same_length(CODE), text)
    text = URL.sub(_same_length(CODE), text)
    text = CITATION.sub(_same_length(" "), text)
    return ABBREVIATIONS.sub(_blank_dots, text)


def split_sentences(text):
    """Pairs of offset and sentence. `text` is one paragraph; line breaks count as spaces."""
    text = neutralize(text)
    start = 0
    for end in END.finditer(text):
        yield from _sentence(text, start, end.end())
        start = end.end()
    yield from _sentence(text, start, len(text))


def _sentence(text, start, end):
    part = text[start:end]
    stripped = part.lstrip()
    if stripped.rstrip():
        yield start + len(part) - len(stripped), stripped.rstrip()


def count_words(sentence):
    """The number of words. A code span is one word; figures with units and symbols are none."""
    bare = FIGURE.sub(" ", sentence)
    return len(WORD.findall(bare)) + bare.count(CODE)
