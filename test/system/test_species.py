"""What the ledger says of species and worth: enough to compute the planner's decisions again."""

import random
import unittest

from furrow_case import FurrowCase


class SpeciesTest(FurrowCase):
    THRESHOLD = 0.15

    def worth(self, row):
        """The worth by the paper's kappa, from the ledger alone."""
        return (float(row["seen_area_mm2"]) * float(row["beta"])
                * float(row["crop_proximity_per_mm2_m"]))

    def check(self, rows, at_least):
        appraised = [row for row in rows if row["worth"]]
        self.assertGreaterEqual(len(appraised), at_least)
        for row in random.Random(3).sample(appraised, min(200, len(appraised))):
            self.assertEqual(row["worth_scheme"], "kappa")
            self.assertEqual(float(row["worth_threshold"]), self.THRESHOLD)
            self.assertEqual(self.worth(row), float(row["worth"]), row)
            left = row["reason"] == "low_priority"
            if left or row["decision"] == "treat":
                self.assertEqual(left, float(row["worth"]) < self.THRESHOLD, row)
            self.assertLessEqual(float(row["unknown_probability"]), 1.0)
        return appraised

    def test_worth_and_decision_follow_from_the_ledger(self):
        self.run_graph("--graph", "weeding_true_detections", "--seed", 5, "--length", 20,
                       "--set", "planner.harmfulness_scheme=kappa",
                       "--set", f"planner.harmfulness_left_standing_below={self.THRESHOLD}")
        rows = self.ledger()
        appraised = self.check(rows, 200)
        decisions = {row["reason"] == "low_priority" for row in appraised}
        self.assertEqual(decisions, {True, False}, "the threshold lies within the weeds' worths")
        # True detections know the species. A track may stand for its neighbour in the ledger.
        right = sum(row["seen_species"] == row["species"] for row in appraised)
        self.assertGreaterEqual(right, 0.97 * len(appraised))

    def test_the_species_comes_from_the_camera(self):
        self.run_graph("--seed", 5, "--length", 3,
                       "--set", "planner.harmfulness_scheme=kappa",
                       "--set", f"planner.harmfulness_left_standing_below={self.THRESHOLD}")
        appraised = self.check(self.ledger(), 10)
        named = [row for row in appraised if row["seen_species"]]
        self.assertGreater(len(named), 0.9 * len(appraised))
        for row in named:
            self.assertGreater(float(row["seen_probability"]), 0.0)
        right = sum(row["seen_species"] == row["species"] for row in named)
        print(f"species right: {right} of {len(named)}")
        # The field has twelve weeds: a guess is right for one of twelve.
        self.assertGreater(right, 0.2 * len(named))


if __name__ == "__main__":
    unittest.main()
