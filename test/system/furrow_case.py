"""What the tests of the `furrow` command share."""

import csv
import fcntl
import functools
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def furrow_program():
    """The command of the workspace that is tested, in either layout of colcon's install folder."""
    prefix = pathlib.Path(os.environ.get("FURROW_INSTALL_PREFIX", ROOT / "install" / "x"))
    for folder in (prefix.parent / "furrow_cli", prefix):
        if (folder / "bin" / "furrow").exists():
            return folder / "bin" / "furrow"
    raise FileNotFoundError(f"no furrow command beside or in {prefix}: build furrow_cli first")


@functools.cache
def domain():
    """A DDS domain that no other test on this host uses as long as this process lives. Up to 100:
    the system gives the ports of those above to any program."""
    first = os.getpid()
    for number in range(91):
        candidate = 10 + (first + number) % 91
        path = pathlib.Path(tempfile.gettempdir()) / f"furrow_test_domain_{candidate}"
        try:
            lock = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        except PermissionError:
            continue
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return candidate
        except BlockingIOError:
            os.close(lock)
    raise RuntimeError("other tests use all domains")


class FurrowCase(unittest.TestCase):
    """Runs the command in a folder of the case's own, whose name holds a space."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="furrow test ")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out = self.folder / "out"

    def furrow(self, *arguments, timeout=200):
        return subprocess.run([furrow_program(), *map(str, arguments)], cwd=self.folder,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=timeout, check=False)

    def run_graph(self, *arguments, out=None, **options):
        """A run in simulated time that must succeed; its summary."""
        out = out or self.out
        done = self.furrow("run", "--no-dds", "--clock", "lockstep", "--out", out, *arguments,
                           **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads((out / "summary.json").read_text())

    def ledger(self, out=None):
        with open((out or self.out) / "ledger.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def bag_info(self, file):
        """What `bag info` says of a file, by topic."""
        table = self.folder / "info.json"
        done = self.furrow("bag", "info", file, "--json", table, "--force")
        self.assertIn(done.returncode, (0, 1), done.stderr)
        row = json.loads(table.read_text())["rows"][0]
        row["counts"] = {topic["topic"]: topic["messages"] for topic in row["topics"]}
        return row

    def assert_refused(self, arguments, *parts):
        """Exit code 2, a message with all parts, and nothing left where the report was to be."""
        done = self.furrow(*arguments)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)
        self.assertEqual(done.stdout, "")
        left = sorted(self.out.rglob("*")) if self.out.is_dir() else []
        self.assertEqual(left, [])

    def copy_share(self):
        """The shipped params/ and urdf/, to be changed; the folder that holds them."""
        for name in ("params", "urdf"):
            shutil.copytree(ROOT / name, self.folder / "share" / name)
        return self.folder / "share"

    def edit(self, path, old, new):
        """Replaces text that must be there; the line that it stood on, counted from 1."""
        text = path.read_text()
        self.assertIn(old, text)
        path.write_text(text.replace(old, new, 1))
        return text[:text.index(old)].count("\n") + 1
