"""The documents that are made from the code are as the code is now."""

import subprocess
import sys
import unittest

from furrow_case import ROOT, FurrowCase, furrow_program

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

    def test_command_line(self):
        command = [sys.executable, ROOT / "tools" / "command_reference.py", furrow_program()]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
        self.assert_current("command_line.md", done)


if __name__ == "__main__":
    unittest.main()
