"""Commands for recordings: record, play, inspect, repair, and the faults of each."""

import os
import re
import shutil
import signal
import subprocess
import time
import unittest

from furrow_case import FurrowCase, domain
from recording_case import SHORT_RUN, RecordingCase


class BagTest(RecordingCase):
    def test_info_tells_what_is_in_it(self):
        row = self.bag_info(self.recorded)
        self.assertEqual(row["profile"], "ros2")
        self.assertEqual(row["damage"], "")
        self.assertEqual(row["messages"], sum(row["counts"].values()))
        # What a viewer needs: the robot once, and how it moves.
        for topic in ("truth/field", "robot_description", "tf_static"):
            self.assertEqual(row["counts"][topic], 1, topic)
        for topic in ("tf", "joint_states"):
            self.assertGreater(row["counts"][topic], 100, topic)
        # 4 m at 0.5 m/s, and the odometry at 100 Hz.
        self.assertAlmostEqual(row["duration_s"], 8.0, delta=1.0)
        self.assertAlmostEqual(row["counts"]["wheel/odometry"], 100 * row["duration_s"], delta=2)
        types = {topic["topic"]: topic for topic in row["topics"]}
        self.assertEqual(types["wheel/odometry"]["type"], "nav_msgs/msg/Odometry")
        self.assertEqual(types["truth/field"]["qos"], "reliable, latched")

    def test_a_sound_file_is_called_sound(self):
        self.assert_sound(self.recorded)

    def test_a_changed_byte_is_found(self):
        file = self.folder / "changed.mcap"
        data = bytearray(self.recorded.read_bytes())
        data[len(data) // 2] ^= 0x10
        file.write_bytes(data)
        done = self.furrow("bag", "verify", file)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("changed.mcap: ", done.stdout)

    def test_a_truncated_file_is_recovered_up_to_its_last_whole_chunk(self):
        whole = self.bag_info(self.recorded)["messages"]
        file = self.folder / "cut short.mcap"
        data = self.recorded.read_bytes()
        # The last tenth of so short a file is its summary, without messages.
        for part in (0.75, 0.5):
            with self.subTest(part):
                file.write_bytes(data[:int(part * len(data))])
                self.assertEqual(self.furrow("bag", "info", file).returncode, 1)
                self.assertEqual(self.furrow("bag", "verify", file).returncode, 1)
                mended = self.folder / f"mended {part}.mcap"
                done = self.furrow("bag", "recover", file, mended)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assert_sound(mended)
                messages = self.bag_info(mended)["messages"]
                self.assertGreater(messages, 0.5 * part * whole)
                self.assertLess(messages, whole)

    def test_a_cut_has_its_range_its_topics_and_what_still_holds(self):
        file = self.folder / "part.mcap"
        done = self.furrow("bag", "cut", self.recorded, file, "--from", 2, "--to", 4, "--topics",
                           "wheel/*", "truth/field", "--compression", "lz4")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_sound(file)
        row = self.bag_info(file)
        self.assertEqual(row["counts"], {"wheel/odometry": 200, "truth/field": 1})
        self.assertEqual(row["compression"], "lz4")
        self.assertAlmostEqual(row["duration_s"], 1.99, delta=0.011)

    def test_bad_input_is_refused(self):
        garbage = self.folder / "garbage.mcap"
        garbage.write_bytes(os.urandom(4096))
        kept = self.folder / "kept.mcap"
        kept.write_text("mine")
        missing = self.folder / "missing.mcap"
        for arguments, part in (
                (["info", missing], "missing.mcap"),
                (["verify", missing], "missing.mcap"),
                (["recover", missing, self.folder / "x"], "missing.mcap"),
                (["info", garbage], "garbage.mcap"),
                (["cut", garbage, self.folder / "x"], "garbage.mcap"),
                (["recover", garbage, self.folder / "x"], "garbage.mcap"),
                (["cut", self.recorded, kept], "kept.mcap"),
                (["cut", self.recorded, self.folder / "x", "--from", "100"], "s long"),
                (["cut", self.recorded, self.folder / "x", "--from", "3", "--to", "2"], "--to"),
                (["cut", self.recorded, self.folder / "x", "--compression", "zip"], "zip"),
                (["squash", self.recorded], "")):
            with self.subTest(arguments):
                self.assert_refused(["bag", *arguments], part)
                self.assertFalse((self.folder / "x").exists())
        self.assertEqual(kept.read_text(), "mine")
        self.assertEqual(self.furrow("bag", "verify", garbage).returncode, 1)


class FromRecordingTest(RecordingCase):
    def test_the_ledger_is_that_of_the_run_itself(self):
        common = [*SHORT_RUN[:4], "--recording", self.recorded]
        for name, more in (("replayed", []), ("one thread", ["--threads", 1])):
            self.run_graph(*common, *more, out=self.folder / name)
            for file in ("ledger.csv", "map.svg"):
                self.assertEqual((self.folder / name / file).read_bytes(),
                                 (self.first_out / file).read_bytes(), file)

    def test_another_planner_gives_another_ledger(self):
        self.run_graph(*SHORT_RUN[:4], "--recording", self.recorded, "--set",
                       "planner.protection_zone_mm=60")
        self.assertNotEqual((self.out / "ledger.csv").read_bytes(),
                            (self.first_out / "ledger.csv").read_bytes())

    def test_only_sensors_give_a_run_from_a_part(self):
        file = self.folder / "sensors.mcap"
        done = self.furrow("bag", "cut", self.recorded, file, "--from", 2, "--exclude",
                           "run/*", "truth/field", "truth/odometry", "truth/spray")
        self.assertEqual(done.returncode, 0, done.stderr)
        # What is not known is not in the ledger; the run itself goes to its end.
        done = self.furrow("run", "--no-dds", "--clock", "lockstep", "--graph",
                           "weeding_true_detections", "--recording", file, "--out", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_gap_makes_the_tool_safe_and_the_user_is_told(self):
        parts = [self.folder / "before.mcap", self.folder / "after.mcap"]
        for file, *options in ((parts[0], "--to", 4), (parts[1], "--from", 4.3, "--no-latched")):
            done = self.furrow("bag", "cut", self.recorded, file, *options)
            self.assertEqual(done.returncode, 0, done.stderr)
        done = self.furrow("run", "--no-dds", "--clock", "lockstep", *SHORT_RUN[:4], "--recording",
                           *parts, "--out", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        told = re.findall(r"^  (driver_axis_\d): error: odometry_stale", done.stdout, re.MULTILINE)
        self.assertEqual(told, [f"driver_axis_{i}" for i in range(1, 5)], done.stdout)

    def test_bad_input_is_refused(self):
        graph = ["run", "--no-dds", "--clock", "lockstep", *SHORT_RUN[:4], "--out", self.out]
        garbage = self.folder / "garbage.mcap"
        garbage.write_bytes(b"\x89MCAP0\r\n" + os.urandom(1000))
        for more, part in (
                (["--recording", self.folder / "missing.mcap"], "missing.mcap"),
                (["--recording", garbage], "--recording"),
                (["--recording", self.recorded, "--set", "playback.start_s=1000"], "outside"),
                (["--recording", self.recorded, "--set", "playback.exclude=[truth/instances]"],
                 "truth/instances"),
                (["--recording", self.recorded, "--set", "playback.remap=[nonsense]"], "nonsense"),
                (["--record", self.folder / "x", "--set", "recorder.compression=zip"], "zip"),
                (["--record", self.recorded.with_name("run")], "exists")):
            with self.subTest(more):
                self.assert_refused([*graph, *more], part)
        # The default detector needs images, which this recording has not.
        self.assert_refused(["run", "--no-dds", "--clock", "lockstep", "--recording",
                             self.recorded, "--out", self.out], "camera/", "perception needs")


class FromImagesTest(FurrowCase):
    def test_images_go_through_detector_tracker_and_planner(self):
        run = ["--seed", 3, "--length", 1, "--set", "camera.camera_rate_hz=2"]
        summary = self.run_graph(*run, "--record", "images", "--set",
                                 "recorder.exclude=[perception/*, tracker/*, planner/*, axis/*]")
        counts = self.bag_info(self.folder / "images_0.mcap")["counts"]
        self.assertGreater(counts["camera/image"], 10)
        self.assertNotIn("planner/plan", counts)
        again = self.run_graph("--seed", 3, "--recording", "images_0.mcap",
                               out=self.folder / "again")
        self.assertEqual((self.folder / "again" / "ledger.csv").read_bytes(),
                         (self.out / "ledger.csv").read_bytes())
        self.assertGreater(again["treated_accurate"], 0)
        self.assertEqual(again["weeds_total"], summary["weeds_total"])


class WireTest(RecordingCase):
    def test_what_is_played_is_recorded(self):
        recorder = self.start_recorder("--out", "again", "--schema", "omgidl", "--compression",
                                       "lz4", "--min-free-mb", "0")
        text = self.play(self.recorded, "--rate", 5, "--wait", 5, "--exclude", "diagnostics")
        self.assertIn(" 0 lost", text)
        time.sleep(0.3)
        code, text = self.stop(recorder)
        self.assertEqual(code, 0, text)
        file = self.folder / "again_0.mcap"
        self.assert_sound(file)
        expected = self.bag_info(self.recorded)["counts"]
        expected.pop("diagnostics", None)
        row = self.bag_info(file)
        self.assertEqual(row["counts"], expected)
        self.assertEqual({topic["schema"] for topic in row["topics"]}, {"omgidl"})
        # And it gives the same ledger as what it was played from, but for the times of arrival.
        # Five times as fast, or slower where the machine is busy.
        duration_s = self.bag_info(self.recorded)["duration_s"]
        self.assertGreater(row["duration_s"], duration_s / 5 - 0.2)
        self.assertLess(row["duration_s"], duration_s)

    def test_include_exclude_split_and_remap(self):
        recorder = self.start_recorder("wheel/*", "moved/*", "imu/data", "--exclude", "imu/*",
                                       "--split-s", "1", "--out", "some", "--min-free-mb", "0")
        self.play(self.recorded, "--rate", 2, "--start", 1, "--duration", 5, "--wait", 5,
                  "--remap", "axis/state=moved/state")
        time.sleep(0.3)
        code, text = self.stop(recorder)
        self.assertEqual(code, 0, text)
        files = sorted(self.folder.glob("some_*.mcap"))
        self.assertEqual(len(files), 3)
        rows = [self.bag_info(file) for file in files]
        for row in rows:
            self.assertLess(row["duration_s"], 1.05)
            self.assertEqual(set(row["counts"]), {"wheel/odometry", "moved/state"})
        self.assertEqual(sum(row["counts"]["wheel/odometry"] for row in rows), 500)

    def test_pause_and_resume_of_the_recorder(self):
        recorder = self.start_recorder("wheel/odometry", "--out", "parts", "--min-free-mb", "0",
                                       stdin=subprocess.PIPE)
        self.play(self.recorded, "--rate", 10, "--duration", 2, "--wait", 5)
        for verb in ("pause", "resume"):
            recorder.stdin.write(verb + "\n")
            recorder.stdin.flush()
            self.play(self.recorded, "--rate", 10, "--duration", 2, "--wait", 5)
        recorder.stdin.write("quit\n")
        recorder.stdin.flush()
        text = recorder.communicate(timeout=30)[0]
        self.assertEqual(recorder.returncode, 0, text)
        self.assertIn("199 let go while paused", text)
        self.assertEqual(self.bag_info(self.folder / "parts_0.mcap")["counts"],
                         {"wheel/odometry": 398})

    def test_a_pre_trigger_window_keeps_what_was_before(self):
        recorder = self.start_recorder("wheel/odometry", "--out", "box", "--pre-trigger-s", "0.5",
                                       "--min-free-mb", "0", stdin=subprocess.PIPE)
        said = self.play(self.recorded, "--rate", 2, "--duration", 4, "--wait", 5,
                         "--topics", "wheel/odometry")
        played = int(re.search(r"(\d+) messages", said).group(1))
        self.assertEqual(list(self.folder.glob("box*")), [])
        recorder.stdin.write("trigger\nquit\n")
        recorder.stdin.flush()
        text = recorder.communicate(timeout=30)[0]
        self.assertEqual(recorder.returncode, 0, text)
        row = self.bag_info(self.folder / "box_0.mcap")
        self.assertLessEqual(row["duration_s"], 0.5)
        self.assertGreater(row["messages"], 50)
        # How many fit in depends on how evenly they came; those that did not were told of.
        older = int(re.search(r"(\d+) older than the window", text).group(1))
        self.assertGreater(older, 50)
        self.assertEqual(row["messages"] + older, played)

    def test_the_player_obeys_the_keyboard(self):
        recorder = self.start_recorder("wheel/odometry", "--out", "steps", "--min-free-mb", "0")
        player = self.start("play", self.recorded, "--domain", domain(), "--pause", "--topics",
                            "wheel/odometry", "--wait", "5", stdin=subprocess.PIPE)

        def say(line):
            player.stdin.write(line + "\n")
            player.stdin.flush()
            return player.stdout.readline()
        answer = say("step 5")
        deadline = time.monotonic() + 20
        while " 5 messages" not in answer:
            self.assertLess(time.monotonic(), deadline, answer)
            time.sleep(0.05)
            answer = say("pause")
        for line, expected in (("seek 3", "paused at 3.0"), ("rate 0", "furrow: "),
                               ("dance", "unknown 'dance'"), ("rate 20", "paused at"),
                               ("resume", "playing")):
            self.assertIn(expected, say(line))
        text = player.communicate(timeout=30)[0]
        self.assertEqual(player.returncode, 0, text)
        time.sleep(0.3)
        code, text = self.stop(recorder)
        self.assertEqual(code, 0, text)
        total = self.bag_info(self.recorded)["counts"]["wheel/odometry"]
        counted = self.bag_info(self.folder / "steps_0.mcap")["counts"]["wheel/odometry"]
        # Five from the beginning, then all from 3 s on.
        self.assertEqual(counted, 5 + total - 299)

    def test_latched_topics_and_the_clock_reach_late_joiners(self):
        player = self.start("play", self.recorded, "--domain", domain(), "--start", "3", "--loop",
                            "--clock", "100", "--wait", "0")
        for topic, part in (("truth/field", "plants:"), ("clock", "sec:")):
            done = self.furrow("topic", "echo", topic, "--domain", domain(), "--count", 1,
                               "--wait", 20)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(part, done.stdout)
        code, text = self.stop(player)
        self.assertEqual(code, 0, text)

    def test_bad_input_is_refused(self):
        garbage = self.folder / "garbage.mcap"
        garbage.write_bytes(os.urandom(4096))
        play = ["play", self.recorded, "--domain", domain()]
        record = ["record", "--domain", domain(), "--out", self.folder / "x"]
        for arguments, part in (
                (["play", self.folder / "missing.mcap"], "missing.mcap"),
                (["play", garbage], ""),
                ([*play, "--rate", "0"], "--rate"),
                ([*play, "--start", "500"], "outside"),
                ([*play, "--remap", "nonsense"], "nonsense"),
                ([*play, "--topics", "no/such"], "no topic"),
                ([*play, "--domain", "900"], "--domain"),
                ([*record, "--split-mb", "-1"], "--split-mb"),
                ([*record, "--compression", "zip"], "zip"),
                ([*record, "--dds", "lease=1"], "lease"),
                ([*record, "--min-free-mb", "1000000"], "MB left"),
                (["record", "--out", self.recorded.with_name("run")], "exists"),
                (["record", "--out", "/proc/no/such"], "/proc/no")):
            with self.subTest(arguments):
                self.assert_refused(arguments, part)
        self.assertEqual(list(self.folder.glob("x*")), [])


class FaultTest(RecordingCase):
    def test_a_killed_recorder_leaves_what_it_had_written(self):
        recorder = self.start_recorder("--out", "killed", "--flush-s", "0.2", "--min-free-mb", "0")
        player = self.start("play", self.recorded, "--domain", domain(), "--loop", "--rate", "2",
                            "--wait", "5")
        time.sleep(4.0)
        recorder.send_signal(signal.SIGKILL)
        recorder.communicate()
        self.stop(player)
        file = self.folder / "killed_0.mcap"
        self.assertEqual(self.furrow("bag", "info", file).returncode, 1)
        mended = self.folder / "mended.mcap"
        done = self.furrow("bag", "recover", file, mended)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_sound(mended)
        self.assertGreater(self.bag_info(mended)["counts"]["wheel/odometry"], 200)

    def small_disk(self, megabytes):
        disk = self.folder / "disk"
        disk.mkdir()
        if os.geteuid() != 0 or shutil.which("mount") is None:
            self.skipTest("needs root, to mount a small file system")
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={megabytes}m", "tmpfs",
                                  disk], capture_output=True, text=True, check=False)
        if mounted.returncode != 0:
            self.skipTest("may not mount a file system: " + mounted.stderr)
        self.addCleanup(subprocess.run, ["umount", disk], check=False)
        return disk

    def test_a_full_disk_stops_the_recording_in_good_order(self):
        disk = self.small_disk(8)
        for margin, left_mb in ((0, 0.0), (3, 1.5)):
            with self.subTest(margin):
                out = disk / "full"
                recorder = self.start_recorder("--out", out, "--compression", "none",
                                               "--min-free-mb", margin, "--chunk-kb", "256")
                player = self.start("play", self.recorded, "--domain", domain(), "--loop",
                                    "--rate", "20", "--wait", "5")
                text = recorder.communicate(timeout=60)[0]
                self.assertEqual(recorder.returncode, 1, text)
                self.assertRegex(text, "MB left|[Nn]o space")
                self.stop(player)
                space = os.statvfs(disk)
                self.assertGreaterEqual(space.f_bavail * space.f_bsize, left_mb * 1e6)
                file = disk / "full_0.mcap"
                mended = self.folder / f"mended {margin}.mcap"
                if self.furrow("bag", "verify", file).returncode != 0:
                    # There was no room even for the summary: all the chunks are there.
                    self.assertEqual(margin, 0)
                done = self.furrow("bag", "recover", file, mended)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertGreater(self.bag_info(mended)["messages"], 1000)
                file.unlink()

    def test_a_run_goes_on_when_its_recorder_has_no_disk(self):
        disk = self.small_disk(2)
        self.run_graph(*SHORT_RUN, "--record", disk / "run", "--set",
                       "recorder.min_free_mb=0", "--set", "recorder.compression=none")
        self.assertEqual((self.out / "ledger.csv").read_bytes(),
                         (self.first_out / "ledger.csv").read_bytes())


if __name__ == "__main__":
    unittest.main()
