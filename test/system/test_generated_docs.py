"""The documents that the command writes are as the code is now."""

import unittest

from furrow_case import ROOT, FurrowCase


class GeneratedDocumentsTest(FurrowCase):
    def assert_current(self, document, *command):
        done = self.furrow(*command)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((ROOT / "docs" / document).read_text(), done.stdout,
                         f"write it anew: furrow {' '.join(command)} > docs/{document}")

    def test_topics(self):
        self.assert_current("topics.md", "graph", "topics")

    def test_parameters(self):
        self.assert_current("parameters.md", "params", "describe", "--markdown")


if __name__ == "__main__":
    unittest.main()
