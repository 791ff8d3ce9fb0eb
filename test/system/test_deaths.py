"""Processes of a distributed run that are killed, in real time."""

import os
import signal
import time
import unittest

from deployment_case import STOP_WITHIN_S, DeploymentCase


class DeathTest(DeploymentCase):
    def test_the_row_goes_on_whoever_is_killed(self):
        length_m = 14  # a busy machine takes its time to start eight processes again
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
        self.assertTrue(any(row["outcome"] != "missed" for row in weeds), up.text())

    def test_without_world_or_ledger_the_run_ends(self):
        for name in ("robot", "scorer"):
            up = self.up("--length", 10)
            up.wait_for("weeding 1")
            started = time.monotonic()
            os.kill(up.children()[name], signal.SIGKILL)
            up.wait_for(f"{name}.*the run cannot go on without it")
            self.assertEqual(up.finish(), 1)
            self.assertLess(time.monotonic() - started, STOP_WITHIN_S + 1.0)


    def test_a_run_without_its_report_has_failed(self):
        up = self.up("--length", 2)
        up.wait_for(r"weeding 5\d %")
        scorer = up.children()["scorer"]
        os.kill(scorer, signal.SIGSTOP)
        self.addCleanup(self.end, scorer)
        up.wait_for("^scorer .*does not end: killed")
        self.assertEqual(up.finish(), 1, up.text())
        self.assertFalse((self.out / "ledger.csv").exists())

    @staticmethod
    def end(process):
        try:
            os.kill(process, signal.SIGKILL)
        except ProcessLookupError:
            pass


if __name__ == "__main__":
    unittest.main()
