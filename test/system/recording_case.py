"""What the tests of recordings share."""

import signal
import subprocess

from furrow_case import FurrowCase, domain, furrow_program

# A short row without images: 7 s of simulated time.
SHORT_RUN = ["--graph", "weeding_true_detections", "--seed", "5", "--length", "1"]
# As short, with few images: they cost most of the time.
SHORT_RUN_WITH_IMAGES = ["--length", "1", "--seed", "3", "--set", "camera.camera_rate_hz=2"]


class RecordingCase(FurrowCase):
    """Has a recording of a run in simulated time, made once."""

    recorded = None
    short_run = SHORT_RUN
    record_options = []

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        case = FurrowCase()
        case.setUp()
        cls.addClassCleanup(case.doCleanups)
        case.run_graph(*cls.short_run, "--record", case.folder / "run", *cls.record_options)
        cls.recorded = case.folder / "run_0.mcap"
        cls.first_out = case.out

    def assert_sound(self, file):
        done = self.furrow("bag", "verify", file)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("sound", done.stdout)

    def start(self, *arguments, **options):
        process = subprocess.Popen([furrow_program(), *map(str, arguments)], cwd=self.folder,
                                   stdin=options.pop("stdin", subprocess.DEVNULL),
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                   **options)

        def end():
            if process.poll() is None:
                process.kill()
            if not process.stdout.closed:
                process.communicate()
        self.addCleanup(end)
        return process

    def start_recorder(self, *arguments, **options):
        """A recorder that is in the domain."""
        process = self.start("record", "--domain", domain(), *arguments, **options)
        line = process.stdout.readline()
        self.assertIn("_N.mcap", line)
        return process

    def stop(self, process):
        process.send_signal(signal.SIGINT)
        text = process.communicate(timeout=30)[0]
        return process.returncode, text

    def play(self, *arguments):
        done = self.furrow("play", "--domain", domain(), *arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout
