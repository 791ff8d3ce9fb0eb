"""What the tests of deployments share."""

import pathlib
import re
import subprocess
import threading

from furrow_case import FurrowCase, domain, furrow_program

GRAPH = ["--graph", "weeding_true_detections", "--seed", "7"]
STOP_WITHIN_S = 2.0


class Up:
    """A `furrow up` that runs, with what it printed so far."""

    def __init__(self, folder, out, *arguments):
        graph = [] if "--graph" in arguments else GRAPH
        self.process = subprocess.Popen(
            [furrow_program(), "up", *graph, "--dds", f"domain_id={domain()}", "--out", str(out),
             *map(str, arguments)],
            cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True)
        self.lines = []
        self.changed = threading.Condition()
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        for line in self.process.stdout:
            with self.changed:
                self.lines.append(line.rstrip("\n"))
                self.changed.notify_all()

    def wait_for(self, pattern, timeout_s=60):
        """The first line that the pattern matches."""
        found = []

        def look():
            found[:] = [line for line in self.lines if re.search(pattern, line)]
            return found or self.process.poll() is not None
        with self.changed:
            self.changed.wait_for(look, timeout_s)
        if not found:
            raise AssertionError(f"no line like {pattern!r} in:\n" + "\n".join(self.lines))
        return found[0]

    def children(self):
        """Process ids by the name of the process in the deployment."""
        named = {}
        tasks = pathlib.Path(f"/proc/{self.process.pid}/task")
        for listed in tasks.glob("*/children"):
            for pid in listed.read_text().split():
                try:
                    command = pathlib.Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
                except FileNotFoundError:
                    continue
                for argument in command:
                    if argument.startswith(b"--process="):
                        named[argument.split(b"=")[1].decode()] = int(pid)
        return named

    def finish(self, timeout_s=120):
        code = self.process.wait(timeout_s)
        self.reader.join(10)
        self.process.stdout.close()
        return code

    def text(self):
        return "\n".join(self.lines)


class DeploymentCase(FurrowCase):
    def up(self, *arguments, out=None):
        up = Up(self.folder, out or self.out, *arguments)

        def end():
            if up.process.poll() is None:
                up.process.terminate()
            up.finish()
        self.addCleanup(end)
        return up

    def assert_complete(self, rows):
        """Every plant once, and a reason for each weed that was missed."""
        self.assertGreater(len(rows), 50)
        self.assertEqual(len({row["plant_id"] for row in rows}), len(rows))
        for row in rows:
            if row["kind"] == "weed" and row["outcome"] == "missed":
                self.assertNotEqual(row["reason"], "", row)
