"""A distributed run whose processes are killed one after the other, in real time."""

import os
import signal
import time
import unittest

from deployment_case import DeploymentCase


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


if __name__ == "__main__":
    unittest.main()
