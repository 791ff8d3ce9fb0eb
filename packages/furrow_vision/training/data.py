"""COCO data sets as training samples: images, and the maps that the one-stage network learns."""

import json
import pathlib

import cv2
import numpy as np

STRIDE = 4
OFFSET_UNIT_PX = 32.0
# Ids of pixels that belong to no plant: soil, and vegetation that the data set gives no plant.
SOIL, UNKNOWN = -1, -2


def decode_rle(segmentation):
    """A COCO run-length mask (compressed or not) as an array of 0 and 1."""
    height, width = segmentation["size"]
    counts = segmentation["counts"]
    if isinstance(counts, str):
        counts = _decompress(counts)
    flat = np.zeros(height * width, np.uint8)
    at, value = 0, 0
    for run in counts:
        if value:
            flat[at:at + run] = 1
        at += run
        value = 1 - value
    if at != height * width:
        raise ValueError(f"run lengths add up to {at}, not to {height * width}")
    return flat.reshape((width, height)).T


def _decompress(text):
    counts, at = [], 0
    while at < len(text):
        value, shift, more = 0, 0, True
        while more:
            bits = ord(text[at]) - 48
            value |= (bits & 0x1F) << shift
            more = bool(bits & 0x20)
            at += 1
            shift += 5
            if not more and bits & 0x10:
                value |= -1 << shift
        if len(counts) > 2:
            value += counts[-2]
        counts.append(value)
    return counts


def mask_of(annotation, file):
    """The mask of an annotation. Polygons and boxes have one reader, that of the furrow command."""
    segmentation = annotation.get("segmentation")
    if not isinstance(segmentation, dict):
        raise SystemExit(f"{file}: annotation {annotation.get('id')} has no run-length mask; bring the "
                         "data set into the form that is trained on: furrow dataset convert IN OUT")
    return decode_rle(segmentation)


def stem_of(annotation, category):
    """The pixel of the keypoint that the category calls "stem", None where it is not labelled."""
    names = category.get("keypoints", [])
    keypoints = annotation.get("keypoints") or []
    if "stem" not in names or len(keypoints) < 3 * len(names):
        return None
    u, v, visibility = keypoints[3 * names.index("stem"):][:3]
    return (u, v) if visibility > 0 else None


class CocoSet:
    """Images with instance ids, classes and stems, of one COCO file or several. `classes` are names,
    crop species first. Frames that are not labelled are left out. Keeps what it has decoded, up to
    `memory_bytes`."""

    def __init__(self, files, classes=None, memory_bytes=4 << 30):
        self.memory_left, self.decoded = memory_bytes, {}
        self.classes, self.items = classes, []
        for file in files if isinstance(files, list) else [files]:
            self._read(pathlib.Path(file))

    def _read(self, file):
        if not file.is_file():
            raise SystemExit(f"{file}: missing; furrow dataset convert IN OUT makes train.json, "
                             "validation.json and evaluation.json")
        try:
            content = json.loads(file.read_text())
        except ValueError as error:
            raise SystemExit(f"{file}: not JSON: {error}") from None
        categories = {c["id"]: c for c in content["categories"]}
        ordered = sorted(categories.values(),
                         key=lambda c: (c.get("supercategory") != "crop", c["id"]))
        self.classes = self.classes or [
            (c["name"], "crop" if c.get("supercategory") == "crop" else "weed") for c in ordered]
        index = {name: i for i, (name, _) in enumerate(self.classes)}
        by_image = {}
        for annotation in content["annotations"]:
            name = categories[annotation["category_id"]]["name"]
            if name not in index:
                raise SystemExit(f"{file}: category '{name}' is not one of the model's classes "
                                 f"({', '.join(index)}); adapt_classes.py makes weights with the "
                                 "classes of this set, to be given by --start")
            stem = stem_of(annotation, categories[annotation["category_id"]])
            by_image.setdefault(annotation["image_id"], []).append((index[name], stem, annotation))
        self.items += [(file.parent / image["file_name"], file, by_image.get(image["id"], []))
                       for image in content["images"] if image.get("labelled", True)]

    def __len__(self):
        return len(self.items)

    def load(self, i):
        """BGR image; map of instance ids, SOIL or UNKNOWN; list of (class, stem u, stem v) by id."""
        if i not in self.decoded:
            sample = self._decode(i)
            size = sample[0].nbytes + sample[1].nbytes
            if size > self.memory_left:
                return sample
            self.memory_left -= size
            self.decoded[i] = sample
        return self.decoded[i]

    def _decode(self, i):
        path, file, annotations = self.items[i]
        image = cv2.imread(str(path), cv2.IMREAD_COLOR)
        if image is None:
            raise SystemExit(f"{path}: not an image")
        ids = np.full(image.shape[:2], SOIL, np.int16)
        plants = []
        for class_index, stem, annotation in annotations:
            mask = mask_of(annotation, file)
            if annotation.get("iscrowd"):
                ids[(mask > 0) & (ids == SOIL)] = UNKNOWN
                continue
            if stem is None:
                rows, columns = np.nonzero(mask)
                if len(rows) == 0:
                    continue
                stem = [columns.mean(), rows.mean()]
            ids[mask > 0] = len(plants)
            plants.append((class_index, float(stem[0]), float(stem[1])))
        return image, ids, plants


def targets(ids, plants, stride=STRIDE):
    """Maps at the output's stride: plant share (-1: not known), class (-1: none), stem heatmap,
    offsets."""
    height, width = ids.shape[0] // stride, ids.shape[1] // stride
    blocks = ids[:height * stride, :width * stride].reshape(height, stride, width, stride)
    blocks = blocks.transpose(0, 2, 1, 3).reshape(height, width, stride * stride)
    share = (blocks >= 0).mean(axis=2).astype(np.float32)
    share[(blocks == UNKNOWN).any(axis=2)] = -1.0
    # The plant of a cell is the one that its middle rows show most; the maximum id is as good where
    # two meet.
    owner = blocks.max(axis=2)
    plants_array = np.array(plants, np.float32).reshape(-1, 3)
    classes = np.full((height, width), -1, np.int64)
    offsets = np.zeros((2, height, width), np.float32)
    heat = np.zeros((height, width), np.float32)
    inside = owner >= 0
    if len(plants):
        v, u = np.mgrid[0:height, 0:width].astype(np.float32)
        u, v = (u + 0.5) * stride - 0.5, (v + 0.5) * stride - 0.5
        classes[inside] = plants_array[owner[inside], 0].astype(np.int64)
        offsets[0][inside] = (plants_array[owner[inside], 1] - u[inside]) / OFFSET_UNIT_PX
        offsets[1][inside] = (plants_array[owner[inside], 2] - v[inside]) / OFFSET_UNIT_PX
        for _, stem_u, stem_v in plants:
            _draw_peak(heat, (stem_u + 0.5) / stride - 0.5, (stem_v + 0.5) / stride - 0.5)
    return share, classes, heat, offsets


def _draw_peak(heat, u, v, sigma=1.3, reach=5):
    height, width = heat.shape
    if not (-1 <= u <= width and -1 <= v <= height):
        return
    u0, u1 = max(int(u) - reach, 0), min(int(u) + reach + 1, width)
    v0, v1 = max(int(v) - reach, 0), min(int(v) + reach + 1, height)
    if u0 >= u1 or v0 >= v1:
        return
    gy, gx = np.mgrid[v0:v1, u0:u1]
    bump = np.exp(-((gx - u) ** 2 + (gy - v) ** 2) / (2 * sigma ** 2))
    # The nearest cell is the peak itself, however the stem lies between cells.
    bump[np.unravel_index(bump.argmax(), bump.shape)] = 1.0
    region = heat[v0:v1, u0:u1]
    np.maximum(region, bump, out=region)
