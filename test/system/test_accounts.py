"""What the ledger says of runs with and without ground truth, and of where the field lies."""

import json
import struct
import unittest

from furrow_case import FurrowCase
from recording_case import SHORT_RUN_WITH_IMAGES, RecordingCase

SENSORS = ("camera/image", "camera/depth", "camera/camera_info", "wheel/odometry", "imu/data",
           "gnss/fix", "robot_description", "tf_static")


def records(data, start, end):
    """The records of a part of an MCAP file: (opcode, start, end) of their content."""
    while start + 9 <= end:
        opcode, length = data[start], struct.unpack_from("<Q", data, start + 1)[0]
        yield opcode, start + 9, start + 9 + length
        start += 9 + length


def text(data, at):
    length = struct.unpack_from("<I", data, at)[0]
    return data[at + 4:at + 4 + length].decode(), at + 4 + length


def move_wheels(path, x_m, y_m):
    """Moves the poses of wheel/odometry in a recording without compression."""
    data = bytearray(path.read_bytes())
    wheels = set()
    moved = 0

    def visit(opcode, start, end):
        nonlocal moved
        if opcode == 4:  # channel
            topic, _ = text(data, start + 4)
            if topic == "/wheel/odometry":
                wheels.add(struct.unpack_from("<H", data, start)[0])
        elif opcode == 5 and struct.unpack_from("<H", data, start)[0] in wheels:  # message
            body = start + 22 + 4  # behind the encapsulation
            at = body + 8
            for _ in range(2):  # frame_id, child_frame_id
                at = body + (at - body + 3) // 4 * 4
                at += 4 + struct.unpack_from("<I", data, at)[0]
            at = body + (at - body + 7) // 8 * 8
            x, y = struct.unpack_from("<dd", data, at)
            struct.pack_into("<dd", data, at, x + x_m, y + y_m)
            moved += 1

    for opcode, start, end in records(data, 8, len(data) - 8):
        visit(opcode, start, end)
        if opcode == 6:  # chunk: times, size, CRC, compression, records
            compression, at = text(data, start + 28)
            assert compression == "", compression
            struct.pack_into("<I", data, start + 24, 0)  # no CRC
            for inner in records(data, at + 8, end):
                visit(*inner)
        elif opcode == 15:  # data end
            struct.pack_into("<I", data, start, 0)
    path.write_bytes(data)
    return moved


class Decisions(FurrowCase):
    def test_the_decision_of_a_treated_weed_is_the_one_that_led_to_its_spray(self):
        summary = self.run_graph("--graph", "weeding_true_detections", "--length", "4", "--seed",
                                 "3")
        treated = [row for row in self.ledger() if row["outcome"] in ("accurate", "partial")]
        self.assertGreater(len(treated), 20)
        self.assertEqual(len(treated), summary["treated_accurate"] + summary["treated_partial"])
        # A spray for a neighbour may take a weed that was left, or that was not seen yet.
        decided = [row["decision"] for row in treated]
        self.assertGreater(decided.count("treat"), 0.9 * len(treated), decided)


class WithoutGroundTruth(RecordingCase):
    short_run = SHORT_RUN_WITH_IMAGES

    def part(self, *topics):
        part = self.folder / "sensors.mcap"
        done = self.furrow("bag", "cut", self.recorded, part, "--compression", "none", "--topics",
                           *topics)
        self.assertEqual(done.returncode, 0, done.stderr)
        return part

    def test_every_track_has_a_line_and_every_opening_of_a_valve_is_a_spray(self):
        part = self.part(*SENSORS)
        done = self.furrow("run", "--no-dds", "--clock", "lockstep", "--out", self.out,
                           "--recording", part)
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertIs(summary["against_truth"], False)
        self.assertIsNone(summary["placement_error_p50_mm"])
        self.assertIsNone(summary["loss_vision_pct"])
        applied = json.loads((self.out / "as_applied.geojson").read_text())["features"]
        self.assertGreater(summary["sprays"], 5)
        self.assertEqual(summary["sprays"], len(applied))
        self.assertEqual(sum(summary["sprays_by_axis"]), summary["sprays"])
        rows = self.ledger()
        self.assertEqual(len(rows), summary["weeds_total"] + summary["crops_total"])
        self.assertGreater(len(rows), 5)
        for row in rows:
            self.assertEqual(row["track_id"], row["plant_id"])
        self.assertIn("sensors (tracks of the robot, no ground truth)\n", done.stdout)
        self.assertIn("computed from the robot&#39;s own tracks", (self.out / "report.html").read_text())

    def test_with_ground_truth_the_plants_are_the_true_ones(self):
        part = self.part("*")
        summary = self.run_graph("--recording", part)
        self.assertIs(summary["against_truth"], True)

    def test_wheels_in_a_map_frame_are_refused_at_the_start_with_the_way_out(self):
        part = self.part(*SENSORS)
        self.assertGreater(move_wheels(part, 300_000.0, 5_600_000.0), 50)
        arguments = ("run", "--no-dds", "--clock", "lockstep", "--out", self.out, "--recording",
                     part)
        done = self.furrow(*arguments)
        self.assertEqual(done.returncode, 1, done.stderr)
        for word in ("wheel/odometry", "5600000.0 m", "localization.start=parameters"):
            self.assertIn(word, done.stderr)
        self.assertFalse((self.out / "summary.json").exists())
        started = self.folder / "started"
        summary = self.run_graph("--recording", part, "--set", "localization.start=parameters",
                                 out=started)
        self.assertGreater(summary["tracks_total"], 5)


class Origin(FurrowCase):
    def test_an_origin_for_one_component_alone_is_refused(self):
        for component in ("localization", "robot", "scorer"):
            self.assert_refused(
                ["run", "--no-dds", "--out", self.out,
                 "--set", f"{component}.origin_latitude_deg=48.5"],
                f"{component}.origin_latitude_deg", "common.origin_latitude_deg", "contradicts")

    def test_the_common_origin_is_that_of_the_applied_map(self):
        self.run_graph(*SHORT_RUN_WITH_IMAGES, "--graph", "weeding_true_detections",
                       "--set", "common.origin_latitude_deg=48.5",
                       "--set", "common.origin_longitude_deg=9.25")
        features = json.loads((self.out / "as_applied.geojson").read_text())["features"]
        self.assertTrue(features)
        for feature in features:
            longitude, latitude = feature["geometry"]["coordinates"][:2]
            self.assertAlmostEqual(longitude, 9.25, delta=1e-3)
            self.assertAlmostEqual(latitude, 48.5, delta=1e-3)


if __name__ == "__main__":
    unittest.main()
