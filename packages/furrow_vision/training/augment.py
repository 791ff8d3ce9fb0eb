"""The augmentation of BonnBot-I Plus (Ahmadi et al. 2024), each step with probability 0.5, and the
usual ones of geometry. The same definitions as furrow_vision's augmentation.hpp."""

import cv2
import numpy as np

PROBABILITY = 0.5


def crop_and_turn(rng, image, ids, plants, size, scale_range=(0.8, 1.25)):
    """A square of `size` px at a random place, scale, turn by quarters, and mirror image."""
    scale = rng.uniform(*scale_range)
    need = int(np.ceil(size / scale))
    height, width = ids.shape
    pad_v, pad_u = max(need - height, 0), max(need - width, 0)
    if pad_v or pad_u:
        mean = [float(c) for c in image.reshape(-1, 3).mean(axis=0)]
        image = cv2.copyMakeBorder(image, 0, pad_v, 0, pad_u, cv2.BORDER_CONSTANT, value=mean)
        ids = cv2.copyMakeBorder(ids, 0, pad_v, 0, pad_u, cv2.BORDER_CONSTANT, value=-1)
        height, width = ids.shape
    v0, u0 = rng.integers(0, height - need + 1), rng.integers(0, width - need + 1)
    image, ids = image[v0:v0 + need, u0:u0 + need], ids[v0:v0 + need, u0:u0 + need]
    image = cv2.resize(image, (size, size), interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR)
    ids = cv2.resize(ids, (size, size), interpolation=cv2.INTER_NEAREST)
    factor = size / need
    plants = [(c, (u - u0 + 0.5) * factor - 0.5, (v - v0 + 0.5) * factor - 0.5) for c, u, v in plants]
    if rng.random() < 0.5:
        image, ids = image[:, ::-1], ids[:, ::-1]
        plants = [(c, size - 1 - u, v) for c, u, v in plants]
    # Rows run along the image's columns, so that only half turns keep them.
    if rng.random() < 0.5:
        image, ids = image[::-1, ::-1], ids[::-1, ::-1]
        plants = [(c, size - 1 - u, size - 1 - v) for c, u, v in plants]
    return np.ascontiguousarray(image), np.ascontiguousarray(ids), plants


def quarter_turn(rng, image, ids, plants):
    """By a quarter to the left in half of the cases: rows that cross the image."""
    if rng.random() < 0.5:
        return image, ids, plants
    width = ids.shape[1]
    plants = [(c, v, width - 1 - u) for c, u, v in plants]
    return np.ascontiguousarray(np.rot90(image)), np.ascontiguousarray(np.rot90(ids)), plants


def photometric(rng, bgr):
    if rng.random() < PROBABILITY:
        bgr = _shift_luminance(bgr, rng.uniform(-15, 15))
    if rng.random() < PROBABILITY:
        bgr = np.clip(bgr * rng.uniform(0.95, 1.05, 3), 0, 255).astype(np.uint8)
    if rng.random() < PROBABILITY:
        bgr = cv2.GaussianBlur(bgr, (3, 3), 0)
    if rng.random() < PROBABILITY:
        bgr = _illumination_box(rng, bgr)
    return bgr


def _shift_luminance(bgr, delta, weight=None):
    lab = cv2.cvtColor(bgr.astype(np.float32) / 255.0, cv2.COLOR_BGR2LAB)
    lab[..., 0] = np.clip(lab[..., 0] + (delta if weight is None else delta * weight), 0, 100)
    return np.clip(cv2.cvtColor(lab, cv2.COLOR_LAB2BGR) * 255.0 + 0.5, 0, 255).astype(np.uint8)


def _illumination_box(rng, bgr):
    height, width = bgr.shape[:2]
    box = ((rng.uniform(0, width), rng.uniform(0, height)),
           (rng.uniform(0.2, 0.8) * width, rng.uniform(0.2, 0.8) * height), rng.uniform(-10, 10))
    weight = np.zeros((height, width), np.float32)
    cv2.fillPoly(weight, [np.round(cv2.boxPoints(box)).astype(np.int32)], 1.0)
    return _shift_luminance(bgr, rng.uniform(5, 30), cv2.GaussianBlur(weight, (3, 3), 0))
