"""Whole runs over a short row, in simulated time: repeatability, accounting, accuracy."""

import json
import subprocess
import unittest

from furrow_case import FurrowCase, furrow_program

LENGTH_M = 2
WALL_CLOCK_KEYS = {"realtime_factor", "wall_s"}
MISSES = {"undetected", "unconfirmed", "misclassified", "low_priority", "protected_crop",
          "unreachable", "stale", "outside", "fault", "placement", "end_of_run",
          "inactive", "unsure"}
# What a planner may lose when it sees everything and the machine does as it says.
PLANNING_MISSES = {"low_priority", "protected_crop", "unreachable", "outside", "end_of_run"}


def without_wall_clock(summary):
    return {key: value for key, value in summary.items() if key not in WALL_CLOCK_KEYS}


class RenderedRowTest(FurrowCase):
    """The default graph at 8.2 weeds per m2 and 0.5 m/s, twice with one seed."""

    @classmethod
    def setUpClass(cls):
        case = cls("test_every_plant_is_accounted_for")
        FurrowCase.setUp(case)
        cls.addClassCleanup(case.doCleanups)
        cls.runs = []
        for name, threads in (("first", 2), ("second", 1)):
            out = case.folder / name
            summary = case.run_graph("--seed", 7, "--length", LENGTH_M, "--threads", threads,
                                     out=out)
            cls.runs.append((out, summary))

    def test_one_seed_gives_the_same_bytes(self):
        (first, summary), (second, again) = self.runs
        for name in ("ledger.csv", "map.svg"):
            self.assertEqual((first / name).read_bytes(), (second / name).read_bytes(), name)
        self.assertEqual(without_wall_clock(summary), without_wall_clock(again))
        self.assertTrue(WALL_CLOCK_KEYS <= summary.keys())

    def test_every_plant_is_accounted_for(self):
        out, summary = self.runs[0]
        rows = self.ledger(out)
        weeds = [row for row in rows if row["kind"] == "weed"]
        crops = [row for row in rows if row["kind"] == "crop"]
        missed = [row for row in weeds if row["outcome"] == "missed"]
        # 8.2 weeds/m2 on 2 m by 1.39 m are 23 on average, with a standard deviation of 4.8.
        self.assertGreater(len(weeds), 23 - 4 * 4.8)
        self.assertLess(len(weeds), 23 + 4 * 4.8)
        self.assertEqual(len({row["plant_id"] for row in rows}), len(rows))
        for row in missed:
            self.assertIn(row["reason"], MISSES, row)
        self.assertEqual(len(weeds), summary["weeds_total"])
        self.assertEqual(len(crops), summary["crops_total"])
        self.assertEqual(len(missed), summary["missed"])
        self.assertEqual(sum(summary["missed_by_reason"].values()), summary["missed"])
        self.assertEqual(summary["treated_accurate"] + summary["treated_partial"] + len(missed),
                         len(weeds))
        self.assertAlmostEqual(summary["loss_vision_pct"] + summary["loss_planning_pct"],
                               summary["loss_pct"], places=3)

    def test_sprays_land_where_they_should(self):
        summary = self.runs[0][1]
        # More than half of the weeds: a run that sprays nothing places nothing wrongly.
        self.assertGreater(summary["treated_accurate"], 0.5 * summary["weeds_total"])
        self.assertLess(summary["placement_error_p95_mm"], 10.0)
        self.assertLess(summary["crops_hit"], 0.02 * summary["crops_total"])

    def test_report_is_whole_and_self_contained(self):
        out = self.runs[0][0]
        self.assertEqual(sorted(path.name for path in out.iterdir()),
                         ["as_applied.geojson", "ledger.csv", "map.svg", "report.html", "run.log",
                          "summary.json"])
        page = (out / "report.html").read_text()
        self.assertTrue(page.rstrip().endswith("</html>"))
        for outside in ("src=\"http", "href=\"http", "<script", "url(http"):
            self.assertNotIn(outside, page)


class TrueDetectionsTest(FurrowCase):
    """A perfect detector by a switch in the graph file: planning's own loss is left."""

    def test_only_planning_loses(self):
        summary = self.run_graph("--graph", "weeding_true_detections", "--seed", 7, "--length", 20)
        self.assertEqual(summary["loss_vision_pct"], 0.0)
        lost = {reason for reason, count in summary["missed_by_reason"].items() if count}
        self.assertLessEqual(lost, PLANNING_MISSES)
        for row in self.ledger():
            if row["kind"] == "weed" and row["outcome"] == "missed":
                # Never one that the plan wanted: what it decided to treat was treated.
                self.assertNotEqual(row["decision"], "treat", row)
                self.assertEqual(row["axis"], "", row)
        self.assertLess(summary["placement_error_p95_mm"], 5.0)
        self.assertEqual(summary["crops_hit"], 0)

    def test_another_seed_is_another_field(self):
        common = ["--graph", "weeding_true_detections", "--length", 3]
        self.run_graph(*common, "--seed", 1, out=self.folder / "1")
        self.run_graph(*common, "--seed", 2, out=self.folder / "2")
        self.assertNotEqual(self.ledger(self.folder / "1"), self.ledger(self.folder / "2"))


class DistractionsTest(FurrowCase):
    """What is around a run must not matter."""

    def test_a_report_does_not_replace_the_one_before(self):
        common = ["run", "--no-dds", "--clock", "lockstep", "--graph", "weeding_true_detections",
                  "--length", 3, "--out", self.out]
        self.furrow(*common, "--seed", 1)
        first = (self.out / "ledger.csv").read_bytes()
        done = self.furrow(*common, "--seed", 2)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("out-2", done.stderr)
        self.assertIn("out-2", done.stdout)
        self.assertEqual((self.out / "ledger.csv").read_bytes(), first)
        second = (self.folder / "out-2" / "ledger.csv").read_bytes()
        self.assertNotEqual(second, first)
        done = self.furrow(*common, "--seed", 2, "--force")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.out / "ledger.csv").read_bytes(), second)
        self.assertFalse((self.folder / "out-3").exists())

    def test_two_runs_at_a_time_do_not_share_a_folder(self):
        runs = [subprocess.Popen(
            [furrow_program(), "run", "--no-dds", "--clock", "lockstep", "--graph",
             "weeding_true_detections", "--length", "3", "--seed", str(seed), "--out", self.out],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                for seed in (1, 2)]
        for run in runs:
            text = run.communicate(timeout=100)[1]
            self.assertEqual(run.returncode, 0, text)
        seeds = {json.loads((self.folder / name / "summary.json").read_text())["seed"]
                 for name in ("out", "out-2")}
        self.assertEqual(seeds, {1, 2})

    def test_generated_field_can_be_kept_and_run_again(self):
        for name in ("field.csv", "field.geojson"):
            field = self.folder / name
            done = self.furrow("field", "generate", "--length", 3, "--seed", 5, "--out", field)
            self.assertEqual(done.returncode, 0, done.stderr)
            summary = self.run_graph("--graph", "weeding_true_detections", "--field", field)
            shown = self.furrow("field", "show", field)
            self.assertEqual(shown.returncode, 0, shown.stderr)
            self.assertIn(f"{summary['weeds_total']} weeds,", shown.stdout)


if __name__ == "__main__":
    unittest.main()
