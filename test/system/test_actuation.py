"""The axes: where sprays land, the record of the sprays, the safe state, drives that are absent."""

import json
import unittest

from furrow_case import FurrowCase

TRUE_DETECTIONS = ("--graph", "weeding_true_detections", "--length", 4, "--seed", 7)

# Between 0.2 and 1.0 m/s: with up to 0.3 m/s2, and with 1.6 m/s2.
CHANGING_SPEED = ("--set", "planner.speed_source=measured",
                  "--set", "robot.profile_time_s=[0, 3, 5, 8, 10, 12, 15, 17, 20, 22, 26, 60]",
                  "--set", "robot.profile_speed_mps="
                  "[0.5, 0.5, 1.0, 0.2, 0.2, 0.8, 1.0, 0.4, 0.9, 0.3, 1.0, 0.5]")
HARSH_SPEED = ("--set", "planner.speed_source=measured",
               "--set", "robot.profile_time_s=[0, 3, 3.5, 6, 6.5, 9, 9.5, 12, 12.5, 15, 15.5, 60]",
               "--set", "robot.profile_speed_mps="
               "[0.2, 0.2, 1.0, 1.0, 0.2, 0.2, 1.0, 1.0, 0.2, 0.2, 1.0, 1.0]")


class PlacementTest(FurrowCase):

    def test_sprays_land_where_they_are_meant_while_the_speed_changes(self):
        for name, speed in (("changing", CHANGING_SPEED), ("harsh", HARSH_SPEED)):
            for seed in (1, 2, 3):
                with self.subTest(speed=name, seed=seed):
                    summary = self.run_graph("--graph", "weeding_true_detections", "--length", 10,
                                             "--seed", seed, *speed,
                                             out=self.folder / f"{name}_{seed}")
                    p95_mm = summary["placement_error_p95_mm"]
                    max_mm = summary["placement_error_deciles_mm"][-1]
                    print(f"{name} speed, seed {seed}: {summary['sprays']} sprays, placement p95 "
                          f"{p95_mm:.2f} mm, max {max_mm:.2f} mm")
                    self.assertGreater(summary["sprays"], 70)
                    self.assertLessEqual(p95_mm, 4.0)
                    self.assertLessEqual(max_mm, 10.0)
                    self.assertEqual(summary["crops_hit"], 0)


class AsAppliedTest(FurrowCase):

    def test_every_spray_is_on_the_map_in_wgs84(self):
        summary = self.run_graph(*TRUE_DETECTIONS)
        collection = json.loads((self.out / "as_applied.geojson").read_text())
        features = collection["features"]
        self.assertEqual(len(features), summary["sprays"])
        self.assertGreater(len(features), 10)
        for feature in features:
            longitude, latitude = feature["geometry"]["coordinates"]
            self.assertAlmostEqual(latitude, 50.6150, delta=0.001)
            self.assertAlmostEqual(longitude, 6.9870, delta=0.001)
            self.assertGreater(feature["properties"]["volume_ml"], 0.0)
        report = (self.out / "report.html").read_text()
        for title in ("Use by nozzle", "Use by crop row", "Use by area"):
            self.assertIn(title, report)

    def test_a_dry_run_sprays_nothing(self):
        summary = self.run_graph(*TRUE_DETECTIONS, "--set", "driver.dry_run=true")
        self.assertEqual(summary["sprays"], 0)
        self.assertEqual(summary["treated_accurate"], 0)
        self.assertGreater(sum(summary["axis_travel_m"]), 1.0)
        self.assertEqual(json.loads((self.out / "as_applied.geojson").read_text())["features"], [])


class SafetyTest(FurrowCase):

    def test_a_planner_that_beats_too_slowly_is_lost(self):
        summary = self.run_graph(*TRUE_DETECTIONS, "--set", "planner.heartbeat_rate_hz=1")
        self.assertEqual(summary["sprays"], 0)
        report = (self.out / "report.html").read_text()
        self.assertIn("Safe states", report)
        self.assertIn("peer_lost", report)


class DriveTest(FurrowCase):

    def test_drives_that_are_not_there_are_told(self):
        done = self.furrow("run", "--graph", "weeding_cia402", "--no-dds", "--clock", "lockstep",
                           "--length", 2, "--out", self.out,
                           *(argument for axis in range(1, 5) for argument in
                             ("--set", f"driver_axis_{axis}.drive_port={9 + axis}")))
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertEqual(summary["sprays"], 0)
        self.assertIn("no connection to the drive", (self.out / "report.html").read_text())


if __name__ == "__main__":
    unittest.main()
