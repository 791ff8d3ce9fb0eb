"""The log of a run: console, run.log, rosout, levels, causes of the safe state, texts of libraries, and
that simulated time gives the same lines."""

import os
import re
import signal
import subprocess
import time
import unittest

from furrow_case import FurrowCase, domain, furrow_program

# Without rendering: most lines do not depend on images.
SHORT = ("--graph", "weeding_true_detections", "--length", "0.5", "--seed", "3")
# Rendered, but two images only.
RENDERED = ("--length", "0.5", "--seed", "3", "--set", "camera.camera_rate_hz=0.2")
LONG = ("--graph", "weeding_true_detections", "--length", "20")
# Slower than the deadline of the axis drivers: the tools enter their safe state.
SLOW_HEARTBEAT = ("--set", "planner.heartbeat_rate_hz=10")
LINE = re.compile(r" *\d+\.\d{3} s (DEBUG|INFO |WARN |ERROR|FATAL) ([\w.-]+): \S.*")


class Log(FurrowCase):
    def log(self, out=None):
        return (out or self.out).joinpath("run.log").read_text()

    def test_every_line_has_time_level_component_and_text(self):
        self.run_graph(*SHORT, *SLOW_HEARTBEAT, "--log-level", "debug")
        lines = self.log().splitlines()
        self.assertGreater(len(lines), 2)
        for line in lines:
            self.assertRegex(line, LINE)
        self.assertIn("furrow: run of graph 'weeding_true_detections' starts, seed 3",
                      self.log())

    def test_simulated_time_gives_the_same_lines_on_any_number_of_threads(self):
        logs = []
        for threads in (1, 3):
            out = self.folder / f"threads{threads}"
            self.run_graph(*SHORT, *SLOW_HEARTBEAT, "--log-level", "debug", "--threads", threads,
                           out=out)
            logs.append(self.log(out))
        self.assertIn("ERROR driver_axis_1", logs[0])
        self.assertEqual(logs[0], logs[1])

    def test_the_console_has_the_lines_of_the_file(self):
        done = self.furrow("run", "--no-dds", "--clock", "lockstep", "--out", self.out, *SHORT,
                           *SLOW_HEARTBEAT)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(len(self.log().splitlines()), 2)
        for line in self.log().splitlines():
            self.assertIn(line, done.stderr)

    def test_levels_are_set_for_all_and_for_one_component(self):
        self.run_graph(*SHORT, *SLOW_HEARTBEAT, "--log-level", "fatal")
        self.assertEqual(self.log(), "")
        one = self.folder / "one"
        self.run_graph(*SHORT, *SLOW_HEARTBEAT, "--log-level", "fatal", "--log-level",
                       "furrow=info", out=one)
        components = {LINE.fullmatch(line)[2] for line in self.log(one).splitlines()}
        self.assertEqual(components, {"furrow"})

    def test_a_malformed_level_is_refused(self):
        for level in ("loud", "planner=", "=warn"):
            self.assert_refused(["run", "--out", self.out, "--log-level", level], "--log-level",
                                "COMPONENT=LEVEL")

    def test_a_level_of_an_unknown_component_is_refused(self):
        for command in ("run", "up"):
            self.assert_refused([command, "--out", self.out, "--log-level", "plnner=debug"],
                                "plnner", "did you mean 'planner'?")

    def test_the_end_of_a_run_is_its_last_line(self):
        self.run_graph(*SHORT)
        self.assertIn("the run is finished", self.log().splitlines()[-1])

    def test_a_run_that_does_not_start_leaves_no_log(self):
        self.assert_refused(["run", "--no-dds", "--out", self.out,
                             "--set", "planner.tool_file=nothing.urdf"], "nothing.urdf")
        self.assertFalse((self.out / "run.log").exists())

    def test_a_folder_that_cannot_be_written_is_refused_before_the_run(self):
        self.assert_refused(["run", "--no-dds", "--out", "/proc/nothing/here"], "--out")

    def test_a_warning_is_written_once_and_its_repetitions_are_counted(self):
        field = self.folder / "beside_the_images.csv"
        field.write_text("# length_m: 0.5\nkind,x_m,y_m\nweed,0.25,5.0\n")
        self.run_graph(*SHORT, "--field", field, "--set", "tracker.max_empty_views=2")
        lines = [line for line in self.log().splitlines() if " tracker: " in line]
        self.assertRegex(lines[0], r"WARN  tracker: no plant in 2 images in a row; nothing is "
                                   r"tracked$")
        self.assertRegex(lines[-1], r"WARN  tracker: \d+ more lines of: no plant in \d+ images")
        self.assertLess(len(lines), 5, lines)
        told = [int(re.search(r"(\d+) more ", line)[1]) for line in lines[1:]]
        written = sum("of: no plant" not in line for line in lines)
        # Each image without a plant, from the second on, is one line or one of those counted.
        images = int(re.search(r"in (\d+) images", lines[-1])[1])
        self.assertEqual(written + sum(told), images - 1, lines)

    def test_causes_of_the_safe_state_and_changes_of_health_are_lines(self):
        self.furrow("run", "--no-dds", "--clock", "lockstep", "--out", self.out, *SHORT,
                    *SLOW_HEARTBEAT)
        log = self.log()
        self.assertRegex(log, r"ERROR driver_axis_1: safe state entered: peer_lost\n")
        self.assertRegex(log, r"ERROR driver_axis_1: peer_lost at [\d.]+ s; the axis stopped and the valve "
                              r"is shut until tool/reset\n")

    def test_the_same_seed_gives_the_same_recording_with_the_log_as_rosout(self):
        days = []
        for name in ("one", "two"):
            self.furrow("run", "--no-dds", "--clock", "lockstep", *RENDERED, *SLOW_HEARTBEAT,
                        "--out", self.folder / name, "--record", self.folder / f"{name}_day")
            file = self.folder / f"{name}_day_0.mcap"
            counts = self.bag_info(file)["counts"]
            self.assertGreater(counts.get("rosout", 0), 0)
            self.assertGreater(counts.get("camera/image", 0), 1)
            (self.folder / "info.json").unlink()
            days.append(file.read_bytes())
        self.assertEqual(days[0], days[1])

    def run_with(self, environment, *arguments):
        """A run on the DDS domain of the test, with the texts of libraries."""
        saved = dict(os.environ)
        self.addCleanup(lambda: (os.environ.clear(), os.environ.update(saved)))
        os.environ.update(environment)
        done = self.furrow("run", "--clock", "lockstep", "--domain", domain(), "--out", self.out,
                           *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        for line in done.stderr.splitlines():
            if "opencv" in line or "fastdds" in line:
                self.assertRegex(line, LINE)
        return self.log()

    def test_texts_of_opencv_are_lines(self):
        log = self.run_with({"OPENCV_LOG_LEVEL": "DEBUG"}, *RENDERED, "--log-level",
                            "opencv=debug")
        self.assertRegex(log, r"s (DEBUG|INFO ) opencv: \S")

    def test_texts_of_fast_dds_are_lines(self):
        profile = self.folder / "profile.xml"
        profile.write_text("<dds><no_such_element/></dds>")
        log = self.run_with({"FASTRTPS_DEFAULT_PROFILES_FILE": str(profile)}, *SHORT)
        self.assertRegex(log, r"s ERROR fastdds: \S")

    def start(self, *arguments):
        """A run in real time, which the test interrupts as soon as it has seen what it waits for."""
        run = subprocess.Popen(
            [furrow_program(), *map(str, arguments), "--out", str(self.out), *LONG,
             *SLOW_HEARTBEAT],
            cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        self.addCleanup(run.wait, 60)
        self.addCleanup(run.send_signal, signal.SIGINT)
        return run

    def test_an_external_reader_gets_the_log_on_rosout(self):
        number = domain()
        self.start("run", "--clock", "real", "--domain", number)
        done = self.furrow("topic", "echo", "rosout", "--domain", number, "--count", "1", "--wait",
                           "60")
        self.assertIn("msg:", done.stdout, done.stderr)

    def test_each_process_and_the_supervisor_have_a_log(self):
        run = self.start("up", "--domain", domain())
        self.wait_for_line(run, "run_driver_axis_1.log",
                           "ERROR driver_axis_1: safe state entered: peer_lost")
        self.wait_for_line(run, "run_supervisor.log", " supervisor: driver_axis_1: ")
        self.assertGreater(len(list(self.out.glob("run*.log"))), 2)

    def wait_for_line(self, run, name, part):
        file = self.out / name
        while not (file.exists() and part in file.read_text()):
            self.assertIsNone(run.poll(), f"the run ended without {part!r} in {name}")
            time.sleep(0.05)


if __name__ == "__main__":
    unittest.main()
