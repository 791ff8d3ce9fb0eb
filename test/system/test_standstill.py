"""A robot that stops, rolls back and drives on, and valves with faults.

During a stop no cause is latched and nothing is sprayed. It costs no weed. The ledger shows the
effects of valve faults."""

import collections
import json
import pathlib
import sys
import unittest

from furrow_case import FurrowCase

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
from measure_standstill import JOURNEYS, profile  # noqa: E402

GRAPH = ("--graph", "weeding_true_detections", "--length", 6)


def reasons(rows):
    """How many weeds were missed for which reason."""
    return collections.Counter(row["reason"] for row in rows if row["outcome"] == "missed")


class StandstillTest(FurrowCase):
    def sprays_s(self, out):
        features = json.loads((out / "as_applied.geojson").read_text())["features"]
        return sorted(feature["properties"]["time_s"] for feature in features)

    def compare(self, name):
        for seed in (1, 2):
            with self.subTest(journey=name, seed=seed):
                straight = self.run_graph(*GRAPH, "--seed", seed, out=self.folder / f"s{seed}")
                out = self.folder / f"{name}{seed}"
                stopped = self.run_graph(*GRAPH, "--seed", seed, *profile(name), out=out)
                print(f"{name}, seed {seed}: loss {straight['loss_pct']:.1f} % without, "
                      f"{stopped['loss_pct']:.1f} % with it")
                self.assertNotIn("Safe states", (out / "report.html").read_text())
                self.assertLessEqual(stopped["loss_pct"], straight["loss_pct"] + 1.0 + 1e-9)
                self.assertLessEqual(stopped["crops_hit"], straight["crops_hit"])
                for from_s, to_s in JOURNEYS[name][2]:
                    inside = [t for t in self.sprays_s(out) if from_s <= t <= to_s]
                    self.assertEqual(inside, [])

    def test_a_stop_of_a_minute(self):
        self.compare("stop")

    def test_rolling_back_by_30_cm(self):
        self.compare("roll")

    def test_three_stops(self):
        self.compare("three")


class ValveFaultTest(FurrowCase):
    def with_fault(self, kind, **window):
        from_s, until_s = window.get("from_s", 0), window.get("until_s", 1000)
        return self.run_graph(*GRAPH, "--seed", 3, "--set", 'robot.valve_fault_axis=["axis_2"]',
                              "--set", f'robot.valve_fault_kind=["{kind}"]',
                              "--set", f"robot.valve_fault_from_s=[{from_s}]",
                              "--set", f"robot.valve_fault_until_s=[{until_s}]",
                              out=self.folder / kind)

    def test_a_valve_that_gives_nothing_leaves_its_weeds_as_missed(self):
        sound = self.run_graph(*GRAPH, "--seed", 3, out=self.folder / "sound")
        for kind in ("stuck_shut", "blocked"):
            with self.subTest(kind=kind):
                summary = self.with_fault(kind)
                self.assertEqual(summary["sprays_by_axis"][1], 0)
                self.assertGreater(summary["missed"], sound["missed"] + 5)
                sound_by = reasons(self.ledger(self.folder / "sound"))
                by = reasons(self.ledger(self.folder / kind))
                self.assertEqual(by["unreachable"], sound_by["unreachable"], by)
                self.assertGreater(by["fault"], sound_by["fault"] + 5, by)

    def test_a_valve_that_does_not_shut_is_told_by_sprays_without_a_command(self):
        for kind in ("stuck_open", "leaking"):
            with self.subTest(kind=kind):
                summary = self.with_fault(kind, from_s=6, until_s=9)
                # A slice each 20 ms.
                self.assertGreater(summary["sprays_uncommanded"], 50)
                self.assertLessEqual(summary["sprays_uncommanded"], 150)

    def test_a_slow_valve_sprays_behind_its_aim(self):
        sound = self.run_graph(*GRAPH, "--seed", 3, out=self.folder / "sound")
        slow = self.with_fault("slow")
        # 50 ms at 0.5 m/s.
        self.assertGreater(slow["placement_error_p95_mm"], sound["placement_error_p95_mm"] + 15)

    def test_a_fault_that_does_not_exist_is_a_configuration_error(self):
        self.assert_refused(("run", "--no-dds", "--out", self.out, "--set",
                             'robot.valve_fault_axis=["axis_2"]', "--set",
                             'robot.valve_fault_kind=["melted"]', "--set",
                             "robot.valve_fault_from_s=[0]", "--set",
                             "robot.valve_fault_until_s=[9]"), "melted", "stuck_open")


if __name__ == "__main__":
    unittest.main()
