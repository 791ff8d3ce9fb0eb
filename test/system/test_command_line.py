"""The surface of the command: where results go, what it prints, what it refuses."""

import os
import subprocess
import unittest
import zlib

from furrow_case import FurrowCase, domain, furrow_program


def png(path, width=64, height=48, shade=40):
    """A small image: green plants on brown soil."""
    rows = b""
    for v in range(height):
        rows += b"\0"
        for u in range(width):
            plant = (u - width / 2) ** 2 + (v - height / 2) ** 2 < (height / 4) ** 2
            rows += bytes((40, 160, 40) if plant else (90, 60, shade))

    def chunk(kind, data):
        return (len(data).to_bytes(4, "big") + kind + data +
                zlib.crc32(kind + data).to_bytes(4, "big"))
    header = width.to_bytes(4, "big") + height.to_bytes(4, "big") + b"\x08\x02\0\0\0"
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class ResultsTest(FurrowCase):
    def test_detect_never_writes_over_an_image(self):
        images = [self.folder / "plant.png", self.folder / "plant-2.png"]
        for shade, image in enumerate(images):
            png(image, shade=40 + shade)
        before = [image.read_bytes() for image in images]
        for options in ((), ("--force",)):
            done = self.furrow("detect", "plant.png", "plant-2.png", "--out", ".", *options)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual([image.read_bytes() for image in images], before)
            self.assertTrue((self.folder / "detections.json").is_file())
            self.assertTrue((self.folder / "plant-3.png").is_file())

    def test_earlier_detections_are_kept(self):
        png(self.folder / "plant.png")
        for name in ("out", "out-2"):
            done = self.furrow("detect", "plant.png", "--out", "out")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"{name}/detections.json", done.stdout)

    def test_result_files_are_numbered(self):
        field = ("field", "generate", "--length", 1, "--out", "field.csv")
        for name in ("field.csv", "field-2.csv"):
            done = self.furrow(*field)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"{name}: ", done.stdout)
            self.assertTrue((self.folder / name).is_file())
        done = self.furrow(*field, "--force")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertFalse((self.folder / "field-3.csv").exists())

    def test_what_cannot_be_written_is_found_before_the_work(self):
        (self.folder / "file").write_text("kept")
        bad = self.folder / "file" / "below"
        for arguments in (["run", "--no-dds", "--length", "1000", "--out", bad],
                          ["eval", "observation", "--json", bad],
                          ["eval", "trial", "--out", bad],
                          ["eval", "tracking", "--html", bad],
                          ["calibrate", "--out", bad],
                          ["bench", "planner", "--json", bad],
                          ["graph", "show", "--svg", bad]):
            with self.subTest(arguments):
                done = self.furrow(*arguments, timeout=20)
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                self.assertIn("file", done.stderr)

    def test_output_that_cannot_be_written_is_an_error(self):
        recorded = self.folder / "r"
        self.run_graph("--graph", "weeding_true_detections", "--length", 1, "--record", recorded)
        for arguments in (["bag", "info", f"{recorded}_0.mcap"], ["--help"], ["graph", "topics"],
                          ["params", "describe"], ["field", "show"]):
            with self.subTest(arguments), open("/dev/full", "w", encoding="ascii") as full:
                done = subprocess.run([furrow_program(), *arguments], stdin=subprocess.DEVNULL,
                                      stdout=full, stderr=subprocess.PIPE, text=True, timeout=60,
                                      check=False)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertIn("cannot write to standard output: No space left", done.stderr)


class RefusalTest(FurrowCase):
    def test_values_out_of_range(self):
        png(self.folder / "plant.png")
        for arguments, part in (
                (["detect", "plant.png", "--resolution", 0], "--resolution: 0 is out of range"),
                (["topic", "hz", "x", "--window", -1], "--window: -1 is out of range"),
                (["topic", "hz", "x", "--window", 0], "--window: 0 is out of range"),
                (["topic", "bw", "x", "--count", -1], "--count: -1 is out of range"),
                (["topic", "echo", "x", "--domain", 233], "--domain: 233 is out of range")):
            with self.subTest(arguments):
                self.assert_refused(arguments, part)
                self.assertLess(len(self.furrow(*arguments).stderr), 300)

    def test_former_names_still_work(self):
        for name in ("--no-wire", "--no-dds"):
            self.assert_refused(["run", name, "--deploy", "distributed", "--process", "robot"],
                                "--no-dds needs a single-process deployment")
        self.assert_refused(["run", "--wire", "domain_id=900"], "domain_id: 900")


class TopicTest(FurrowCase):
    """Tools beside a run in real time."""

    def setUp(self):
        super().setUp()
        run = subprocess.Popen(
            [furrow_program(), "run", "--graph", "weeding_true_detections", "--length", "50",
             "--domain", str(domain()), "--out", self.out],
            cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True)

        def end():
            run.kill()
            run.communicate()
        self.addCleanup(end)
        self.assertIn("weeding", run.stderr.readline())

    def topic(self, *arguments, environment=None):
        return subprocess.run([furrow_program(), "topic", *map(str, arguments)],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60,
                              check=False, env={**os.environ, **(environment or {})})

    def test_topics_are_found_by_the_names_of_ros_2_too(self):
        for name in ("wheel/odometry", "/wheel/odometry"):
            done = self.topic("echo", name, "--domain", domain(), "--count", 1)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("pose:", done.stdout)

    def test_the_domain_of_ros_2_is_the_default(self):
        ros = {"ROS_DOMAIN_ID": str(domain())}
        done = self.topic("echo", "wheel/odometry", "--count", 1, environment=ros)
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.topic("list", environment=ros)
        self.assertIn("wheel/odometry", done.stdout)
        done = self.topic("list", environment={"ROS_DOMAIN_ID": "many"})
        self.assertEqual(done.returncode, 2)
        self.assertIn("ROS_DOMAIN_ID: 'many'", done.stderr)

    def test_a_count_of_messages_gives_as_many_lines(self):
        for verb in ("hz", "bw"):
            done = self.topic(verb, "wheel/odometry", "--domain", domain(), "--count", 30)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(len(done.stdout.splitlines()), 30, done.stdout)
        # The last lines know a rate.
        self.assertRegex(done.stdout.splitlines()[-1], r"^[0-9.]+ MB/s")

    def test_a_window_shorter_than_the_period_is_refused(self):
        done = self.topic("hz", "tracker/tracks", "--domain", domain(), "--window", 0.001)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertRegex(done.stderr, r"--window: 0\.001 s .*its period is 0\.\d+ s")

    def test_output_that_cannot_be_written_ends_an_echo(self):
        with open("/dev/full", "w", encoding="ascii") as full:
            done = subprocess.run([furrow_program(), "topic", "echo", "wheel/odometry", "--domain",
                                   str(domain())], stdin=subprocess.DEVNULL, stdout=full,
                                  stderr=subprocess.PIPE, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 1, done.stderr)


if __name__ == "__main__":
    unittest.main()
