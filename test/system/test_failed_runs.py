"""Distributed runs that cannot go on, or end without their report."""

import os
import signal
import time
import unittest

from deployment_case import STOP_WITHIN_S, DeploymentCase


class FailedRunTest(DeploymentCase):
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
