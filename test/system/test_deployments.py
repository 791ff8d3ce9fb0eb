"""Deployments over DDS on loopback: the same outcome wherever the components live; what stops them."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

from deployment_case import GRAPH, STOP_WITHIN_S, DeploymentCase
from furrow_case import FurrowCase, domain, furrow_program


REPORT_FILES = ["as_applied.geojson", "ledger.csv", "map.svg", "report.html", "summary.json"]


class SameOutcomeTest(DeploymentCase):
    LENGTH_M = 1
    # Steps of the axes, each of which goes through all processes.
    SLOWER = ["--set", "driver.rate_hz=100"]

    def test_composed_distributed_and_from_a_recording_give_the_same_ledger(self):
        """The recording is made by the distributed run, and played in both deployments."""
        recorded = self.folder / "recorded"
        played = [*self.SLOWER, "--recording", self.folder / "recorded_0.mcap"]
        self.run_graph(*GRAPH, *self.SLOWER, "--length", self.LENGTH_M,
                       out=self.folder / "composed")
        up = self.up("--clock", "lockstep", *self.SLOWER, "--length", self.LENGTH_M, "--record",
                     recorded, out=self.folder / "distributed")
        self.assertEqual(up.finish(250), 0, up.text())
        self.run_graph(*GRAPH, *played, out=self.folder / "from recording")
        up = self.up("--clock", "lockstep", *played,
                     out=self.folder / "distributed from recording")
        self.assertEqual(up.finish(250), 0, up.text())
        for other in ("distributed", "from recording", "distributed from recording"):
            for name in ("ledger.csv", "map.svg"):
                self.assertEqual((self.folder / other / name).read_bytes(),
                                 (self.folder / "composed" / name).read_bytes(), (other, name))

    def test_a_death_ends_a_run_in_lock_step(self):
        up = self.up("--clock", "lockstep", *self.SLOWER, "--length", 5)
        up.wait_for("weeding 1")
        os.kill(up.children()["tracker"], signal.SIGKILL)
        up.wait_for("tracker.*signal 9; the run cannot go on without it")
        self.assertEqual(up.finish(20), 1)
        self.assertFalse((self.out / "ledger.csv").exists())


def why_no_small_memory():
    """Why /dev/shm cannot be made small here; empty when it can."""
    if os.geteuid() != 0 or shutil.which("unshare") is None:
        return "needs root and util-linux"
    made = subprocess.run(["unshare", "--mount", "mount", "-t", "tmpfs", "tmpfs", "/dev/shm"],
                          capture_output=True, check=False)
    return "" if made.returncode == 0 else "may not make mount namespaces"


class SmallSharedMemoryTest(FurrowCase):
    """A /dev/shm as small as that of a container, in a mount namespace of the program's own."""

    def setUp(self):
        super().setUp()
        if reason := why_no_small_memory():
            print(f"SKIPPED: {reason}")
            self.skipTest(reason)

    def within(self, size, *arguments):
        small = 'mount -t tmpfs -o size="$0" tmpfs /dev/shm && exec "$@"'
        return subprocess.run(
            ["unshare", "--mount", "sh", "-c", small, size, str(furrow_program()),
             *map(str, arguments), "--domain", str(domain()), "--out", str(self.out)],
            cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60,
            check=False)

    def test_too_little_for_a_deployment_is_told_before_it_starts(self):
        done = self.within("64m", "up", *GRAPH, "--length", 1)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertRegex(done.stderr, r"/dev/shm has 6\d\.\d MB free, and \d+ processes need \d+ MB")
        self.assertIn("--shm-size=", done.stderr)
        self.assertNotIn("signal 7", done.stdout + done.stderr)

    def test_too_little_for_one_process_is_told_before_it_starts(self):
        done = self.within("64k", "run", *GRAPH, "--length", 1)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn("1 process needs", done.stderr)

    def test_the_advice_works(self):
        done = self.within("64k", "run", *GRAPH, "--length", 1, "--clock", "lockstep", "--dds",
                           'transports=["udp"]')
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class CtrlCTest(DeploymentCase):
    def test_ctrl_c_ends_all_within_two_seconds(self):
        up = self.up("--length", 20)
        up.wait_for("weeding 1")
        pids = list(up.children().values())
        started = time.monotonic()
        up.process.send_signal(signal.SIGINT)
        self.assertEqual(up.finish(), 1)
        self.assertLess(time.monotonic() - started, STOP_WITHIN_S)
        self.assertNotIn("killed", up.text())
        self.assert_interrupted_report(weeds_at_least=50)
        for pid in pids:
            self.assertFalse(pathlib.Path(f"/proc/{pid}").exists())

    def assert_interrupted_report(self, weeds_at_least):
        """What was done so far is written, and marked."""
        self.assertLessEqual(set(REPORT_FILES), {path.name for path in self.out.iterdir()})
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertTrue(summary["interrupted"])
        self.assertGreater(summary["distance_m"], 0.0)
        self.assertGreaterEqual(summary["weeds_total"], weeds_at_least)
        self.assertGreater(summary["missed_by_reason"]["end_of_run"], 0)
        self.assertIn("interrupted", (self.out / "report.html").read_text())
        self.assertEqual(len(self.ledger()), summary["weeds_total"] + summary["crops_total"])

    def start_run(self, *arguments):
        run = subprocess.Popen(
            [furrow_program(), "run", *GRAPH, "--length", "20", "--out", self.out, *arguments],
            cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True)

        def end():
            if run.poll() is None:
                run.kill()
            run.communicate()
        self.addCleanup(end)
        self.assertIn("weeding", run.stderr.readline())
        return run

    def test_ctrl_c_ends_a_run_of_one_process_within_two_seconds(self):
        run = self.start_run("--domain", str(domain()))
        run.stderr.readline()  # a tenth of the way
        started = time.monotonic()
        run.send_signal(signal.SIGINT)
        text = run.communicate(timeout=20)[1]
        self.assertLess(time.monotonic() - started, STOP_WITHIN_S)
        self.assertEqual(run.returncode, 1, text)
        self.assertIn("interrupted", text)
        self.assert_interrupted_report(weeds_at_least=50)

    def test_ctrl_c_in_simulated_time_writes_the_report(self):
        run = self.start_run("--no-dds", "--clock", "lockstep")
        run.stderr.readline()  # a tenth of the way
        run.send_signal(signal.SIGINT)
        text = run.communicate(timeout=60)[1]
        self.assertEqual(run.returncode, 1, text)
        self.assert_interrupted_report(weeds_at_least=50)


class BadDeploymentTest(DeploymentCase):
    def test_what_is_wrong_is_said_before_anything_starts(self):
        for arguments, part in (
                (["--deploy", "three_hosts"], "name this one with --host: vision, planning"),
                (["--deploy", "three_hosts", "--host", "moon"], "there is no 'moon'"),
                (["--host", "vision"], "there are none: leave --host away"),
                (["--dds", "domain_id=900"], "domain_id: 900 is out of range"),
                (["--dds", "domian_id=9"], "domian_id"),
                (["--address", "vision=1.2.3.4"], "is not HOST=ADDRESS"),
                (["--seed", "-1"], "--seed")):
            self.assert_refused(["up", *arguments], part)
        self.assert_refused(["run", "--no-dds", "--deploy", "distributed", "--process", "robot"],
                            "--no-dds needs a single-process deployment")
        self.assert_refused(["run", "--no-dds", "--dds", "domain_id=900"], "out of range")


if __name__ == "__main__":
    unittest.main()
