"""Three hosts as three network namespaces: every way of discovery, and a host that is cut off."""

import os
import pathlib
import shutil
import subprocess
import unittest

from furrow_case import ROOT, FurrowCase, furrow_program

SCRIPT = ROOT / "launch_scripts" / "three_hosts.sh"


def why_not():
    """Why namespaces cannot be made here; empty when they can."""
    if os.geteuid() != 0:
        return "needs root"
    if shutil.which("ip") is None or shutil.which("unshare") is None:
        return "needs iproute2 and util-linux"
    name = f"furrow_probe_{os.getpid()}"
    made = subprocess.run(["ip", "netns", "add", name], capture_output=True, check=False)
    subprocess.run(["ip", "netns", "del", name], capture_output=True, check=False)
    return "" if made.returncode == 0 else "may not make network namespaces"


def namespaces():
    folder = pathlib.Path("/run/netns")
    return {path.name for path in folder.glob("furrow_*")} if folder.is_dir() else set()


REASON = why_not()


@unittest.skipIf(REASON, REASON)
class ThreeHostsTest(FurrowCase):
    def run_script(self, *arguments, **environment):
        before = namespaces()
        done = subprocess.run(
            [SCRIPT, *map(str, arguments), "--graph", "weeding_true_detections", "--seed", "7",
             "--out", self.out],
            cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, text=True, timeout=150, check=False,
            env={**os.environ, "FURROW_PROGRAM": str(furrow_program()), **environment})
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(namespaces(), before)
        return done.stdout

    def assert_complete(self, rows):
        self.assertGreater(len(rows), 20)
        self.assertEqual(len({row["plant_id"] for row in rows}), len(rows))
        for row in rows:
            if row["kind"] == "weed" and row["outcome"] == "missed":
                self.assertNotEqual(row["reason"], "", row)

    def test_every_way_of_discovery(self):
        for discovery in ("multicast", "static_peers", "discovery_server"):
            with self.subTest(discovery):
                shutil.rmtree(self.out, ignore_errors=True)
                self.run_script("--discovery", discovery, "--length", 1.5, "--resume")
                rows = self.ledger()
                self.assert_complete(rows)
                self.assertTrue(any(row["outcome"] == "accurate" for row in rows))

    def test_the_row_goes_on_when_a_host_was_cut_off(self):
        text = self.run_script("--length", 9, "--resume", FURROW_CUT="planning 9 5")
        rows = self.ledger()
        self.assert_complete(rows)
        weeds = [row for row in rows if row["kind"] == "weed"]
        self.assertTrue(any(row["outcome"] == "missed" for row in weeds), text)
        last = [row for row in weeds if float(row["x_m"]) > 8.0]
        self.assertTrue(any(row["outcome"] != "missed" for row in last), text)

    def test_bad_arguments_make_nothing(self):
        before = namespaces()
        done = subprocess.run([SCRIPT, "--discovery", "shouting"], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("multicast, static_peers or discovery_server", done.stderr)
        self.assertEqual(namespaces(), before)


if __name__ == "__main__":
    unittest.main()
