"""Graphs without a simulator: on a domain without drivers, and with a recording of sensors."""

import json
import re
import signal
import subprocess
import time
import unittest

from furrow_case import FurrowCase, domain, furrow_program
from recording_case import SHORT_RUN_WITH_IMAGES, RecordingCase

SENSORS = ("camera/image", "camera/depth", "camera/camera_info", "wheel/odometry", "imu/data",
           "gnss/fix")
GRAPHS = ("observe", "robot_dry_run", "robot")


class Checks(FurrowCase):
    def test_every_graph_for_a_robot_is_well(self):
        for graph in GRAPHS:
            done = self.furrow("graph", "check", graph)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_run_that_no_driver_can_reach_is_refused_at_the_start(self):
        for graph in GRAPHS:
            for options in (("--no-dds",), ("--clock", "lockstep")):
                self.assert_refused(["run", "--graph", graph, "--out", self.out, *options],
                                    "camera/image", "wheel/odometry", "--recording", options[0])

    def test_observing_reaches_no_axis_and_no_robot(self):
        shown = self.furrow("graph", "show", "observe").stdout
        for topic in ("planner/plan", "planner/heartbeat", "robot/speed_request", "axis/event"):
            publishers = re.search(rf"^  {topic}  .*\n +from (.*)$", shown, re.MULTILINE)
            if publishers is not None:
                self.assertEqual(publishers[1], "-", topic)


class WithoutDrivers(FurrowCase):
    def test_observing_says_which_inputs_are_missing_and_what_that_means(self):
        run = subprocess.Popen(
            [furrow_program(), "run", "--graph", "observe", "--domain", str(domain()), "--out",
             self.out], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True)
        log = self.out / "run.log"
        until = time.monotonic() + 60
        while time.monotonic() < until and run.poll() is None:
            if log.exists() and "not heard" in log.read_text():
                break
            time.sleep(0.1)
        run.send_signal(signal.SIGINT)
        _, errors = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 1, errors)
        said = log.read_text()
        for topic in SENSORS:
            self.assertIn(f"{topic}: no writer was found", said)
        self.assertIn("perception cannot work without it", said)
        self.assertIn("localization works without it", said)
        self.assertNotIn("emergency_stop", said)


class WithARecording(RecordingCase):
    short_run = SHORT_RUN_WITH_IMAGES

    def setUp(self):
        super().setUp()
        self.part = self.folder / "sensors.mcap"
        done = self.furrow("bag", "cut", self.recorded, self.part, "--topics", *SENSORS)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_observing_decides_about_every_track_and_sprays_nothing(self):
        summary = self.run_graph("--graph", "observe", "--recording", self.part)
        self.assertGreater(summary["tracks_total"], 5)
        self.assertEqual(summary["sprays"], 0)
        decisions = [row["decision"] for row in self.ledger()]
        self.assertIn("treat", decisions)
        self.assertEqual(json.loads((self.out / "as_applied.geojson").read_text())["features"], [])

    def test_a_dry_run_opens_the_simulated_valves(self):
        summary = self.run_graph("--graph", "robot_dry_run", "--recording", self.part)
        self.assertGreater(summary["sprays"], 5)
        self.assertIs(summary["against_truth"], False)


if __name__ == "__main__":
    unittest.main()
