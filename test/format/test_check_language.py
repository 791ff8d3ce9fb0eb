"""The language check on made-up files: what it finds, and what it must not take for a finding."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import check_language
import source_size
import text_sources
from sentences import count_words, split_sentences

GLOSSARY = """
| term | meaning | not |
|---|---|---|
| delivery | a message's way | `hand-off`, `hand* over` |
| simulation step | one round | `wave` (except in packages/furrow_sea), hand signals |
"""
RULES = check_language.read_glossary(GLOSSARY)


def long_sentence(words=31):
    return "Word " + "word " * (words - 2) + "word."


class SentencesTest(unittest.TestCase):
    def sentences(self, text):
        return [sentence for _, sentence in split_sentences(text)]

    def test_splits_at_full_stops_before_a_new_sentence(self):
        self.assertEqual(len(self.sentences("One is here. Two is there! Is three? Yes.")), 4)

    def test_abbreviations_and_figures_end_no_sentence(self):
        for text in ("Fields, e.g. Those of beet, are wide.", "See Fig. 3 for 0.5 m.",
                     "Smith et al. 2021 say so.", "It takes 1.5 s on two cores.",
                     "Read a.b.C first."):
            self.assertEqual(len(self.sentences(text)), 1, text)

    def test_words_are_counted_without_figures_and_with_code_as_one(self):
        for text, words in (("Three plain words.", 3), ("It takes 12.5 ms of 4 GB.", 3),
                            ("Run `furrow run --out x y z` now.", 3),
                            ("See https://example.org/a/b-c?d=e. Now", 3),
                            ("Well-known, left/right e.g. here.", 4),
                            ("By filter (Bar-Shalom, Li and Kirubarajan 2001) here.", 3)):
            found = sum(count_words(sentence) for sentence in self.sentences(text))
            self.assertEqual(found, words, text)

    def test_offset_of_a_sentence_is_its_place_in_the_text(self):
        text = "One `a b`.\nTwo is here."
        self.assertEqual([offset for offset, _ in split_sentences(text)], [0, text.index("Two")])


class TextSourcesTest(unittest.TestCase):
    def texts(self, suffix, text):
        return list(text_sources.texts(suffix, text))

    def test_comment_lines_are_joined_to_a_paragraph(self):
        code = "/// One line\n/// and another.\n///\n/// Apart.\nint a;  // behind\nint b;\n"
        self.assertEqual(self.texts(".hpp", code),
                         [(1, "One line\nand another."), (4, "Apart."), (5, "behind")])

    def test_comments_behind_members_are_separate(self):
        code = "int a;  ///< one\nint b;  ///< two\n        ///< goes on\n"
        self.assertEqual(self.texts(".hpp", code), [(1, "one"), (2, "two\ngoes on")])

    def test_examples_and_lists_in_comments(self):
        code = "// Call it so:\n//   a = b + c\n// - one\n//   item\n// - two\n"
        self.assertEqual(self.texts(".cpp", code),
                         [(1, "Call it so:"), (3, "one\nitem"), (5, "two")])

    def test_no_comment_inside_a_literal_and_no_literal_inside_a_comment(self):
        code = 'auto url = "http://x/y";  // the "quoted words of a" comment\n'
        self.assertEqual(self.texts(".cpp", code), [(1, 'the "quoted words of a" comment')])

    def test_literals_that_are_put_together_are_one_text(self):
        code = 'fail("the file " + name(a, b) +\n     " does not hold "\n     "a row");\n'
        self.assertEqual(self.texts(".cpp", code), [(1, "the file X does not hold a row")])

    def test_keys_paths_and_patterns_are_no_texts(self):
        code = ('f("key"); g("a/b/c.txt"); h("a: b\\nc: {d: 1, e: two}");\n'
                'i(R"(some raw words here)");\n')
        self.assertEqual(self.texts(".cpp", code), [])

    def test_python_docstrings_and_comments(self):
        code = ('"""First.\n\n    usage here\n"""\n\n\n'
                'def f():\n    """Second."""\n    x = "# no"  # third\n')
        self.assertEqual(sorted(self.texts(".py", code)),
                         [(1, "First."), (8, "Second."), (9, "third")])

    def test_shell_comments(self):
        code = '#!/bin/sh\n# First\n# line.\necho "a # b" ${#x}  # second\n'
        self.assertEqual(self.texts(".sh", code), [(2, "First\nline."), (4, "second")])

    def test_markdown(self):
        document = ("# Title\n\nA [link](to/somewhere) and\n**bold** text.\n\n```\ncode here\n```\n"
                    "- item\n  goes on\n- next\n\n| a | b |\n|---|---|\n| cell | `code` |\n")
        self.assertEqual(self.texts(".md", document),
                         [(1, "Title"), (3, "A link and\nbold text."), (9, "item\ngoes on"),
                          (11, "next"), (13, "a"), (13, "b"), (15, "cell"), (15, "`code`")])


class GlossaryTest(unittest.TestCase):
    def found(self, text, path="docs/a.md"):
        rules = [r for r in RULES if not path.startswith(r.except_in or "\0")]
        return [f.message.split("'")[1] for f in check_language.check_text(path, 1, text, rules)]

    def test_code_spans_of_the_column_not_are_ruled_out(self):
        self.assertEqual([rule.wrong for rule in RULES], ["hand-off", "hand* over", "wave"])

    def test_a_word_is_found_with_its_forms(self):
        self.assertEqual(self.found("Hand-offs, one handed\nover in Waves."),
                         ["Hand-offs", "handed over", "Waves"])

    def test_other_words_and_code_are_not_found(self):
        self.assertEqual(self.found("Shorthand offers wavelets over `wave`; hand signals."), [])

    def test_a_folder_may_keep_the_ordinary_meaning(self):
        self.assertEqual(self.found("A wave.", "packages/furrow_sea/src/a.cpp"), [])

    def test_identifiers_are_split_into_words(self):
        code = "int run_wave(WaveExchange& x);  // wave\nint wavelet, kHandOver, run_wave;\n"
        found = [(f.line, f.message.split("'")[1])
                 for f in check_language.check_identifiers("a.cpp", code, RULES)]
        self.assertEqual(found, [(1, "run_wave"), (1, "WaveExchange"), (2, "kHandOver")])

    def test_the_glossary_of_the_project_has_rules_and_follows_them(self):
        root = pathlib.Path(__file__).resolve().parents[2]
        rules = check_language.read_glossary((root / check_language.GLOSSARY).read_text())
        self.assertIn("wave", [rule.wrong for rule in rules])
        self.assertEqual(check_language.check_file(root, check_language.GLOSSARY, rules), [])


class SourceSizeTest(unittest.TestCase):
    BODY = "  f();\n" * 59

    def lengths(self, code, suffix=".cpp"):
        return [(name, count) for _, count, name in source_size.FUNCTIONS[suffix](code)]

    def test_functions_methods_constructors_and_tests(self):
        code = ("namespace a {\nclass B : public C {\n public:\n"
                "  B() : c_{1}, d_(2) {\n    f({1});\n  }\n"
                "  int d() const { return 1; }\n};\n"
                "int B::e(int x) {\n  if (x) {\n    g([] { h(); });\n  }\n}\n"
                "TEST(B, Works) {\n}\n}\n")
        self.assertEqual(self.lengths(code),
                         [("B", 3), ("d", 1), ("B::e", 5), ("TEST(B, Works)", 2)])

    def test_tables_enums_and_braces_in_literals_are_no_functions(self):
        code = ('const int kA[] = {\n  f(1),\n};\nenum class E : int {\n  kA,\n};\n'
                'struct S {\n  int a = 0;\n  std::vector<int> b{1, 2};\n};\n'
                'void g() {\n  h("}");  // }\n}\n')
        self.assertEqual(self.lengths(code), [("g", 3)])

    def test_a_function_above_the_limit_is_reported_and_one_at_it_is_not(self):
        limit = "void f()\n{\n" + "  g();\n" * 57 + "}\n"
        self.assertEqual(list(source_size.too_long(".cpp", limit)), [])
        found = list(source_size.too_long(".cpp", "\n" + limit.replace("{\n", "{\n  g();\n", 1)))
        self.assertEqual([line for line, _ in found], [2])
        self.assertIn("'f' has 61 lines", found[0][1])

    def test_a_file_above_the_limit_is_reported(self):
        self.assertEqual(list(source_size.too_long(".hpp", "\n" * 400)), [])
        self.assertIn("401 lines", list(source_size.too_long(".hpp", "\n" * 401))[0][1])

    def test_python_functions(self):
        self.assertEqual(self.lengths("def f():\n    x = 1\n    return x\n", ".py"), [("f", 3)])

    def test_shell_functions(self):
        code = ("f() { g; }\nfunction h() {\n  if a; then\n    k() {\n      b\n    }\n  fi\n}\n"
                "l() {\n  m \"${n}\"\n}\n")
        self.assertEqual(self.lengths(code, ".sh"), [("h", 7), ("l", 3)])
        self.assertIn("'f' has 61 lines", list(source_size.too_long(
            ".sh", "f() {\n" + "  g\n" * 59 + "}\n"))[0][1])


class WorkspaceTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def check(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        self.assertIn(path, list(check_language.source_files(self.root)))
        return check_language.check_file(self.root, path, RULES)

    def test_line_of_a_sentence_that_is_too_long(self):
        found = self.check("packages/a/src/a.hpp", f"\n// Short one.\n// {long_sentence()}\n")
        self.assertEqual([finding.line for finding in found], [3])
        self.assertIn("31 words", found[0].message)

    def test_a_sentence_at_the_limit_is_not_reported(self):
        self.assertEqual(self.check("README.md", long_sentence(30)), [])

    def test_comments_of_other_files(self):
        for path in ("idl/a.idl", "params/a.yaml", "tools/a.sh", "packages/a/CMakeLists.txt",
                     "packages/a/src/a.py", "urdf/a.urdf"):
            comment = {"idl": "// {}\n", "urdf": "<!-- {} -->\n"}.get(path.split(".")[-1], "# {}\n")
            self.assertEqual(len(self.check(path, comment.format(long_sentence()))), 1, path)

    def test_generated_documents_are_left_out(self):
        (self.root / "docs/reference").mkdir(parents=True)
        (self.root / "docs/reference/topics.md").write_text(long_sentence())
        self.assertEqual(list(check_language.source_files(self.root)), [])

    def run_check(self, *arguments):
        return subprocess.run([sys.executable, check_language.__file__, self.root, *arguments],
                              capture_output=True, text=True, check=False)

    def test_any_finding_fails(self):
        self.check("docs/glossary.md", GLOSSARY)
        self.check("docs/good.md", "A delivery.\n")
        self.assertEqual(self.run_check().returncode, 0, self.run_check().stdout)
        self.check("docs/bad.md", "A hand-off.\n")
        done = self.run_check()
        self.assertEqual(done.returncode, 1)
        self.assertIn("docs/bad.md:1: 'hand-off': write 'delivery'", done.stdout)
        self.assertEqual(self.run_check("--file", "docs/good.md").returncode, 0)
        self.assertEqual(self.run_check("--file", "docs/bad.md").returncode, 1)
        self.assertEqual(self.run_check("--file", "docs/mistyped.md").returncode, 2)

    def test_totals_are_per_package(self):
        findings = [check_language.Finding(path, 1, "")
                    for path in ("packages/a/src/a.cpp", "packages/a/b.hpp", "docs/c/d.md")]
        self.assertEqual([line.split() for line in check_language.totals(findings)],
                         [["2", "packages/a"], ["1", "docs"]])


if __name__ == "__main__":
    unittest.main()
