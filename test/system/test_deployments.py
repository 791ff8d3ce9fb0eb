"""Deployments over DDS on loopback: the same outcome wherever the components live; deaths, floods
and late joiners in real time."""

import os
import pathlib
import re
import signal
import socket
import subprocess
import threading
import time
import unittest

from furrow_case import FurrowCase, furrow_program

GRAPH = ["--graph", "weeding_true_detections", "--seed", "7"]
STOP_WITHIN_S = 2.0


def domain():
    """Of this process, so that runs beside each other do not meet."""
    return 100 + os.getpid() % 130


class Up:
    """A `furrow up` that runs, with what it printed so far."""

    def __init__(self, folder, out, *arguments):
        self.process = subprocess.Popen(
            [furrow_program(), "up", *GRAPH, "--wire", f"domain_id={domain()}", "--out", str(out),
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


class SameOutcomeTest(DeploymentCase):
    LENGTH_M = 3

    def test_composed_distributed_and_from_a_recording_give_the_same_ledger(self):
        """The recording is made by the distributed run, and played in both deployments."""
        recorded = self.folder / "recorded"
        played = [*GRAPH, "--recording", self.folder / "recorded_0.mcap"]
        self.run_graph(*GRAPH, "--length", self.LENGTH_M, out=self.folder / "composed")
        up = self.up("--clock", "lockstep", "--length", self.LENGTH_M, "--record", recorded,
                     out=self.folder / "distributed")
        self.assertEqual(up.finish(250), 0, up.text())
        self.run_graph(*played, out=self.folder / "from recording")
        up = self.up("--clock", "lockstep", *played[4:],
                     out=self.folder / "distributed from recording")
        self.assertEqual(up.finish(250), 0, up.text())
        for other in ("distributed", "from recording", "distributed from recording"):
            for name in ("ledger.csv", "map.svg"):
                self.assertEqual((self.folder / other / name).read_bytes(),
                                 (self.folder / "composed" / name).read_bytes(), (other, name))

    def test_a_death_ends_a_run_in_lock_step(self):
        up = self.up("--clock", "lockstep", "--length", 20)
        up.wait_for("weeding 1")
        os.kill(up.children()["tracker"], signal.SIGKILL)
        up.wait_for("tracker.*signal 9; the run cannot go on without it")
        self.assertEqual(up.finish(20), 1)
        self.assertFalse((self.out / "ledger.csv").exists())


class RealTimeTest(DeploymentCase):
    def assert_complete(self, rows):
        """Every plant once, and a reason for each weed that was missed."""
        self.assertGreater(len(rows), 50)
        self.assertEqual(len({row["plant_id"] for row in rows}), len(rows))
        for row in rows:
            if row["kind"] == "weed" and row["outcome"] == "missed":
                self.assertNotEqual(row["reason"], "", row)

    def test_the_row_goes_on_whoever_is_killed(self):
        length_m = 20  # a busy machine takes its time to start eight processes again
        up = self.up("--length", length_m, "--resume")
        up.wait_for("weeding ")
        names = [name for name in up.children() if name not in ("robot", "scorer")]
        self.assertGreaterEqual(len(names), 8)
        for name in sorted(names):
            before = up.children()[name]
            os.kill(before, signal.SIGKILL)
            up.wait_for(f"^{name} .*signal 9; started again")
            deadline = time.monotonic() + 10
            while up.children().get(name, before) == before:
                self.assertLess(time.monotonic(), deadline, f"{name} did not come back")
                time.sleep(0.05)
            time.sleep(1.0)
        self.assertEqual(up.finish(), 0, up.text())
        rows = self.ledger()
        self.assert_complete(rows)
        # The last metre is driven with everybody back.
        weeds = [row for row in rows if row["kind"] == "weed" and float(row["x_m"]) > length_m - 1.0]
        self.assertTrue(any(row["outcome"] != "missed" for row in weeds), weeds)

    def test_without_world_or_ledger_the_run_ends(self):
        for name in ("robot", "scorer"):
            up = self.up("--length", 10)
            up.wait_for("weeding 1")
            started = time.monotonic()
            os.kill(up.children()[name], signal.SIGKILL)
            up.wait_for(f"{name}.*the run cannot go on without it")
            self.assertEqual(up.finish(), 1)
            self.assertLess(time.monotonic() - started, STOP_WITHIN_S + 1.0)

    def test_ctrl_c_ends_all_within_two_seconds(self):
        up = self.up("--length", 20)
        up.wait_for("weeding 1")
        pids = list(up.children().values())
        started = time.monotonic()
        up.process.send_signal(signal.SIGINT)
        self.assertEqual(up.finish(), 1)
        self.assertLess(time.monotonic() - started, STOP_WITHIN_S)
        self.assertNotIn("killed", up.text())
        for pid in pids:
            self.assertFalse(pathlib.Path(f"/proc/{pid}").exists())

    def test_ctrl_c_ends_a_run_of_one_process_within_two_seconds(self):
        run = subprocess.Popen(
            [furrow_program(), "run", *GRAPH, "--length", "20", "--out", self.out,
             "--wire", f"domain_id={domain()}"],
            cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.kill)
        self.assertIn("weeding", run.stderr.readline())
        started = time.monotonic()
        run.send_signal(signal.SIGINT)
        text = run.communicate(timeout=20)[1]
        self.assertLess(time.monotonic() - started, STOP_WITHIN_S)
        self.assertEqual(run.returncode, 1, text)
        self.assertIn("interrupted", text)

    def test_late_joiners_and_garbage_on_the_ports_do_no_harm(self):
        # Long enough for a busy machine: everybody joins while it runs.
        up = self.up("--length", 16)
        up.wait_for("weeding 1")
        stop = threading.Event()
        flood = threading.Thread(target=self.throw_garbage, args=(stop,))
        flood.start()
        self.addCleanup(flood.join)
        self.addCleanup(stop.set)
        # A few at a time: it is not the computing power that is tried here.
        for _ in range(6):
            self.join_late(5)
            self.assertIsNone(up.process.poll(), "the run ended before everybody had joined")
        stop.set()
        self.assertEqual(up.finish(), 0, up.text())
        self.assertNotIn("signal", up.text())
        self.assert_complete(self.ledger())

    def test_a_subscriber_that_never_reads_holds_nobody_up(self):
        up = self.up("--length", 6)
        up.wait_for("weeding 1")
        for topic in ("localization/odometry", "axis/event", "planner/plan"):
            reader = subprocess.Popen(
                [furrow_program(), "topic", "echo", topic, "--domain", str(domain()),
                 "--wait", "10"],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.addCleanup(reader.wait)
            self.addCleanup(reader.kill)
            time.sleep(1.0)
            reader.send_signal(signal.SIGSTOP)
        self.assertEqual(up.finish(), 0, up.text())
        rows = self.ledger()
        self.assert_complete(rows)
        weeds = [row for row in rows if row["kind"] == "weed"]
        treated = [row for row in weeds if row["outcome"] != "missed"]
        self.assertGreater(len(treated), 0.5 * len(weeds))

    def join_late(self, count):
        joiners = [subprocess.Popen(
            [furrow_program(), "topic", "echo", "truth/field", "--domain", str(domain()),
             "--count", "1", "--wait", "20"],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                   for _ in range(count)]
        texts = [joiner.communicate(timeout=60)[0] for joiner in joiners]
        for joiner, text in zip(joiners, texts):
            self.assertEqual(joiner.returncode, 0, text)
            self.assertIn("plants:", text)

    @staticmethod
    def throw_garbage(stop):
        """Random bytes, and such that begin as RTPS does, to the ports of the domain's processes."""
        # RTPS: port 7400 + 250 * domain, discovery at +10 and data at +11 of each participant's 2.
        first = 7400 + 250 * domain()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            count = 0
            while not stop.wait(0.005):
                count += 1
                data = os.urandom(64 + count % 1000)
                if count % 2 == 0:
                    data = b"RTPS\x02\x03\x01\x0f" + data
                sender.sendto(data, ("127.0.0.1", first + 10 + count % 40))


class BadDeploymentTest(DeploymentCase):
    def test_what_is_wrong_is_said_before_anything_starts(self):
        for arguments, part in (
                (["--deploy", "three_hosts"], "name this one with --host: vision, planning"),
                (["--deploy", "three_hosts", "--host", "moon"], "there is no 'moon'"),
                (["--host", "vision"], "there are none: leave --host away"),
                (["--wire", "domain_id=900"], "domain_id: 900 is out of range"),
                (["--wire", "domian_id=9"], "domian_id"),
                (["--address", "vision=1.2.3.4"], "is not HOST=ADDRESS"),
                (["--seed", "-1"], "--seed")):
            self.assert_refused(["up", *arguments], part)
        self.assert_refused(["run", "--no-wire", "--deploy", "distributed", "--process", "robot"],
                            "cannot do with --no-wire")
        self.assert_refused(["run", "--no-wire", "--wire", "domain_id=900"], "out of range")


if __name__ == "__main__":
    unittest.main()
