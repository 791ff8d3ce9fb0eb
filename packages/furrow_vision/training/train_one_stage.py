#!/usr/bin/env python3
"""Trains the one-stage network on a COCO data set and exports it for the detector.

  furrow dataset render DATA --set images=900
  train_one_stage.py DATA --out MODEL_FOLDER
  train_one_stage.py OWN_DATA --out MODEL_FOLDER --start MODEL_FOLDER/one_stage.pt   # fine-tuning

DATA holds train.json and validation.json. Needs Debian's python3-torch, python3-onnx,
python3-opencv and libopenblas0-pthread. Uses a GPU where torch finds one.
"""

import copy
import hashlib

import cv2
import numpy as np
import torch

import data
import one_stage
import training_run
from training_run import to_tensor

LOSSES = ["plant", "stem", "offset", "class", "kind"]
SCORES = ["iou_vegetation", "iou_crop", "iou_weed", "stem_recall_10px"]


def make_sample(image, ids, plants):
    return (to_tensor(image), *map(torch.from_numpy, data.targets(ids, plants)))


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


def main():
    parser = training_run.parser(__doc__.split("\n")[0], batch=8, size=384, rate=2e-3)
    parser.add_argument("--width", type=float, default=1.0, help="factor of the numbers of channels")
    parser.add_argument("--resume", action="store_true",
                        help="go on from checkpoint.pt in --out, which each epoch writes")
    arguments = parser.parse_args()
    device = training_run.prepare(arguments)
    checkpoint = torch.load(arguments.start, map_location="cpu") if arguments.start else None
    train, validation, crops = training_run.load_sets(
        arguments, [tuple(c) for c in checkpoint["classes"]] if checkpoint else None)
    model = one_stage.OneStage(len(train.classes), arguments.width).to(device)
    if checkpoint:
        model.load_state_dict(checkpoint["model"])
    # A mean over at most the last two hundred steps is kept: it is steadier than any one of them.
    average = torch.optim.swa_utils.AveragedModel(model, avg_fn=training_run.average_of, use_buffers=True)
    weights = training_run.class_weights(train).to(device)
    samples = training_run.Samples(train, arguments.size, arguments.seed, make_sample,
                                   arguments.randomise, arguments.painted)
    loader = training_run.loader(samples, arguments)
    optimizer = torch.optim.AdamW(model.parameters(), lr=arguments.rate, weight_decay=1e-4)
    progress = training_run.Progress(arguments, len(loader))
    losses = LOSSES if 0 < crops < len(train.classes) else LOSSES[:-1]
    log, best = training_run.Log(arguments.out, "", losses, SCORES), -1.0
    saved = training_run.Checkpoint(
        arguments.out / "checkpoint.pt",
        {"model": model, "average": average, "optimizer": optimizer}, progress, samples)
    first_epoch = saved.resume() if arguments.resume else 0
    for epoch in range(first_epoch, arguments.epochs):
        samples.epoch = epoch
        sums, first = {}, progress.steps
        for image, *maps in loader:
            progress.set_rate(optimizer)
            total, parts = one_stage.loss(model(image.to(device)), *[m.to(device) for m in maps], weights,
                                          crops)
            optimizer.zero_grad()
            total.backward()
            torch.nn.utils.clip_grad_norm_(model.parameters(), 5.0)
            optimizer.step()
            average.update_parameters(model)
            progress.steps += 1
            for name, value in parts.items():
                sums[name] = sums.get(name, 0.0) + float(value)
            if progress.done():
                break
        row = {"epoch": epoch, "minutes": progress.minutes(),
               **{name: value / (progress.steps - first) for name, value in sums.items()},
               **validate(average.module, validation, crops, device)}
        log.add(row)
        score = row["iou_crop"] + row["iou_weed"] + row["stem_recall_10px"]
        if score > best:
            best = score
            torch.save({"model": average.module.state_dict(), "classes": train.classes,
                        "width": arguments.width}, arguments.out / "one_stage.pt")
            export(average.module, train.classes, arguments.out, arguments.resolution)
        torch.save({"model": average.module.state_dict(), "classes": train.classes,
                    "width": arguments.width}, arguments.out / "last.pt")
        saved.save()
        if progress.done():
            break


if __name__ == "__main__":
    main()
