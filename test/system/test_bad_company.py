"""A distributed run among other processes that join late, send garbage, or never read."""

import json
import os
import signal
import socket
import subprocess
import threading
import time
import unittest

from deployment_case import DeploymentCase
from furrow_case import domain, furrow_program


class BadCompanyTest(DeploymentCase):
    def test_late_joiners_and_garbage_on_the_ports_do_no_harm(self):
        # Longer than any machine needs to start the joiners. The test ends the run.
        up = self.up("--length", 200)
        up.wait_for("weeding 1")
        stop = threading.Event()
        flood = threading.Thread(target=self.throw_garbage, args=(stop,))
        flood.start()
        self.addCleanup(flood.join)
        self.addCleanup(stop.set)
        # A few at a time: it is not the computing power that is tried here.
        for _ in range(6):
            self.join_late(5)
            self.assertIsNone(up.process.poll(), "the run ended by itself:\n" + up.text())
        stop.set()
        up.process.send_signal(signal.SIGINT)
        self.assertEqual(up.finish(), 1, up.text())
        self.assertTrue(json.loads((self.out / "summary.json").read_text())["interrupted"])
        self.assertNotIn("ended by signal", up.text())
        self.assert_complete(self.ledger())

    def test_a_subscriber_that_never_reads_holds_nobody_up(self):
        up = self.up("--length", 5)
        up.wait_for("weeding 1")
        for topic in ("localization/odometry", "axis/event", "planner/plan"):
            reader = subprocess.Popen(
                [furrow_program(), "topic", "echo", topic, "--domain", str(domain()),
                 "--wait", "10"],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.addCleanup(reader.wait)
            self.addCleanup(reader.kill)
            time.sleep(1.0)
            reader.send_signal(signal.SIGSTOP)
        self.assertEqual(up.finish(), 0, up.text())
        rows = self.ledger()
        self.assert_complete(rows)
        weeds = [row for row in rows if row["kind"] == "weed"]
        treated = [row for row in weeds if row["outcome"] != "missed"]
        self.assertGreater(len(treated), 0.5 * len(weeds))

    def join_late(self, count):
        # Each process that joins costs computing power: on a busy machine discovery takes as many
        # times longer as there are others. The wait only ends a test that has failed.
        joiners = [subprocess.Popen(
            [furrow_program(), "topic", "echo", "truth/field", "--domain", str(domain()),
             "--count", "1", "--wait", "120"],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                   for _ in range(count)]
        texts = [joiner.communicate(timeout=300)[0] for joiner in joiners]
        for joiner, text in zip(joiners, texts):
            self.assertEqual(joiner.returncode, 0, text)
            self.assertIn("plants:", text)

    @staticmethod
    def throw_garbage(stop):
        """Sends random bytes, some with an RTPS header, to the ports of the domain's processes."""
        # RTPS: port 7400 + 250 * domain, discovery at +10 and data at +11 of each participant's 2.
        first = 7400 + 250 * domain()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            count = 0
            while not stop.wait(0.005):
                count += 1
                data = os.urandom(64 + count % 1000)
                if count % 2 == 0:
                    data = b"RTPS\x02\x03\x01\x0f" + data
                sender.sendto(data, ("127.0.0.1", first + 10 + count % 40))



if __name__ == "__main__":
    unittest.main()
