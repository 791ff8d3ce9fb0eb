"""The documents that are made from the code are as the code is now."""

import unittest

from furrow_case import ROOT, FurrowCase

REFERENCE = ROOT / "docs" / "reference"


class GeneratedDocumentsTest(FurrowCase):
    def assert_current(self, document, done):
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((REFERENCE / document).read_text(), done.stdout,
                         "write it anew: tools/generate_docs.sh")

    def test_topics(self):
        self.assert_current("topics.md", self.furrow("graph", "topics"))

    def test_parameters(self):
        self.assert_current("parameters.md", self.furrow("params", "describe", "--markdown"))


if __name__ == "__main__":
    unittest.main()
