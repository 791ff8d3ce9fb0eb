"""Valves slower than their calibration: seen on the ground, and calibrated away."""

import json
import unittest

from furrow_case import FurrowCase
from test_actuation import CHANGING_SPEED

# 20 ms more than params/nozzles/simulated.yaml says.
SLOW_VALVES = ("--set", "robot.spray_open_delay_s=0.028", "--set",
               "robot.spray_close_delay_s=0.028")


class CalibrationTest(FurrowCase):

    def placement_p95_mm(self, name, *arguments):
        summary = self.run_graph("--graph", "weeding_true_detections", "--length", 10, "--seed", 7,
                                 *CHANGING_SPEED, *arguments, out=self.folder / name)
        p95_mm = summary["placement_error_p95_mm"]
        print(f"{name}: placement p95 {p95_mm:.2f} mm")
        return p95_mm

    def test_slow_valves_are_calibrated(self):
        before = self.placement_p95_mm("before")
        uncalibrated = self.placement_p95_mm("uncalibrated", *SLOW_VALVES)
        # 20 ms at 0.2 to 1.0 m/s are 4 to 20 mm.
        self.assertGreater(uncalibrated, before + 10.0)

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

    def test_offsets_measured_on_paper_are_taken(self):
        # 20 ms late, and 3 mm ahead and 2 mm to the right at any speed.
        lines = ["axis,speed_mps,along_mm,across_mm"]
        for speed_mps in (0.3, 0.6, 0.9):
            lines += [f"axis_2,{speed_mps},{20 * speed_mps + 3 + error},{-2 - error}"
                      for error in (-0.5, 0.0, 0.5)]
        measured = self.folder / "paper.csv"
        measured.write_text("\n".join(lines) + "\n")
        done = self.furrow("calibrate", "--measured", measured, "--out", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        nozzles = [dict(line.split(": ") for line in entry.split("\n    "))
                   for entry in self.out.read_text().strip().split("\n  - ")[1:]]
        self.assertEqual([nozzle["axis"] for nozzle in nozzles],
                         ["axis_1", "axis_2", "axis_3", "axis_4"])
        self.assertAlmostEqual(float(nozzles[1]["open_delay_s"]), 0.028, delta=1e-4)
        self.assertAlmostEqual(float(nozzles[1]["offset_x_m"]), 0.003, delta=1e-4)
        self.assertAlmostEqual(float(nozzles[1]["offset_y_m"]), -0.002, delta=1e-4)
        self.assertAlmostEqual(float(nozzles[0]["open_delay_s"]), 0.008, delta=1e-9)

        self.assert_refused(("calibrate", "--measured", "missing.csv"), "missing.csv")
        measured.write_text(lines[0] + "\naxis_9,0.5,1,1\n")
        self.assert_refused(("calibrate", "--measured", measured), "axis")

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
        self.assert_refused(("run", "--no-dds", "--clock", "lockstep", "--out", self.out, "--set",
                             f"driver.nozzle_file={nozzles}"), "nozzles.yaml", "axis_2")


if __name__ == "__main__":
    unittest.main()
