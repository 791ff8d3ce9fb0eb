"""Changes a rendered image towards what real fields show: colours of leaves, hard shadows, things that
are no plant, the camera. Every change is drawn from `rng`; the same generator gives the same image.

A detector that learned from plain renderings takes a real beet for a weed, because its colour, light
and sharpness are others. Ranges are wide on purpose: a real image must look like one more draw.
"""

import cv2
import numpy as np

import data


def randomise(rng, bgr, ids, plants, crops):
    """Returns image and ids. `crops`: the first classes that are crops. Ids change only where
    something is laid over plants."""
    image = bgr.astype(np.float32)
    if len(plants) and rng.random() < 0.85:
        image = recolour_plants(rng, image, ids, plants, crops)
    if rng.random() < 0.5:
        image = recolour_soil(rng, image, ids)
    if rng.random() < 0.4:
        image = cast_shadows(rng, image, ids)
    if rng.random() < 0.45:
        image, ids = scatter_objects(rng, image, ids)
    if rng.random() < 0.12:
        image, ids = robot_part(rng, image, ids)
    if rng.random() < 0.15:
        image = large_shadow(rng, image)
    return camera(rng, image), ids


def _smooth_noise(rng, shape, cell_px):
    """Values around 0 with a deviation of about 1, smooth over `cell_px`."""
    rows, columns = max(2, int(shape[0] / cell_px) + 2), max(2, int(shape[1] / cell_px) + 2)
    coarse = rng.standard_normal((rows, columns)).astype(np.float32)
    return cv2.resize(coarse, (shape[1], shape[0]), interpolation=cv2.INTER_CUBIC)


def _colour_gain(rng, spread):
    """Gains of blue, green, red. The blue one varies most: between yellowish and bluish green."""
    value = np.exp(rng.normal(0.0, 0.24 * spread))
    blue, red = np.exp(rng.normal(0.0, 0.27 * spread)), np.exp(rng.normal(0.0, 0.14 * spread))
    return value * np.array([blue, 1.0, red], np.float32)


def recolour_plants(rng, image, ids, plants, crops):
    """All plants of a species share a colour in one field; single plants and leaves deviate."""
    classes = np.array([plant[0] for plant in plants])
    common = _colour_gain(rng, 0.6)
    # Weeds are bluer than the crop on most fields: the mean of (G - B) / (R + G + B) over the labelled
    # plants of four real sets is lower by 0.015 to 0.065. The deviation is larger than the difference,
    # so that the habit decides and not the colour.
    weeds = _colour_gain(rng, 0.25) * np.array([np.exp(rng.normal(0.08, 0.2)), 1.0, 1.0], np.float32)
    species = {c: _colour_gain(rng, 0.4) * (1.0 if c < crops else weeds) for c in set(classes)}
    gains = np.stack([common * species[c] * _colour_gain(rng, 0.3) for c in classes])
    gains = np.clip(gains, 0.35, 2.2)
    greyness = np.clip(rng.normal(-0.05, 0.2, len(plants)), 0.0, 0.5)  # dust, hairs, drought
    soil = np.float32(np.median(image[ids < 0], axis=0) if (ids < 0).any() else 110.0)
    dust = np.where(rng.random(len(plants)) < 0.15, rng.uniform(0.1, 0.5, len(plants)), 0.0)
    red = np.where(rng.random(len(plants)) < 0.08, rng.uniform(0.1, 0.4, len(plants)), 0.0)
    inside = ids >= 0
    which = ids[inside]
    pixels = image[inside] * gains[which]
    luma = pixels @ np.array([0.11, 0.59, 0.30], np.float32)
    pixels += (luma[:, None] - pixels) * greyness[which, None].astype(np.float32)
    pixels += (soil - pixels) * dust[which, None].astype(np.float32)
    pixels[:, 2] *= 1.0 + red[which]
    pixels[:, 1] *= 1.0 - 0.5 * red[which]
    is_crop = classes[which] < crops
    for kind, gloss, relief in ((is_crop, 0.45, 0.6), (~is_crop, 0.35, 0.5)):
        if rng.random() < gloss:  # bright spots on waxy, blistered leaves
            noise = _smooth_noise(rng, ids.shape, rng.uniform(2.5, 7.0)) - rng.uniform(0.8, 1.6)
            shine = np.clip(noise, 0, 2)[inside] * kind
            pixels += (rng.uniform(60, 200) * shine)[:, None].astype(np.float32)
        if rng.random() < relief:  # light and shade between veins
            noise = _smooth_noise(rng, ids.shape, rng.uniform(2.0, 12.0))[inside] * kind
            texture = np.clip(1.0 + rng.uniform(0.05, 0.25) * noise, 0.4, 1.6)
            pixels *= texture[:, None].astype(np.float32)
    image[inside] = pixels
    return image


def recolour_soil(rng, image, ids):
    """Another soil, and patches of moss, moisture or dust. Green patches stay soil."""
    soil = ids < 0
    gain = np.exp(rng.normal(0.0, [0.09, 0.03, 0.07])) * np.exp(rng.normal(0.0, 0.25))
    pixels = image[soil] * gain.astype(np.float32)
    if rng.random() < 0.5:  # rougher or smoother than it was
        mean = cv2.blur(image, (15, 15))[soil] * gain.astype(np.float32)
        pixels = mean + rng.uniform(0.7, 2.2) * (pixels - mean)
    if rng.random() < 0.4:
        patch = np.clip(_smooth_noise(rng, ids.shape, rng.uniform(8, 120)) - 0.3, 0, 1.5)[soil]
        tint = np.exp(rng.normal(0.0, [0.08, 0.03, 0.06])) * np.exp(rng.normal(0.0, 0.15))
        pixels *= 1.0 + patch[:, None] * (tint - 1.0).astype(np.float32)
    image[soil] = pixels
    return image


def cast_shadows(rng, image, ids):
    """Of the plants, with hard edges, on the soil and on lower leaves."""
    length, angle = rng.uniform(3, 45), rng.uniform(0, 2 * np.pi)
    du, dv = length * np.cos(angle), length * np.sin(angle)
    plant = (ids >= 0).astype(np.uint8)
    shadow = np.zeros_like(plant)
    for share in np.linspace(0.1, 1.0, int(length / 4) + 3):
        move = np.float32([[1, 0, du * share], [0, 1, dv * share]])
        shadow |= cv2.warpAffine(plant, move, plant.shape[::-1], flags=cv2.INTER_NEAREST)
    shadow[plant > 0] = 0
    soft = cv2.GaussianBlur(shadow.astype(np.float32), (0, 0), rng.uniform(0.5, 1.5))
    return image * (1.0 - soft * rng.uniform(0.3, 0.92))[..., None]


def large_shadow(rng, image):
    """Of the robot or its tools: a polygon that darkens all below it."""
    height, width = image.shape[:2]
    centre = rng.uniform(-0.2, 1.2, 2) * [width, height]
    angles = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(3, 7)))
    radius = rng.uniform(0.2, 0.9, len(angles)) * width * 0.6
    corners = centre + radius[:, None] * np.stack([np.cos(angles), np.sin(angles)], 1)
    shade = np.zeros((height, width), np.float32)
    cv2.fillPoly(shade, [np.round(corners).astype(np.int32)], 1.0)
    shade = cv2.GaussianBlur(shade, (0, 0), rng.uniform(0.6, 4.0))
    return image * (1.0 - shade * rng.uniform(0.3, 0.85))[..., None]


def scatter_objects(rng, image, ids):
    """Stones, straw, sticks, labels and specks of any colour but a leaf's. They lie on the soil, and
    some on leaves."""
    height, width = ids.shape
    layer = np.zeros((height, width), np.uint8)
    painted = image.copy()
    mean = image.reshape(-1, 3).mean(0)
    for _ in range(int(rng.exponential(10.0)) + 1):
        u, v = rng.uniform(0, width), rng.uniform(0, height)
        kind = rng.random()
        if kind < 0.6:  # stone
            axes = rng.uniform(1.0, 3.0) * np.exp(rng.normal(0.6, 0.6)) * rng.uniform(0.6, 1.0, 2)
            colour = mean * np.exp(rng.normal(0.3, 0.45)) * np.exp(rng.normal(0.0, 0.08, 3))
            shape = ((u, v), (2 * axes[0] + 1, 2 * axes[1] + 1), rng.uniform(0, 180))
            lit = ((u - 0.25 * axes[0], v - 0.25 * axes[1]), (axes[0] + 1, axes[1] + 1), shape[2])
            cv2.ellipse(painted, shape, [float(c) for c in colour], -1)
            cv2.ellipse(painted, lit, [float(c) for c in colour * rng.uniform(0.9, 1.4)], -1)
            cv2.ellipse(layer, shape, 1, -1)
        else:  # straw, stick, cable
            angle, length = rng.uniform(0, np.pi), rng.exponential(25.0) + 4.0
            ends = [(int(u), int(v)), (int(u + length * np.cos(angle)), int(v + length * np.sin(angle)))]
            straw = np.array([110, 170, 190], np.float32) * rng.uniform(0.3, 1.4)
            if rng.random() < 0.1:
                straw = rng.uniform(0, 255, 3) * [1.0, 0.6, 1.0]
            thickness = int(rng.integers(1, 4))
            cv2.line(painted, *ends, [float(c) for c in straw], thickness, cv2.LINE_AA)
            cv2.line(layer, *ends, 1, thickness)
    on_leaves = rng.random() < 0.3
    over = (layer > 0) & ((ids < 0) | on_leaves)
    image = np.where(over[..., None], painted, image)
    return image, np.where(over & (ids >= 0), data.SOIL, ids)


def robot_part(rng, image, ids):
    """A wheel, a bar or a tool at the image's edge. It hides what is below it."""
    height, width = ids.shape
    layer = np.zeros((height, width), np.uint8)
    painted = image.copy()
    u = rng.choice([rng.uniform(-0.05, 0.12), rng.uniform(0.88, 1.05)]) * width
    v = rng.uniform(0, height)
    axes = rng.uniform(0.06, 0.28, 2) * width
    base = np.full(3, rng.uniform(10, 150), np.float32) * rng.uniform(0.8, 1.2, 3)
    bright = rng.uniform(0, 255, 3) * [1.0, 0.5, 1.0]
    if rng.random() < 0.6:
        shape = ((u, v), (2 * axes[0], 2 * axes[1]), rng.uniform(-15, 15))
        cv2.ellipse(painted, shape, [float(c) for c in base], -1)
        cv2.ellipse(layer, shape, 1, -1)
        cv2.ellipse(painted, ((u, v), (axes[0], 1.2 * axes[1]), shape[2]), [float(c) for c in bright], -1)
    else:
        box = cv2.boxPoints(((u, v), (2 * axes[0], rng.uniform(0.3, 1.5) * height), rng.uniform(-20, 20)))
        cv2.fillPoly(painted, [np.round(box).astype(np.int32)], [float(c) for c in base])
        cv2.fillPoly(layer, [np.round(box).astype(np.int32)], 1)
    light = 1.0 + 0.3 * _smooth_noise(rng, ids.shape, 12.0)
    painted = np.where(layer[..., None] > 0, painted * np.clip(light, 0.3, 1.8)[..., None], painted)
    return painted, np.where(layer > 0, data.SOIL, ids)


def camera(rng, image):
    """Sharpness, exposure, response curve, white balance, noise and compression."""
    height, width = image.shape[:2]
    if rng.random() < 0.5:  # a coarser sensor than the network's resolution
        factor = np.exp(rng.uniform(0.0, np.log(2.2)))
        small = (max(16, int(width / factor)), max(16, int(height / factor)))
        small_image = cv2.resize(image, small, interpolation=cv2.INTER_AREA)
        small_image = _develop(rng, small_image)
        image = cv2.resize(small_image, (width, height), interpolation=cv2.INTER_LINEAR)
    else:
        image = _develop(rng, image)
    return np.clip(image + 0.5, 0, 255).astype(np.uint8)


def _develop(rng, image):
    if rng.random() < 0.2:
        length = int(rng.integers(2, 7))
        kernel = np.zeros((length, length), np.float32)
        if rng.random() < 0.5:
            kernel[:, length // 2] = 1.0 / length
        else:
            kernel[length // 2] = 1.0 / length
        image = cv2.filter2D(image, -1, kernel)
    if rng.random() < 0.25:
        image = cv2.GaussianBlur(image, (0, 0), rng.uniform(0.3, 1.3))
    if rng.random() < 0.3:
        image = image + rng.uniform(0.3, 1.5) * (image - cv2.GaussianBlur(image, (0, 0), rng.uniform(0.7, 1.6)))
    image = np.clip(image, 0, 400) / 255.0
    if rng.random() < 0.8:
        image = image ** np.float32(np.exp(rng.normal(0.0, 0.22)))
    exposure = np.exp(rng.normal(0.1, 0.3)) if rng.random() < 0.82 else np.exp(rng.uniform(-2.0, 0.8))
    image = image * np.float32(exposure) * np.exp(rng.normal(0.0, [0.07, 0.03, 0.07])).astype(np.float32)
    luma = image @ np.array([0.11, 0.59, 0.30], np.float32)
    image = luma[..., None] + (image - luma[..., None]) * np.float32(rng.uniform(0.45, 1.2))
    if rng.random() < 0.4:  # shoulder and black level of the sensor's curve
        image = np.clip(image - rng.uniform(-0.06, 0.06), 0, None)
        image = image / (1.0 + rng.uniform(0.0, 0.6) * image)
    image = np.clip(image, 0, 1) * 255.0
    if rng.random() < 0.6:
        deviation = rng.uniform(0.5, 7.0)
        noise = rng.standard_normal(image.shape, np.float32) * np.float32(deviation)
        image = image + noise * (0.5 + image / 255.0)
    if rng.random() < 0.5:
        quality = [int(cv2.IMWRITE_JPEG_QUALITY), int(rng.integers(35, 96))]
        _, coded = cv2.imencode(".jpg", np.clip(image, 0, 255).astype(np.uint8), quality)
        image = cv2.imdecode(coded, cv2.IMREAD_COLOR).astype(np.float32)
    return image
