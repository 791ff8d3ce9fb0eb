"""The check of the format on made-up sources."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

CHECK = pathlib.Path(__file__).with_name("check_format.sh")
STYLE = CHECK.parents[2] / ".clang-format"


@unittest.skipUnless(shutil.which("clang-format"), "clang-format is not installed")
class FormatTest(unittest.TestCase):
    def check(self, text):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            shutil.copy(STYLE, root)
            source = root / "packages" / "p" / "src" / "a.cpp"
            source.parent.mkdir(parents=True)
            source.write_text(text)
            return subprocess.run([CHECK, root], capture_output=True, text=True, check=False)

    def test_a_formatted_source_passes(self):
        done = self.check("int main() {\n  return 0;\n}\n")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_a_source_that_is_not_formatted_fails_and_is_named(self):
        done = self.check("int main()   { return 0 ; }\n")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("packages/p/src/a.cpp\n", done.stdout)


if __name__ == "__main__":
    unittest.main()
