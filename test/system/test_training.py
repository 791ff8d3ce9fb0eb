"""What the training's scripts check and plan. Those need torch; $FURROW_TRAINING_PYTHON names an
interpreter that has it."""

import json
import os
import subprocess
import sys
import tempfile
import textwrap
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TRAINING = ROOT / "packages" / "furrow_vision" / "training"


def training_python():
    """An interpreter that the training's scripts run in; nothing where there is none."""
    for python in (os.environ.get("FURROW_TRAINING_PYTHON"), sys.executable, "/usr/bin/python3"):
        if python and subprocess.run([python, "-c", "import cv2, numpy, torch"], capture_output=True,
                                     check=False).returncode == 0:
            return python
    return None


class TrainingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.python = training_python()

    def setUp(self):
        if self.python is None:
            reason = "no Python with torch and OpenCV; FURROW_TRAINING_PYTHON names one"
            print(f"SKIPPED: {reason}")
            self.skipTest(reason)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def call(self, *arguments):
        return subprocess.run([self.python, *map(str, arguments)], capture_output=True, text=True,
                              timeout=100, check=False, cwd=TRAINING)

    def result(self, code):
        done = self.call("-c", textwrap.dedent(code))
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout.splitlines()[-1])

    def refusal(self, *arguments):
        done = self.call(*arguments)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertNotIn("Traceback", done.stderr)
        return done.stderr

    def write_set(self, category):
        """One black image with one plant of 8 x 8 px."""
        content = {
            "images": [{"id": 0, "file_name": "0.png", "width": 64, "height": 64}],
            "categories": [{"id": 1, "name": category, "supercategory": "crop"}],
            "annotations": [{"id": 1, "image_id": 0, "category_id": 1,
                             "segmentation": {"size": [64, 64],
                                              "counts": [0] + [8, 56] * 8 + [56 * 64]}}]}
        for name in ("train", "validation"):
            (self.folder / f"{name}.json").write_text(json.dumps(content))
        return self.folder

    def test_class_without_pixels_does_not_set_the_scale_of_the_others(self):
        # Classes of 100 and 400 pixels: 1/10 and 1/20, whose mean is 0.075.
        weights = self.result("""
            import json
            import numpy as np
            import training_run

            class Set:
                classes = [("beet", "crop"), ("maize", "crop"), ("thistle", "weed")]
                def __len__(self):
                    return 1
                def load(self, i):
                    ids = np.full((50, 10), 0, np.int16)
                    ids[40:] = 1
                    return None, ids, [(0, 0, 0), (2, 0, 0)]
            print(json.dumps(training_run.class_weights(Set()).tolist()))
        """)
        for weight, wanted in zip(weights, (0.05 / 0.075, 1.0, 0.1 / 0.075)):
            self.assertAlmostEqual(weight, wanted, places=5)

    def test_average_of_few_steps_is_of_the_trained_weights(self):
        # Weights 0 before and 1 after the first of 16 steps. A decay of .995 would give 0.08.
        average = self.result("""
            import torch
            import training_run
            model = torch.nn.Linear(1, 1, bias=False)
            model.weight.data.zero_()
            average = torch.optim.swa_utils.AveragedModel(model, avg_fn=training_run.average_of)
            average.update_parameters(model)
            model.weight.data.fill_(1.0)
            for _ in range(15):
                average.update_parameters(model)
            print(average.module.weight.item())
        """)
        self.assertGreater(average, 0.99)

    def test_average_of_many_steps_keeps_two_hundred(self):
        self.assertEqual(self.result("import training_run; print(training_run.average_decay(5000))"),
                         0.995)

    def test_missing_set_is_refused_with_the_command_that_makes_it(self):
        error = self.refusal("train_one_stage.py", self.folder, "--out", self.folder / "model")
        self.assertIn(f"{self.folder / 'train.json'}: missing; furrow dataset convert", error)

    def test_unknown_class_is_refused_with_the_script_that_adapts(self):
        self.write_set("carrot")
        error = self.refusal("train_one_stage.py", self.folder, "--out", self.folder / "model",
                             "--start", ROOT / "models" / "one_stage.pt")
        self.assertIn("category 'carrot' is not one of the model's classes (sugar_beet", error)
        self.assertIn("adapt_classes.py", error)

    def test_resolution_is_that_of_the_start(self):
        start = self.folder / "start.pt"
        (self.folder / "start.yaml").write_text("ground_resolution_mm_per_px: 2.5\n")
        code = (f"import pathlib, training_run; "
                f"print(training_run.ground_resolution(None, pathlib.Path({str(start)!r})))")
        self.assertEqual(self.result(code), 2.5)

    def test_start_without_a_resolution_asks_for_one(self):
        error = self.refusal("train_one_stage.py", self.folder, "--out", self.folder / "model",
                             "--start", self.folder / "start.pt")
        self.assertIn("--resolution", error)


if __name__ == "__main__":
    unittest.main()
