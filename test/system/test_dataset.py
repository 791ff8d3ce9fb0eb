"""Rendered data sets: their structure, and what the training's scripts read of them. Those need numpy
and OpenCV for Python; $FURROW_TRAINING_PYTHON names an interpreter that has them."""

import json
import math
import os
import subprocess
import sys
import unittest

from furrow_case import ROOT, FurrowCase

TRAINING = ROOT / "packages" / "furrow_vision" / "training"
FRAMES = 3
SPEED_MPS, RATE_HZ = 0.4, 4.0

READ = """
import json, sys
sys.path.insert(0, sys.argv[1])
import data
read = data.CocoSet(sys.argv[2:])
result = []
for i in range(len(read)):
    _, ids, plants = read.load(i)
    share, _, _, _ = data.targets(ids, plants)
    result.append({"file": read.items[i][0].name, "plants": len(plants),
                   "unknown_px": int((ids == data.UNKNOWN).sum()),
                   "unknown_cells": int((share < 0).sum())})
print(json.dumps(result))
"""


def training_python():
    """An interpreter that the training's scripts run in; nothing where there is none."""
    for python in (os.environ.get("FURROW_TRAINING_PYTHON"), sys.executable, "/usr/bin/python3"):
        if python and subprocess.run([python, "-c", "import cv2, numpy"], capture_output=True,
                                     check=False).returncode == 0:
            return python
    return None


class RenderedSequencesTest(FurrowCase):
    def setUp(self):
        super().setUp()
        done = self.furrow("dataset", "render", self.out, "--seed", 5, "--set", "images=4",
                           f"sequence_frames={FRAMES}", f"velocity_mps={SPEED_MPS}",
                           f"frame_rate_hz={RATE_HZ}", "width_px=160", "height_px=128",
                           "resolution_mm_per_px=2.5", "validation_share=0.25",
                           "evaluation_share=0.25", "crop_share=1")
        self.assertEqual(done.returncode, 0, done.stderr)

    def part(self, name):
        return json.loads((self.out / f"{name}.json").read_text())

    def training_reads(self, *parts):
        python = training_python()
        if python is None:
            reason = "no Python with numpy and OpenCV; FURROW_TRAINING_PYTHON names one"
            print(f"SKIPPED: {reason}")
            self.skipTest(reason)
        files = [str(self.out / f"{part}.json") for part in parts]
        done = subprocess.run([python, "-c", READ, str(TRAINING), *files], capture_output=True,
                              text=True, timeout=100, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_last_frame_of_a_sequence_is_labelled(self):
        for name, sequences in (("train", 2), ("validation", 1), ("evaluation", 1)):
            part = self.part(name)
            self.assertEqual(len(part["images"]), sequences * FRAMES)
            labelled = {a["image_id"] for a in part["annotations"]}
            for first in range(0, len(part["images"]), FRAMES):
                frames = part["images"][first:first + FRAMES]
                self.assertEqual(len({frame["sequence"] for frame in frames}), 1)
                self.assertEqual([frame.get("labelled", True) for frame in frames],
                                 [False] * (FRAMES - 1) + [True])
                for frame in frames[:-1]:
                    self.assertNotIn(frame["id"], labelled)
                for before, after in zip(frames, frames[1:]):
                    self.assertEqual(after["stamp_ns"] - before["stamp_ns"], 1e9 / RATE_HZ)
                    self.assertAlmostEqual(math.dist(before["pose"][:2], after["pose"][:2]),
                                           SPEED_MPS / RATE_HZ)
                for frame in frames:
                    self.assertTrue((self.out / frame["file_name"]).is_file())

    def test_command_reads_it(self):
        done = self.furrow("eval", "vision", "--detector", "index", "--dataset", self.out, "--json",
                           self.folder / "vision.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn('"images": 1', (self.folder / "vision.json").read_text())

    def test_training_leaves_frames_without_labels_out(self):
        read = self.training_reads("train", "validation")
        wanted = [frame["file_name"].rpartition("/")[2]
                  for name in ("train", "validation") for frame in self.part(name)["images"]
                  if frame.get("labelled", True)]
        self.assertEqual([image["file"] for image in read], wanted)
        self.assertEqual(len(read), 3)
        self.assertEqual(sum(image["unknown_px"] for image in read), 0)

    def test_training_takes_crowds_for_no_plant(self):
        part = self.part("train")
        image = part["annotations"][0]["image_id"]
        before = sum(a["image_id"] == image for a in part["annotations"])
        part["annotations"][0]["iscrowd"] = 1
        (self.out / "crowd.json").write_text(json.dumps(part))
        read = {entry["file"]: entry for entry in self.training_reads("crowd")}
        name = next(entry["file_name"] for entry in part["images"] if entry["id"] == image)
        entry = read[name.rpartition("/")[2]]
        self.assertEqual(entry["plants"], before - 1)
        self.assertEqual(entry["unknown_px"], part["annotations"][0]["area"])
        self.assertGreater(entry["unknown_cells"], 0)


class ConversionTest(FurrowCase):
    """A COCO file whose categories do not say what is a crop."""

    def setUp(self):
        super().setUp()
        done = self.furrow("dataset", "render", "rendered", "--seed", 2, "--set", "images=12",
                           "width_px=160", "height_px=128", "resolution_mm_per_px=2.5",
                           "validation_share=0.25", "evaluation_share=0.5", "crop_share=1")
        self.assertEqual(done.returncode, 0, done.stderr)
        file = self.folder / "rendered" / "train.json"
        content = json.loads(file.read_text())
        for category in content["categories"]:
            del category["supercategory"]
        file.write_text(json.dumps(content))

    def kinds(self, part):
        content = json.loads((self.out / f"{part}.json").read_text())
        return {c["name"]: c["supercategory"] for c in content["categories"]}

    def test_without_a_word_about_crops_it_is_refused_with_the_way_out(self):
        self.assert_refused(["dataset", "convert", "rendered/train.json", self.out], "sugar_beet",
                            "--crop NAME")

    def test_named_crops_are_crops_and_the_others_weeds(self):
        done = self.furrow("dataset", "convert", "rendered/train.json", self.out, "--crop",
                           "sugar_beet", "--validation-share", 0.5, "--evaluation-share", 0)
        self.assertEqual(done.returncode, 0, done.stderr)
        kinds = self.kinds("train")
        self.assertEqual({name for name, kind in kinds.items() if kind == "crop"}, {"sugar_beet"})
        self.assertGreater(len(kinds), 1)

    def test_images_of_a_group_stay_in_one_set(self):
        done = self.furrow("dataset", "convert", "rendered/evaluation.json", self.out, "--group-by",
                           "png$", "--evaluation-share", 0.5)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("in 1 groups", done.stdout)
        self.assertIn("6 images", done.stdout)
        sizes = [len(json.loads((self.out / f"{part}.json").read_text())["images"])
                 for part in ("train", "validation", "evaluation")]
        self.assertEqual(sum(size > 0 for size in sizes), 1)

    def test_a_gap_needs_times(self):
        self.assert_refused(["dataset", "convert", "rendered/evaluation.json", self.out, "--gap", 5],
                            "--gap: ", "not a Unix time")

    def test_a_crop_that_is_not_there_is_refused_with_the_nearest_name(self):
        self.assert_refused(["dataset", "convert", "rendered/train.json", self.out, "--crop",
                             "suger_beet"], "suger_beet", "did you mean 'sugar_beet'?")


if __name__ == "__main__":
    unittest.main()
