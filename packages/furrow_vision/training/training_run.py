"""What both trainings share: options, data, the rate of learning, the log and its picture."""

import argparse
import json
import math
import pathlib
import time

import cv2
import numpy as np
import torch

import augment
import data
import domain_randomisation
import painted_plants


# Ground resolution of `furrow dataset render`.
RENDERED_MM_PER_PX = 1.15


def parser(description, batch, size, rate):
    """The options of both; the caller adds its own."""
    options = argparse.ArgumentParser(description=description)
    options.add_argument("data", type=pathlib.Path, nargs="+",
                         help="folders of train.json and validation.json; their images are put together")
    options.add_argument("--out", type=pathlib.Path, required=True, help="folder of the model")
    options.add_argument("--start", type=pathlib.Path, help="weights (.pt) to go on from")
    options.add_argument("--epochs", type=int, default=12)
    options.add_argument("--minutes", type=float, help="at most")
    options.add_argument("--batch", type=int, default=batch)
    options.add_argument("--size", type=int, default=size, help="px a side of the crops")
    options.add_argument("--rate", type=float, default=rate, help="of learning, at its highest")
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--threads", type=int, default=2)
    options.add_argument("--resolution", type=float,
                         help="mm per px of the images; default: that of the model file beside --start, "
                              f"without --start {RENDERED_MM_PER_PX}, which is that of rendered sets")
    options.add_argument("--randomise", type=float, default=0.0, metavar="SHARE",
                         help="share of the crops that domain_randomisation.py changes, also in scale "
                              "and direction")
    options.add_argument("--painted", type=float, default=0.0, metavar="SHARE",
                         help="share of the randomised crops that get plants of painted_plants.py")
    return options


def ground_resolution(given, start):
    """mm per px of the training images: as given, else that of the model file beside the start."""
    if given is not None:
        if not given > 0:
            raise SystemExit(f"--resolution {given}: must be above 0 mm per px")
        return given
    if start is None:
        return RENDERED_MM_PER_PX
    key = "ground_resolution_mm_per_px:"
    for file in sorted(start.parent.glob("*.yaml")):
        lines = [line for line in file.read_text().splitlines() if line.startswith(key)]
        if lines and file.stem == start.stem:
            return float(lines[0].removeprefix(key))
    raise SystemExit(f"{start}: no {start.stem}.yaml with {key[:-1]} beside it; "
                     "give the resolution of the training images by --resolution")


def average_decay(updates):
    """Share of the average that an update keeps: .995 in the long run, less at first. A mean of
    fixed decay would keep most of the starting weights in a training of few steps."""
    updates = float(updates)
    return min(0.995, (1.0 + updates) / (10.0 + updates))


def average_of(mean, new, updates):
    """The average of torch's AveragedModel after one more update."""
    keep = average_decay(updates)
    # Counters of batches are integers.
    return (keep * mean + (1.0 - keep) * new).to(mean.dtype)


def prepare(arguments):
    """Sets seeds, threads and the resolution, makes the folder; returns the device."""
    arguments.resolution = ground_resolution(arguments.resolution, arguments.start)
    print(f"training images are taken as having {arguments.resolution:g} mm per px", flush=True)
    torch.manual_seed(arguments.seed)
    torch.set_num_threads(arguments.threads)
    cv2.setNumThreads(1)
    arguments.out.mkdir(parents=True, exist_ok=True)
    return "cuda" if torch.cuda.is_available() else "cpu"


def load_sets(arguments, classes=None):
    """Training and validation set, and how many of the classes are crops."""
    train = data.CocoSet([folder / "train.json" for folder in arguments.data], classes)
    validation = data.CocoSet([folder / "validation.json" for folder in arguments.data],
                              train.classes, memory_bytes=1 << 30)
    return train, validation, sum(kind == "crop" for _, kind in train.classes)


class Samples(torch.utils.data.Dataset):
    """Crops of the training images, augmented, as `make` turns them into tensors. The random numbers
    depend on seed, epoch and index. `randomise` is the share that gets domain randomisation, and
    `painted` the share of these that gets painted plants."""

    EPOCHS_PER_POOL = 4

    def __init__(self, coco, size, seed, make, randomise=0.0, painted=0.0):
        self.coco, self.size, self.seed, self.make, self.epoch = coco, size, seed, make, 0
        self.randomise, self.painted, self.pool = randomise, painted, (None, None)
        self.crops = sum(kind == "crop" for _, kind in coco.classes)

    def __len__(self):
        return len(self.coco)

    def __getitem__(self, i):
        rng = np.random.default_rng((self.seed, self.epoch, i))
        if self.randomise == 0.0 or rng.random() >= self.randomise:
            image, ids, plants = augment.crop_and_turn(rng, *self.coco.load(i), self.size)
            return self.make(augment.photometric(rng, image), ids, plants)
        image, ids, plants = augment.crop_and_turn(rng, *self.coco.load(i), self.size, (0.6, 1.7))
        image, ids, plants = augment.quarter_turn(rng, image, ids, plants)
        if rng.random() < self.painted:
            image, ids, plants = painted_plants.add(rng, image, ids, plants, self._pool(),
                                                    self.coco.classes)
        image, ids = domain_randomisation.randomise(rng, image, ids, plants, self.crops)
        return self.make(image, ids, plants)

    def _pool(self):
        number = self.epoch // self.EPOCHS_PER_POOL
        if self.pool[0] != number:
            self.pool = (number, painted_plants.Pool((self.seed, number)))
        return self.pool[1]


def loader(samples, arguments, collate=None):
    """Whole batches in an order that the seed fixes."""
    if len(samples) < arguments.batch:
        raise SystemExit(f"{len(samples)} labelled images are fewer than --batch {arguments.batch}")
    generator = torch.Generator().manual_seed(arguments.seed)
    return torch.utils.data.DataLoader(samples, arguments.batch, shuffle=True, drop_last=True,
                                       generator=generator, collate_fn=collate)


def to_tensor(bgr):
    return torch.from_numpy(np.ascontiguousarray(bgr.transpose(2, 0, 1))).float() / 255.0


def class_weights(coco, limit=200):
    """Inverse square root of each class's pixels, so that small weeds count beside large crops. The
    mean is 1 over the classes that occur. One that does not occur has 1: it must not set the scale."""
    pixels = np.zeros(len(coco.classes))
    for i in range(0, len(coco), max(len(coco) // limit, 1)):
        _, ids, plants = coco.load(i)
        counts = np.bincount(ids[ids >= 0], minlength=len(plants))
        for (class_index, _, _), count in zip(plants, counts):
            pixels[class_index] += count
    weights, seen = np.ones(len(pixels)), pixels > 0
    if not seen.any():
        raise SystemExit("the training images show no plant of any class")
    weights[seen] = 1 / np.sqrt(pixels[seen])
    weights[seen] /= weights[seen].mean()
    absent = [name for (name, _), there in zip(coco.classes, seen) if not there]
    if absent:
        print(f"classes without a pixel in training: {', '.join(absent)}", flush=True)
    return torch.tensor(weights, dtype=torch.float32)


class Checkpoint:
    """The state of a training, written after each epoch, so that it can be stopped and gone on with.
    `parts` have state_dict() and load_state_dict()."""

    def __init__(self, file, parts, progress, samples):
        self.file, self.parts, self.progress, self.samples = file, parts, progress, samples

    def save(self):
        state = {name: part.state_dict() for name, part in self.parts.items()}
        state.update(steps=self.progress.steps, minutes=self.progress.minutes(), epoch=self.samples.epoch)
        temporary = self.file.with_suffix(".new")
        torch.save(state, temporary)
        temporary.replace(self.file)

    def resume(self):
        """Returns the first epoch that is still to be done."""
        if not self.file.exists():
            return 0
        state = torch.load(self.file, map_location="cpu")
        for name, part in self.parts.items():
            part.load_state_dict(state[name])
        self.progress.steps = state["steps"]
        self.progress.start = time.time() - 60 * state["minutes"]
        print(f"{self.file}: {state['steps']} steps, {state['minutes']:.1f} minutes are done", flush=True)
        return state["epoch"] + 1


class Progress:
    """How far a training is, by its steps or by its time, whichever is nearer the end."""

    WARM_UP_STEPS = 100

    def __init__(self, arguments, steps_per_epoch):
        self.highest_rate, self.minutes_at_most = arguments.rate, arguments.minutes
        self.steps_at_most = arguments.epochs * steps_per_epoch
        self.start, self.steps = time.time(), 0

        if self.steps_at_most < self.WARM_UP_STEPS:
            print(f"warning: {arguments.epochs} epochs are {self.steps_at_most} steps; below "
                  f"{self.WARM_UP_STEPS} the rate does not reach --rate: give more --epochs", flush=True)

    def minutes(self):
        return (time.time() - self.start) / 60

    def share(self):
        done = self.steps / self.steps_at_most
        if self.minutes_at_most:
            done = max(done, self.minutes() / self.minutes_at_most)
        return min(done, 1.0)

    def done(self):
        return self.share() >= 1.0

    def set_rate(self, optimizer):
        """A short rise, then half a cosine (Loshchilov and Hutter 2017)."""
        rise = min(self.steps / self.WARM_UP_STEPS + 0.01, 1.0)
        fall = 0.01 + 0.5 * (1 + math.cos(math.pi * self.share()))
        for group in optimizer.param_groups:
            group["lr"] = self.highest_rate * min(rise, fall)


class Log:
    """One row an epoch: printed, written as JSON, drawn as curves."""

    def __init__(self, folder, prefix, losses, scores):
        self.folder, self.prefix, self.losses, self.scores, self.rows = folder, prefix, losses, scores, []

    def add(self, row):
        self.rows.append(row)
        print(json.dumps({name: round(value, 4) for name, value in row.items()}), flush=True)
        (self.folder / f"{self.prefix}log.json").write_text(json.dumps(self.rows, indent=1))
        self._plot(self.folder / f"{self.prefix}curves.png")

    def _plot(self, file):
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4))
        epochs = [row["epoch"] for row in self.rows]
        for axes, names in ((left, self.losses), (right, self.scores)):
            for name in names:
                axes.plot(epochs, [row[name] for row in self.rows], label=name, marker=".")
        left.set(title="training loss", xlabel="epoch", yscale="log")
        right.set(title="validation", xlabel="epoch", ylim=(0, 1))
        for axes in (left, right):
            axes.legend()
            axes.grid(alpha=0.3)
        figure.tight_layout()
        figure.savefig(file, dpi=110)
        pyplot.close(figure)
