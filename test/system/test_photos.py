"""The robot over real photographs. The photographs are not part of the project: they are looked for
in $FURROW_DATA_DIR, or in ../shared/data beside the project."""

import os
import pathlib
import shutil
import unittest

from furrow_case import ROOT, FurrowCase

DATA = pathlib.Path(os.environ.get("FURROW_DATA_DIR", ROOT.parent / "shared" / "data"))
IMAGES = 4


class PhotographsTest(FurrowCase):
    def some_of(self, name, images):
        """A folder with the first few images of a data set and what belongs to them."""
        source = DATA / name
        if not source.is_dir():
            reason = f"no photographs in {source}; FURROW_DATA_DIR names another folder"
            print(f"SKIPPED: {reason}")
            self.skipTest(reason)
        stems = [path.stem.removesuffix("_image")
                 for path in sorted((source / images).iterdir())[:IMAGES]]
        for path in sorted(source.rglob("*")):
            if path.is_file() and (path.stem in stems or path.stem.rpartition("_")[0] in stems):
                target = self.folder / name / path.relative_to(source)
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(path, target)
        return self.folder / name

    def weed(self, folder):
        summary = self.run_graph("--ground", f"photos:{folder}", "--length", 1, "--seed", 7,
                                 "--set", "camera.camera_rate_hz=1.5")
        rows = self.ledger()
        self.assertEqual(len(rows), summary["weeds_total"] + summary["crops_total"])
        self.assertGreater(summary["weeds_total"], 0)
        for row in rows:
            if row["kind"] == "weed" and row["outcome"] == "missed":
                self.assertNotEqual(row["reason"], "", row)
        # Real plants were seen where they stand: some track lies on a plant.
        self.assertGreater(sum(row["track_id"] != "" for row in rows), 0)
        return summary

    def test_false_colour_carrots(self):
        self.weed(self.some_of("cwfid", "images"))

    def test_natural_colour_carrots(self):
        self.weed(self.some_of("carrot_weed", "images"))


if __name__ == "__main__":
    unittest.main()
