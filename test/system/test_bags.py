"""Recordings of other programs by the command: what it reads, tells, keeps and refuses."""

import csv
import json
import pathlib
import signal
import subprocess
import sys
import time
import unittest

from furrow_case import FurrowCase, domain, furrow_program

RECORDING = pathlib.Path(__file__).resolve().parents[2] / "packages" / "furrow_recording"
sys.path[:0] = [str(RECORDING / "test" / "conformance"), str(RECORDING / "fuzz")]
import generate  # noqa: E402
import make_seeds  # noqa: E402

TEXT_SCHEMA = (generate.SCHEMA, {"id": 1, "name": "std_msgs/msg/String", "encoding": "ros2msg",
                                 "data": b"string data"})
SECOND_NS = 1_000_000_000


def text_channel(number, topic, encoding="cdr", metadata=None):
    return generate.CHANNEL, {"id": number, "schema": 1, "topic": topic, "encoding": encoding,
                              "metadata": metadata or {}}


def text_message(channel, time_ns, data=b"\0\1\0\0\2\0\0\0x\0"):
    return generate.MESSAGE, {"channel": channel, "sequence": 0, "log_time": time_ns,
                              "publish_time": time_ns, "data": data}


class BagCase(FurrowCase):
    def write_mcap(self, name, records, features=frozenset()):
        path = self.folder / name
        path.write_bytes(generate.File(records, set(features)).build())
        return path

    def texts(self, name, count=5, encoding="cdr"):
        """An MCAP file of messages on /chatter, a tenth of a second apart."""
        return self.write_mcap(name, [
            TEXT_SCHEMA, text_channel(1, "/chatter", encoding),
            *(text_message(1, SECOND_NS + i * SECOND_NS // 10) for i in range(count))])

    def start(self, *arguments):
        process = subprocess.Popen([furrow_program(), *map(str, arguments)], cwd=self.folder,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process


class ConformanceTest(BagCase):
    def test_the_whole_set_is_read_and_sound(self):
        subprocess.run([sys.executable, RECORDING / "test" / "conformance" / "generate.py",
                        self.folder], check=True)
        expected = [line.split("\t") for line in
                    (self.folder / "expected.tsv").read_text().splitlines()]
        self.assertEqual(len(expected), 416)
        files = [self.folder / f"{line[0]}.mcap" for line in expected]
        done = self.furrow("bag", "verify", *files)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(done.stdout.count(": sound, "), 416)
        done = self.furrow("bag", "info", *files, "--json", "info.json")
        self.assertEqual(done.returncode, 0, done.stdout)
        rows = json.loads((self.folder / "info.json").read_text())["rows"]
        for line, row in zip(expected, rows):
            self.assertEqual(row["messages"], int(line[1]), line[0])
            self.assertEqual(row["attachments"], int(line[4]), line[0])
            self.assertEqual(row["metadata"], int(line[5]), line[0])


class FormatTest(BagCase):
    def formats(self):
        bag = self.folder / "robot.bag"
        bag.write_bytes(make_seeds.bag_seed(b"bz2", True))
        db3 = self.folder / "rosbag2" / "run_0.db3"
        db3.parent.mkdir()
        db3.write_bytes(make_seeds.db3_seed(True))
        (db3.parent / "metadata.yaml").write_text(
            "rosbag2_bagfile_information:\n  relative_file_paths: [run_0.db3]\n")
        return {"rosbag1": bag, "rosbag2": db3.parent}

    def test_bags_are_described_verified_and_converted(self):
        for name, path in self.formats().items():
            with self.subTest(name):
                row = self.bag_info(path)
                self.assertEqual(row["format"], name)
                self.assertEqual(row["messages"], 3)
                done = self.furrow("bag", "verify", path)
                self.assertEqual(done.returncode, 0, done.stdout)
                converted = self.folder / f"{name}.mcap"
                done = self.furrow("bag", "convert", path, converted)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertEqual(self.bag_info(converted)["counts"], row["counts"])
                self.assertEqual(self.furrow("bag", "verify", converted).returncode, 0)

    def test_bags_are_played(self):
        for name, path in self.formats().items():
            with self.subTest(name):
                done = self.furrow("play", path, "--domain", domain(), "--wait", 0, "--rate", 100)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn("3 messages", done.stdout)

    def test_recordings_are_merged_filtered_compressed_and_exported(self):
        paths = list(self.formats().values())
        merged = self.folder / "merged.mcap"
        done = self.furrow("bag", "merge", *paths, "--out", merged)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.bag_info(merged)["counts"], {"s": 2, "imu": 1, "a": 3})
        done = self.furrow("bag", "filter", merged, "a.mcap", "--topics", "a")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.bag_info(self.folder / "a.mcap")["counts"], {"a": 3})
        done = self.furrow("bag", "compress", merged, "lz4.mcap", "--compression", "lz4")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.bag_info(self.folder / "lz4.mcap")["compression"], "lz4")
        done = self.furrow("bag", "export", merged, "--out", "tables")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.folder / "tables" / "imu.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 1)
        self.assertEqual(rows[0]["header.stamp.sec"], "2")
        self.assertEqual(rows[0]["names"], '["n"]')


class ToldTest(BagCase):
    def test_a_filter_that_matches_nothing_is_refused(self):
        recording = self.texts("a.mcap")
        for verb in ("cut", "filter", "convert"):
            self.assert_refused(["bag", verb, recording, "x.mcap", "--topics", "nosuch"],
                                "no topic matches", "chatter")
        self.assert_refused(["play", recording, "--topics", "nosuch"], "no topic")
        self.assert_refused(["bag", "export", recording, "--out", "x", "--topics", "nosuch"],
                            "no topic")
        self.assertFalse((self.folder / "x.mcap").exists())

    def test_a_misspelled_pattern_among_others_is_told(self):
        recording = self.texts("a.mcap")
        done = self.furrow("bag", "cut", recording, "x.mcap", "--topics", "chatter", "typo")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("typo", done.stderr)
        self.assertEqual(self.bag_info(self.folder / "x.mcap")["messages"], 5)

    def test_an_unfinished_file_is_told(self):
        recording = self.texts("a.mcap")
        recording.write_bytes(recording.read_bytes()[:-50])
        for arguments in (["play", recording, "--domain", domain(), "--wait", 0],
                          ["bag", "cut", recording, "x.mcap"], ["bag", "info", recording]):
            with self.subTest(arguments):
                done = self.furrow(*arguments)
                self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
                self.assertIn("end is missing", done.stdout + done.stderr)

    def test_messages_that_are_not_cdr_are_not_played(self):
        for encoding in ("json", "wrong_format"):
            recording = self.texts(f"{encoding}.mcap", encoding=encoding)
            self.assert_refused(["play", recording, "--domain", domain()], encoding)
        mixed = self.write_mcap("mixed.mcap", [
            TEXT_SCHEMA, text_channel(1, "/good"), text_channel(2, "/bad", "json"),
            text_message(1, 5), text_message(2, 5, b"{}")])
        done = self.furrow("play", mixed, "--domain", domain(), "--wait", 0)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("bad is not played", done.stderr)
        self.assertIn("1 messages", done.stdout)

    def test_a_loop_of_one_message_ends_at_signals(self):
        recording = self.texts("one.mcap", count=1)
        for ending in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(ending):
                player = self.start("play", recording, "--domain", domain(), "--loop", "--wait", 0)
                time.sleep(3.5)
                player.send_signal(ending)
                text = player.communicate(timeout=20)[0]
                self.assertEqual(player.returncode, 0, text)
                # Once a second, however busy the machine is.
                messages = int(text.split(" messages")[0].split()[-1])
                self.assertTrue(1 <= messages <= 6, text)


if __name__ == "__main__":
    unittest.main()
