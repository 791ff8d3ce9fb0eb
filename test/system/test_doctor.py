"""`furrow doctor` beside a process that publishes the sensors of a robot, sound or with a fault."""

import json
import subprocess
import unittest

from furrow_case import FurrowCase, domain, furrow_program

INPUTS = ["camera/image", "camera/camera_info", "camera/depth", "wheel/odometry", "imu/data",
          "gnss/fix"]
# What the peer does wrong: the finding that comes first, and its topic.
FAULTS = {
    "name": ("topic.no_writer", "camera/image"),
    "type": ("topic.type", "camera/image"),
    "silent": ("topic.silent", "camera/depth"),
    "two_writers": ("topic.two_writers", "wheel/odometry"),
    "future": ("stamp.future", "camera/image"),
    "epoch": ("stamp.other_clock", "imu/data"),
    "encoding": ("image.encoding", "camera/image"),
    "size": ("image.size", "camera/image"),
    "depth_unit": ("depth.distance", "camera/depth"),
    "imu_degrees": ("imu.rate_unit", "imu/data"),
    "imu_sign": ("imu.turn_sign", "imu/data"),
    "utm": ("wheels.coordinates", "wheel/odometry"),
    "km_per_h": ("wheels.speed_unit", "wheel/odometry"),
    "no_fix": ("gnss.no_fix", "gnss/fix"),
}


def peer_program():
    program = furrow_program()
    for prefix in (program.parents[2] / "furrow_diagnosis", program.parents[1]):
        path = prefix / "lib" / "furrow_diagnosis" / "doctor_peer"
        if path.exists():
            return path
    raise FileNotFoundError("no doctor_peer: build furrow_diagnosis with BUILD_TESTING")


class Doctor(FurrowCase):
    def look(self, *arguments):
        """Exit code, standard output and the JSON report of a look at the domain."""
        file = self.folder / "doctor.json"
        done = self.furrow("doctor", "--seconds", 3, "--domain", domain(), "--json", file,
                           "--force", *arguments)
        self.assertIn(done.returncode, (0, 1), done.stdout + done.stderr)
        return done.returncode, done.stdout, json.loads(file.read_text())

    def beside(self, fault, *arguments):
        peer = subprocess.Popen([peer_program(), str(domain()), fault], stdin=subprocess.PIPE)
        try:
            return self.look(*arguments)
        finally:
            peer.stdin.close()
            self.assertEqual(peer.wait(30), 0)

    def test_sound_sensors_give_no_finding(self):
        code, text, report = self.beside("none")
        self.assertEqual(report["findings"], [], text)
        self.assertEqual(code, 0)
        self.assertIn("sound: 6 inputs", text)
        self.assertEqual([row["topic"] for row in report["inputs"]], INPUTS)
        imu = report["inputs"][4]
        self.assertGreater(imu["rate_hz"], 30)
        self.assertLess(imu["delay_s"], 0.2)

    def test_each_fault_is_named_first(self):
        for fault, (check, topic) in FAULTS.items():
            with self.subTest(fault):
                code, text, report = self.beside(fault)
                self.assertEqual(code, 1, text)
                first = report["findings"][0]
                self.assertEqual((first["check"], first["topic"]), (check, topic), text)
                self.assertIn(f"1. {topic}: ", text)

    def test_the_topic_of_a_driver_with_the_same_type_is_offered(self):
        _, text, _ = self.beside("name")
        self.assertIn("or remap it to 'camera/color/image_raw', which has this type", text)

    def test_a_domain_without_drivers_gives_a_finding_for_each_input(self):
        code, _, report = self.look()
        self.assertEqual(code, 1)
        self.assertEqual([row["check"] for row in report["findings"]], ["topic.no_writer"] * 6)
        self.assertEqual([row["topic"] for row in report["findings"]], INPUTS)

    def test_depth_that_perception_does_not_use_is_not_missed(self):
        _, _, report = self.look("--set", "perception.use_depth=false")
        self.assertNotIn("camera/depth", [row["topic"] for row in report["inputs"]])

    def test_a_graph_without_sensors_is_no_finding_but_an_error(self):
        self.assert_refused(["doctor", "--graph", "weeding"], "reads no sensor", "observe")
        self.assert_refused(["doctor", "--graph", "no_such_graph"], "no_such_graph")


if __name__ == "__main__":
    unittest.main()
