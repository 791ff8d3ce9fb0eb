"""Paints plants of many habits onto an image: beets as petioled rosettes, and weeds of other habits.

The forms of the renderer are few, so that a network learns them by heart. Here light and texture are
alike for crops and weeds, and only the habit tells them apart. Ranges of size, leaf number and leaf
shape follow the labelled shapes of real sets.
"""

import dataclasses

import cv2
import numpy as np

SUPERSAMPLING = 2
POOL_SIZE = 240
MARGIN_PX = 4


@dataclasses.dataclass
class Sprite:
    bgr: np.ndarray
    alpha: np.ndarray  # 0 to 1
    kind: str  # name of the species


@dataclasses.dataclass
class Leaf:
    """A leaf seen from above. Lengths in px, angles in rad."""
    base: tuple
    angle: float
    petiole: float
    blade: float
    width: float  # at the widest, as a share of the blade's length
    widest: float  # place of the greatest width, as a share of the blade's length
    pointed: float  # 0 round, 1 pointed
    lobes: float = 0.0  # depth of lobes or teeth, as a share of the width
    lobe_count: float = 0.0
    bend: float = 0.0
    age: float = 1.0  # 0 youngest, 1 oldest


def _profile(leaf, s, rng):
    """Half the width over the blade, as a share of the blade's length."""
    w, p = leaf.widest, 1.0 + 0.7 * leaf.pointed
    a = 0.75
    b = a * (1 - w) / w * p
    shape = s ** a * (1 - s) ** (b / p if leaf.pointed < 0.3 else b)
    shape /= shape.max()
    depth, phase = rng.uniform(0.0, 0.07), rng.uniform(2, 5) * s + rng.random()
    waves = 1.0 + depth * np.sin(2 * np.pi * phase)
    if leaf.lobes > 0:
        saw = np.abs((leaf.lobe_count * s + rng.random()) % 1.0 * 2 - 1)
        waves = waves * (1 - leaf.lobes * saw)
    return 0.5 * leaf.width * shape * waves


def _paint_leaf(rng, canvas, alpha, leaf, light, colours):
    """Lays a leaf over the plants below. `light` is the direction of the light in the image, rad."""
    steps = 22
    s = np.linspace(0.0, 1.0, steps)
    angle = leaf.angle + leaf.bend * s
    step = leaf.blade / (steps - 1)
    start = np.array(leaf.base) + leaf.petiole * np.array([np.cos(leaf.angle), np.sin(leaf.angle)])
    along = np.stack([np.cos(angle), np.sin(angle)], 1)
    ribs = start + np.cumsum(along * step, axis=0)
    normal = np.stack([-along[:, 1], along[:, 0]], 1)
    sides = [ribs + sign * leaf.blade * _profile(leaf, s, rng)[:, None] * normal for sign in (-1, 1)]
    low = np.floor(np.minimum.reduce([*sides, ribs, [leaf.base] * steps]).min(0)).astype(int) - MARGIN_PX
    high = np.ceil(np.maximum.reduce([*sides, ribs, [leaf.base] * steps]).max(0)).astype(int) + MARGIN_PX
    low, high = np.maximum(low, 0), np.minimum(high, [canvas.shape[1], canvas.shape[0]])
    width, height = high - low
    if width < 3 or height < 3:
        return
    patch = np.zeros((height, width, 3), np.float32)
    mask = np.zeros((height, width), np.uint8)
    blade, rib, stalk = colours
    fold = rng.uniform(-0.1, 0.6)
    arch = rng.uniform(-0.35, 0.35)
    relief = rng.uniform(0.0, 0.18)
    for sign, outline in zip((-1, 1), sides):
        facing = np.cos(angle + sign * np.pi / 2 - light)
        shade = 1.0 + 0.5 * fold * facing + arch * np.cos(angle - light) * (2 * s - 1)
        shade *= 1.0 + relief * np.sin(2 * np.pi * (rng.uniform(3, 7) * s + rng.random()))
        for k in range(steps - 1):
            quad = np.stack([ribs[k], ribs[k + 1], outline[k + 1], outline[k]]) - low
            quad = np.round(quad * 8).astype(np.int32)
            cv2.fillConvexPoly(patch, quad, [float(c) for c in blade * shade[k]], cv2.LINE_8, 3)
            cv2.fillConvexPoly(mask, quad, 1, cv2.LINE_8, 3)
    patch = cv2.blur(patch, (3, 3))
    thin = max(1, int(round(leaf.blade * leaf.width * rng.uniform(0.02, 0.09))))
    line = np.round((ribs[:int(steps * 0.85)] - low) * 8).astype(np.int32)
    cv2.polylines(patch, [line], False, [float(c) for c in rib], thin, cv2.LINE_8, 3)
    if leaf.petiole > 1:
        ends = np.round(np.stack([np.array(leaf.base) - low, ribs[1] - low]) * 8).astype(np.int32)
        thick = max(1, int(round(leaf.blade * rng.uniform(0.04, 0.11))))
        cv2.polylines(patch, [ends], False, [float(c) for c in stalk], thick, cv2.LINE_8, 3)
        cv2.polylines(mask, [ends], False, 1, thick, cv2.LINE_8, 3)
    where = np.s_[low[1]:high[1], low[0]:high[0]]
    below = canvas[where]
    drop = rng.uniform(1.0, 5.0)
    move = np.float32([[1, 0, -drop * np.cos(light)], [0, 1, -drop * np.sin(light)]])
    shadow = cv2.warpAffine(mask, move, (int(width), int(height))).astype(np.float32)
    shadow = cv2.GaussianBlur(shadow, (0, 0), 1.0)
    below *= (1 - rng.uniform(0.2, 0.6) * shadow)[..., None]
    inside = mask > 0
    below[inside] = patch[inside]
    alpha[where][inside] = 1.0


def _rosette(rng, count, length, spread=0.25):
    """Angles and lengths of leaves from the oldest to the youngest."""
    turn = rng.choice([2.4, np.pi / 2 + 0.05, np.pi], p=[0.75, 0.15, 0.1])
    start = rng.uniform(0, 2 * np.pi)
    for k in range(count):
        age = 1.0 - k / max(count, 1)
        size = length * (0.25 + 0.75 * min(1.0, 1.6 * age)) * np.exp(rng.normal(0, spread))
        yield start + turn * k + rng.normal(0, 0.25), size * rng.uniform(0.65, 1.0), age


def beet(rng):
    # Few are small: seedlings of beets and of broad-leaved weeds look alike.
    if rng.random() < 0.12:  # cotyledons, at times with the first pair of leaves
        count, radius = int(rng.choice([0, 0, 2])), rng.uniform(5.0, 22.0)
    else:
        count, radius = int(rng.integers(3, 13)), float(np.exp(rng.uniform(np.log(28.0), np.log(125.0))))
    leaves = []
    width, petiole = rng.uniform(0.42, 0.85), rng.uniform(0.12, 0.45)
    if count < 5:
        first, size = rng.uniform(0, 2 * np.pi), radius if count == 0 else 0.7 * min(radius, 24.0)
        for turn in (0, np.pi):
            leaves.append(Leaf((0, 0), first + turn + rng.normal(0, 0.15), petiole=0.25 * size,
                               blade=0.75 * size * rng.uniform(0.8, 1.1),
                               width=rng.uniform(0.28, 0.5), widest=0.5, pointed=0.0,
                               bend=rng.normal(0, 0.2)))
    for angle, size, age in _rosette(rng, count, radius):
        share = petiole * rng.uniform(0.7, 1.3)
        leaves.append(Leaf((0, 0), angle, petiole=share * size, blade=(1 - share) * size,
                           width=width * rng.uniform(0.65, 1.3), widest=rng.uniform(0.4, 0.66),
                           pointed=rng.uniform(0, 0.5), bend=rng.normal(0, 0.4), age=age))
    return leaves, radius


def _stacked(rng, widths, teeth, pointed, radius):
    """A leafy shoot from above: many leaves, older ones below and longer."""
    count = int(rng.integers(4, 20))
    width, petiole = rng.uniform(*widths), rng.uniform(0.0, 0.25)
    depth, teeth_count = rng.uniform(*teeth), rng.uniform(2.5, 6.0)
    return [Leaf((0, 0), angle, petiole * size, (1 - petiole) * size, width * rng.uniform(0.8, 1.2),
                 rng.uniform(0.3, 0.5), pointed, depth, teeth_count, rng.normal(0, 0.3), age)
            for angle, size, age in _rosette(rng, count, radius, 0.2)]


def _creeping(rng, radius):
    """A shoot along the ground with leaves on both sides."""
    place, heading, leaves = np.zeros(2), rng.uniform(0, 2 * np.pi), []
    size, width, lobes = radius * rng.uniform(0.2, 0.45), rng.uniform(0.25, 0.8), rng.choice([0.0, 0.4])
    for k in range(int(rng.integers(4, 12))):
        ahead = 0.5 * size * np.array([np.cos(heading), np.sin(heading)])
        for side in ((-1, 1) if rng.random() < 0.4 else (rng.choice([-1, 1]),)):
            leaves.append(Leaf(tuple(place), heading + side * rng.uniform(0.6, 1.5),
                               petiole=0.2 * size, blade=size * rng.uniform(0.6, 1.2), width=width,
                               widest=rng.uniform(0.15, 0.5), pointed=1.0, lobes=lobes,
                               lobe_count=1.5, bend=rng.normal(0, 0.3), age=1 - k / 12))
        place, heading = place + ahead, heading + rng.normal(0, 0.3)
    return leaves


def weed(rng):
    """Leaves, reach and species of the nearest habit."""
    radius = float(np.exp(rng.uniform(np.log(6.0), np.log(100.0))))
    habit = rng.choice(["shoot", "lance", "grass", "lobed", "mat", "creeping", "seedling"],
                       p=[0.3, 0.16, 0.12, 0.14, 0.1, 0.1, 0.08])
    if habit == "shoot":
        leaves = _stacked(rng, (0.35, 0.75), (0.0, 0.35), 1.0, radius)
        return leaves, radius, "lambsquarters" if rng.random() < 0.6 else "pigweed"
    if habit == "lance":
        return _stacked(rng, (0.12, 0.3), (0.0, 0.1), 1.0, radius), radius, "pigweed"
    if habit == "grass":
        leaves = [Leaf((0, 0), a, 0.0, s, rng.uniform(0.05, 0.13), 0.35, 1.0, bend=rng.normal(0, 0.7), age=age)
                  for a, s, age in _rosette(rng, int(rng.integers(2, 9)), radius)]
        return leaves, radius, "barnyardgrass" if rng.random() < 0.5 else "foxtail"
    if habit == "lobed":
        leaves = _stacked(rng, (0.25, 0.6), (0.35, 0.8), 0.6, radius)
        return leaves, radius, "thistle" if rng.random() < 0.6 else "chamomile"
    if habit == "mat":
        radius = min(radius, 40.0)
        leaves = [Leaf(tuple(rng.normal(0, 0.35 * radius, 2)), rng.uniform(0, 2 * np.pi),
                       petiole=0.05 * radius, blade=radius * rng.uniform(0.15, 0.4),
                       width=rng.uniform(0.5, 0.9), widest=0.5, pointed=rng.uniform(0, 1))
                  for _ in range(int(rng.integers(6, 22)))]
        return leaves, radius, "chickweed" if rng.random() < 0.5 else "speedwell"
    if habit == "creeping":
        return _creeping(rng, radius), radius, "bindweed"
    radius = rng.uniform(3.0, 10.0)  # seedling: two short round leaves
    first = rng.uniform(0, 2 * np.pi)
    leaves = [Leaf((0, 0), first + turn, petiole=0.2 * radius, blade=0.8 * radius,
                   width=rng.uniform(0.5, 0.9), widest=0.55, pointed=0.0) for turn in (0, np.pi)]
    return leaves, radius, "nightshade"


def paint(rng, crop):
    """A sprite at SUPERSAMPLING times the resolution, stem in the middle."""
    leaves, reach, kind = (*beet(rng), "sugar_beet") if crop else weed(rng)
    span = max([reach] + [np.hypot(*leaf.base) + leaf.petiole + 1.2 * leaf.blade for leaf in leaves])
    half = int(SUPERSAMPLING * (span + MARGIN_PX)) + 2
    canvas, alpha = np.zeros((2 * half, 2 * half, 3), np.float32), np.zeros((2 * half, 2 * half), np.float32)
    green = np.array([62.0, 125.0, 82.0]) * np.exp(rng.normal(0, [0.2, 0.12, 0.15]))
    young = np.exp(rng.normal([-0.1, 0.2, 0.25], 0.15))
    if rng.random() < 0.85:
        pale = np.array([95.0, 160.0, 140.0]) * np.exp(rng.normal(0, 0.15))
    else:
        pale = np.array([90.0, 90.0, 150.0])  # reddish petioles
    light = rng.uniform(0, 2 * np.pi)
    for leaf in leaves:
        size = dataclasses.replace(leaf, base=tuple(SUPERSAMPLING * np.array(leaf.base) + half),
                                   petiole=SUPERSAMPLING * leaf.petiole, blade=SUPERSAMPLING * leaf.blade)
        blade = green * np.where(leaf.age < 0.35, young, 1.0) * np.exp(rng.normal(0, 0.13))
        rib = blade * rng.uniform(0.85, 1.45)
        _paint_leaf(rng, canvas, alpha, size, light, (blade, rib, 0.5 * (pale + blade)))
    _texture(rng, canvas, alpha)
    return Sprite(np.clip(canvas, 0, 255).astype(np.uint8), alpha, kind)


def _texture(rng, canvas, alpha):
    """Blisters, veins and gloss, drawn alike for every kind."""
    fine, coarse = [(rng.uniform(*scale), rng.uniform(0, depth))
                    for scale, depth in (((2, 5), 0.17), ((5, 14), 0.2))]
    for scale, depth in (fine, coarse):
        cells = [int(side / scale) + 2 for side in alpha.shape]
        noise = rng.standard_normal(cells).astype(np.float32)
        noise = cv2.resize(noise, alpha.shape[::-1], interpolation=cv2.INTER_CUBIC)
        canvas *= np.clip(1 + depth * noise, 0.3, 1.8)[..., None]
        if rng.random() < 0.35:
            canvas += (rng.uniform(20, 130) * np.clip(noise - rng.uniform(0.8, 1.6), 0, 2) * alpha)[..., None]


class Pool:
    """Sprites that are painted once and laid many times, each time turned and scaled."""

    def __init__(self, seed, size=POOL_SIZE):
        rng = np.random.default_rng(seed)
        self.crops = [paint(rng, True) for _ in range(size // 2)]
        self.weeds = [paint(rng, False) for _ in range(size - size // 2)]


def _lay(rng, image, ids, plants, sprite, u, v, class_index):
    """Writes into `image` and `ids`; a plant that shows nowhere is not added."""
    scale = np.exp(rng.normal(0, 0.2)) / SUPERSAMPLING
    side = int(np.ceil(1.45 * sprite.alpha.shape[0] * scale)) + 2
    middle = (sprite.alpha.shape[1] / 2, sprite.alpha.shape[0] / 2)
    turn = cv2.getRotationMatrix2D(middle, rng.uniform(0, 360), scale)
    turn[:, 2] += side / 2 - np.array(middle)
    if rng.random() < 0.5:  # seen from the side
        turn[0] *= rng.uniform(0.75, 1.0)
        turn[0, 2] += side / 2 - turn[0] @ [*middle, 1]
    source = cv2.blur(sprite.bgr, (2, 2))
    bgr = cv2.warpAffine(source, turn, (side, side), flags=cv2.INTER_LINEAR)
    alpha = cv2.warpAffine(cv2.blur(sprite.alpha, (2, 2)), turn, (side, side), flags=cv2.INTER_LINEAR)
    left, top = int(round(u - side / 2)), int(round(v - side / 2))
    height, width = ids.shape
    u0, v0, u1, v1 = max(left, 0), max(top, 0), min(left + side, width), min(top + side, height)
    if u0 >= u1 or v0 >= v1:
        return
    part, where = np.s_[v0 - top:v1 - top, u0 - left:u1 - left], np.s_[v0:v1, u0:u1]
    a = alpha[part][..., None]
    if (a > 0.5).sum() < 12:
        return
    image[where] = (image[where] * (1 - a) + bgr[part] * a).astype(np.uint8)
    ids[where][a[..., 0] > 0.5] = len(plants)
    plants.append((class_index, u, v))


def add(rng, image, ids, plants, pool, classes):
    """Returns image, ids and plants with painted plants: beets in a row as a rule, weeds anywhere."""
    image, ids, plants = image.copy(), ids.copy(), list(plants)
    index = {name: i for i, (name, _) in enumerate(classes)}
    height, width = ids.shape
    places = []
    if rng.random() < 0.8:
        u, v = rng.uniform(0.1, 0.9) * width, rng.uniform(-60, 60)
        spacing, lean = rng.uniform(60, 230), rng.normal(0, 0.08)
        while v < height + 40:
            places.append((rng.choice(len(pool.crops)), True, u + lean * v + rng.normal(0, 8), v))
            v += spacing * np.exp(rng.normal(0, 0.25))
    for _ in range(int(rng.exponential(5.0) + (rng.random() < 0.8))):
        places.append((rng.choice(len(pool.weeds)), False, rng.uniform(0, width), rng.uniform(0, height)))
    rng.shuffle(places)
    for which, crop, u, v in places:
        sprite = (pool.crops if crop else pool.weeds)[int(which)]
        _lay(rng, image, ids, plants, sprite, float(u), float(v), index[sprite.kind])
    return image, ids, plants
