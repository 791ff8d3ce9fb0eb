"""Valves that are slower than anybody told: seen on the ground, and calibrated away."""

import json
import unittest

from furrow_case import FurrowCase

# 20 ms more than params/nozzles/simulated.yaml says.
SLOW_VALVES = ("--set", "robot.spray_open_delay_s=0.028", "--set",
               "robot.spray_close_delay_s=0.028")


class CalibrationTest(FurrowCase):

    def placement_p95_mm(self, name, *arguments):
        summary = self.run_graph("--graph", "weeding_true_detections", "--length", 6, "--seed", 7,
                                 *arguments, out=self.folder / name)
        return summary["placement_error_p95_mm"]

    def test_slow_valves_are_calibrated(self):
        before = self.placement_p95_mm("before")
        uncalibrated = self.placement_p95_mm("uncalibrated", *SLOW_VALVES)
        # 20 ms at 0.5 m/s are 10 mm.
        self.assertGreater(uncalibrated, before + 7.0)

        nozzles = self.folder / "nozzles.yaml"
        report = self.folder / "report.json"
        done = self.furrow("calibrate", *SLOW_VALVES, "--out", nozzles, "--json", report)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = json.loads(report.read_text())["rows"]
        self.assertEqual([row["axis"] for row in rows], ["axis_1", "axis_2", "axis_3", "axis_4"])
        for row in rows:
            self.assertAlmostEqual(row["open_delay_s"], 0.028, delta=0.002)
            self.assertLess(row["p95_after_mm"], row["p95_before_mm"] - 5.0)

        after = self.placement_p95_mm("calibrated", *SLOW_VALVES, "--set",
                                      f"driver.nozzle_file={nozzles}")
        self.assertLess(after, before + 1.0)

    def test_one_seed_gives_one_calibration(self):
        texts = []
        for name in ("one.yaml", "two.yaml"):
            done = self.furrow("calibrate", *SLOW_VALVES, "--rounds", 1, "--out", name)
            self.assertEqual(done.returncode, 0, done.stderr)
            texts.append((self.folder / name).read_bytes())
        self.assertEqual(*texts)

    def test_a_nozzle_that_stays_off_is_an_error_and_writes_nothing(self):
        done = self.furrow("calibrate", "--rounds", 1, "--limit-mm", 0.01, "--out", self.out)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("nothing was written", done.stderr)
        self.assertFalse(self.out.exists())

    def test_bad_usage(self):
        self.assert_refused(("calibrate", "--graph", "no_such_graph"), "no_such_graph")
        self.assert_refused(("calibrate", "--set", "driver.nozzle_file=missing.yaml"),
                            "missing.yaml")
        self.assert_refused(("calibrate", "--out", self.folder), "is a folder")


class NozzleFileTest(FurrowCase):

    def test_an_axis_without_an_entry_is_refused(self):
        nozzles = self.folder / "nozzles.yaml"
        nozzles.write_text("nozzles:\n  - axis: axis_1\n")
        self.assert_refused(("run", "--no-wire", "--clock", "lockstep", "--out", self.out, "--set",
                             f"driver.nozzle_file={nozzles}"), "nozzles.yaml", "axis_2")


if __name__ == "__main__":
    unittest.main()
