#!/usr/bin/env python3
"""Trains the one-stage network on a COCO data set and exports it for the detector.

  furrow dataset render DATA --set images=900
  train_one_stage.py DATA --out MODEL_FOLDER
  train_one_stage.py OWN_DATA --out MODEL_FOLDER --start MODEL_FOLDER/one_stage.pt   # fine-tuning

DATA holds train.json and validation.json. Needs Debian's python3-torch, python3-onnx,
python3-opencv and libopenblas0-pthread. Uses a GPU where torch finds one.
"""

import argparse
import copy
import hashlib
import json
import pathlib
import time

import cv2
import numpy as np
import torch

import augment
import data
import one_stage


class Samples(torch.utils.data.Dataset):
    """Crops of the training images, augmented; the random numbers depend on seed, epoch and index."""

    def __init__(self, coco, size, seed):
        self.coco, self.size, self.seed, self.epoch = coco, size, seed, 0

    def __len__(self):
        return len(self.coco)

    def __getitem__(self, i):
        rng = np.random.default_rng((self.seed, self.epoch, i))
        image, ids, plants = augment.crop_and_turn(rng, *self.coco.load(i), self.size)
        image = augment.photometric(rng, image)
        return (to_tensor(image), *map(torch.from_numpy, data.targets(ids, plants)))


def to_tensor(bgr):
    return torch.from_numpy(np.ascontiguousarray(bgr.transpose(2, 0, 1))).float() / 255.0


@torch.no_grad()
def validate(model, coco, crops, device, limit=120):
    """IoU of vegetation, crop and weed at the output's stride, and the stems that were found."""
    model.eval()
    intersection, union = np.zeros(3), np.zeros(3)
    found, total = 0, 0
    for i in range(0, len(coco), -(-len(coco) // limit)):
        image, ids, plants = coco.load(i)
        height, width = ids.shape[0] // 32 * 32, ids.shape[1] // 32 * 32
        share, classes, _, _ = data.targets(ids[:height, :width], plants)
        output = model(to_tensor(image[:height, :width])[None].to(device))[0].cpu().numpy()
        plant = output[0] > 0
        probability = np.exp(output[4:] - output[4:].max(0))
        crop = probability[:crops].sum(0) > probability[crops:].sum(0)
        truth_plant, truth_crop = share > 0.5, (classes >= 0) & (classes < crops)
        pairs = ((truth_plant, plant), (truth_plant & truth_crop, plant & crop),
                 (truth_plant & ~truth_crop, plant & ~crop))
        for k, (truth, predicted) in enumerate(pairs):
            intersection[k] += (truth & predicted).sum()
            union[k] += (truth | predicted).sum()
        peaks = _peaks(output[1])
        for _, u, v in plants:
            if not (8 <= u < width - 8 and 8 <= v < height - 8):
                continue
            total += 1
            if len(peaks) and np.hypot(peaks[:, 0] - u, peaks[:, 1] - v).min() <= 10:
                found += 1
    iou = intersection / np.maximum(union, 1)
    return {"iou_vegetation": iou[0], "iou_crop": iou[1], "iou_weed": iou[2],
            "stem_recall_10px": found / max(total, 1)}


def _peaks(logits, threshold=-0.4):
    highest = cv2.dilate(logits, np.ones((3, 3), np.uint8))
    v, u = np.nonzero((logits >= highest) & (logits > threshold))
    return np.stack([(u + 0.5) * data.STRIDE - 0.5, (v + 0.5) * data.STRIDE - 0.5], 1)


def class_weights(coco, limit=200):
    """Inverse square root of each class's pixels, so that small weeds count beside large crops."""
    pixels = np.ones(len(coco.classes))
    for i in range(0, len(coco), max(len(coco) // limit, 1)):
        _, ids, plants = coco.load(i)
        counts = np.bincount(ids[ids >= 0], minlength=len(plants))
        for (class_index, _, _), count in zip(plants, counts):
            pixels[class_index] += count
    weights = 1 / np.sqrt(pixels)
    return torch.tensor(weights / weights.mean(), dtype=torch.float32)


def export(model, classes, out, resolution_mm_per_px):
    model = copy.deepcopy(model).eval().cpu()
    file = out / "one_stage.onnx"
    torch.onnx.export(model, torch.zeros(1, 3, 480, 640), str(file), opset_version=11,
                      input_names=["image"], output_names=["output"],
                      dynamic_axes={"image": {2: "height", 3: "width"},
                                    "output": {2: "height4", 3: "width4"}})
    content = file.read_bytes()
    lines = ["# Written by train_one_stage.py beside the network.", "name: one_stage",
             "network: one_stage.onnx", f"network_bytes: {len(content)}",
             f"network_sha256: {hashlib.sha256(content).hexdigest()}", f"stride: {data.STRIDE}",
             f"offset_unit_px: {data.OFFSET_UNIT_PX}",
             f"ground_resolution_mm_per_px: {resolution_mm_per_px}", "classes:"]
    lines += [f"  - {{name: {name}, kind: {kind}}}" for name, kind in classes]
    (out / "one_stage.yaml").write_text("\n".join(lines) + "\n")


def plot(log, file):
    """Curves over the epochs as a picture."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4))
    epochs = [row["epoch"] for row in log]
    for name in ("plant", "stem", "offset", "class"):
        left.plot(epochs, [row[name] for row in log], label=name)
    for name in ("iou_vegetation", "iou_crop", "iou_weed", "stem_recall_10px"):
        right.plot(epochs, [row[name] for row in log], label=name)
    left.set(title="training loss", xlabel="epoch", yscale="log")
    right.set(title="validation", xlabel="epoch", ylim=(0, 1))
    for axes in (left, right):
        axes.legend()
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(file, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--start", type=pathlib.Path, help="weights to go on from")
    parser.add_argument("--epochs", type=int, default=12)
    parser.add_argument("--minutes", type=float, help="stop after the epoch that passes this time")
    parser.add_argument("--batch", type=int, default=8)
    parser.add_argument("--size", type=int, default=384)
    parser.add_argument("--rate", type=float, default=2e-3)
    parser.add_argument("--width", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--resolution", type=float, default=1.15, help="mm per px of the images")
    arguments = parser.parse_args()

    torch.manual_seed(arguments.seed)
    torch.set_num_threads(arguments.threads)
    cv2.setNumThreads(1)
    device = "cuda" if torch.cuda.is_available() else "cpu"
    checkpoint = torch.load(arguments.start) if arguments.start else None
    train = data.CocoSet(arguments.data / "train.json",
                         [tuple(c) for c in checkpoint["classes"]] if checkpoint else None)
    validation = data.CocoSet(arguments.data / "validation.json", train.classes)
    crops = sum(kind == "crop" for _, kind in train.classes)
    model = one_stage.OneStage(len(train.classes), arguments.width).to(device)
    if checkpoint:
        model.load_state_dict(checkpoint["model"])
    # The mean over the last two hundred steps is what is kept: it is steadier than any one of them.
    average = torch.optim.swa_utils.AveragedModel(
        model, avg_fn=lambda mean, new, _: 0.995 * mean + 0.005 * new, use_buffers=True)
    weights = class_weights(train).to(device)
    arguments.out.mkdir(parents=True, exist_ok=True)

    samples = Samples(train, arguments.size, arguments.seed)
    generator = torch.Generator().manual_seed(arguments.seed)
    loader = torch.utils.data.DataLoader(samples, arguments.batch, shuffle=True, drop_last=True,
                                         generator=generator)
    optimizer = torch.optim.AdamW(model.parameters(), lr=arguments.rate, weight_decay=1e-4)
    schedule = torch.optim.lr_scheduler.OneCycleLR(
        optimizer, arguments.rate, epochs=arguments.epochs, steps_per_epoch=len(loader), pct_start=0.15)
    start, log, best = time.time(), [], -1.0
    for epoch in range(arguments.epochs):
        samples.epoch = epoch
        sums, steps = {}, 0
        for image, *maps in loader:
            total, parts = one_stage.loss(model(image.to(device)), *[m.to(device) for m in maps], weights)
            optimizer.zero_grad()
            total.backward()
            torch.nn.utils.clip_grad_norm_(model.parameters(), 5.0)
            optimizer.step()
            schedule.step()
            average.update_parameters(model)
            steps += 1
            for name, value in parts.items():
                sums[name] = sums.get(name, 0.0) + float(value)
        row = {"epoch": epoch, "minutes": (time.time() - start) / 60,
               **{name: value / steps for name, value in sums.items()},
               **validate(average.module, validation, crops, device)}
        log.append(row)
        print(json.dumps({k: round(v, 4) for k, v in row.items()}), flush=True)
        score = row["iou_crop"] + row["iou_weed"] + row["stem_recall_10px"]
        if score > best:
            best = score
            torch.save({"model": average.module.state_dict(), "classes": train.classes,
                        "width": arguments.width}, arguments.out / "one_stage.pt")
            export(average.module, train.classes, arguments.out, arguments.resolution)
        (arguments.out / "log.json").write_text(json.dumps(log, indent=1))
        plot(log, arguments.out / "curves.png")
        if arguments.minutes and row["minutes"] > arguments.minutes:
            break


if __name__ == "__main__":
    main()
