"""The check of links on made-up documents."""

import pathlib
import tempfile
import unittest

import check_links


class LinksTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        self.write("docs/a.md", "# A `b` (c), d\n\n```\n# no heading\n```\n")

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def broken(self):
        return [line.split(": ")[0] for line in check_links.check(self.root)]

    def test_links_that_lead_somewhere(self):
        self.write("README.md", "[a](docs/a.md) [b](docs/a.md#a-b-c-d) [c](https://example.org)\n"
                                "`[no](link)`\n\n```\n[no](link)\n```\n")
        self.assertEqual(self.broken(), [])

    def test_a_file_that_does_not_exist(self):
        self.write("README.md", "\n[a](docs/b.md)\n![p](docs/p.png)\n")
        self.assertEqual(self.broken(), ["README.md:2", "README.md:3"])

    def test_a_heading_that_does_not_exist(self):
        self.write("docs/b.md", "[a](a.md#no-heading)\n[b](#b)\n")
        self.assertEqual(self.broken(), ["docs/b.md:1", "docs/b.md:2"])

    def test_a_path_in_a_source(self):
        self.write("packages/p/src/a.cpp", "// See docs/a.md.\n// See docs/b.md.\n")
        self.assertEqual(self.broken(), ["packages/p/src/a.cpp:2"])


if __name__ == "__main__":
    unittest.main()
