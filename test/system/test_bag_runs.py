"""Runs of the graph from bags of ROS 1 and ROS 2, without converting them first."""

import json
import unittest

import foreign_bags
from furrow_case import domain
from recording_case import SHORT_RUN, RecordingCase


class BagRunTest(RecordingCase):
    record_options = ["--set", "recorder.compression=none"]

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        recording = foreign_bags.Recording(cls.recorded)
        folder = cls.recorded.parent
        cls.bags = {"rosbag1": foreign_bags.write_bag(recording, folder / "run.bag"),
                    "rosbag2": foreign_bags.write_rosbag2(recording, folder / "rosbag2")}

    def ledger_of(self, recording, name):
        out = self.folder / name
        summary = self.run_graph(*SHORT_RUN, "--recording", recording, out=out)
        self.assertGreater(summary["sprays"], 0)
        return (out / "ledger.csv").read_bytes()

    def test_a_run_from_a_bag_is_that_from_the_mcap_file(self):
        expected = self.ledger_of(self.recorded, "mcap")
        for name, bag in self.bags.items():
            with self.subTest(name):
                row = self.bag_info(bag)
                self.assertEqual(row["format"], name)
                self.assertEqual(row["counts"], self.bag_info(self.recorded)["counts"])
                self.assertEqual(self.ledger_of(bag, name), expected)

    def test_bags_are_played_with_all_their_messages(self):
        topics = ["wheel/odometry", "truth/*"]
        played = {}
        for name, bag in {"mcap": self.recorded, **self.bags}.items():
            done = self.furrow("play", bag, "--domain", domain(), "--wait", 0, "--rate", 20,
                               "--topics", *topics)
            self.assertEqual(done.returncode, 0, done.stderr)
            played[name] = done.stdout.split(" messages")[0].split()[-1]
        self.assertEqual(len(set(played.values())), 1, played)

    def test_a_damaged_bag_is_told_and_the_rest_of_it_is_used(self):
        bag = self.folder / "damaged.bag"
        data = self.bags["rosbag1"].read_bytes()
        bag.write_bytes(data[:int(0.8 * len(data))])
        done = self.furrow("bag", "verify", bag)
        self.assertEqual(done.returncode, 1, done.stdout)
        done = self.furrow("run", "--no-dds", "--clock", "lockstep", "--out", self.out, *SHORT_RUN,
                           "--recording", bag)
        self.assertIn("not whole", done.stdout)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(json.loads((self.out / "summary.json").read_text())["sprays"], 0)

    def test_a_bag_without_a_needed_topic_is_refused(self):
        bag = self.folder / "part.bag"
        recording = foreign_bags.Recording(self.recorded)
        wheels = {number for number, channel in recording.channels.items()
                  if channel[0] == "/wheel/odometry"}
        self.assertEqual(len(wheels), 1)
        for number in wheels:
            recording.channels[number] = ("/husky/odom", *recording.channels[number][1:])
        foreign_bags.write_bag(recording, bag)
        run = ["run", "--no-dds", "--clock", "lockstep", "--out", self.out, *SHORT_RUN,
               "--recording", bag]
        self.assert_refused(run, "has no 'wheel/odometry'")
        self.run_graph(*SHORT_RUN, "--recording", bag, "--set",
                       "playback.remap=[husky/odom=wheel/odometry]")


if __name__ == "__main__":
    unittest.main()
