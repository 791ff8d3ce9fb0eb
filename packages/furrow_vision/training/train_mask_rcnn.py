#!/usr/bin/env python3
"""Trains the slim Mask R-CNN on a COCO data set and exports its three parts for the detector.

  furrow dataset render DATA --set images=1600
  train_mask_rcnn.py DATA --out MODEL_FOLDER --backbone MODEL_FOLDER/one_stage.pt
  train_mask_rcnn.py OWN_DATA --out OWN_MODEL --start MODEL_FOLDER/mask_rcnn.pt   # fine-tuning

DATA holds train.json and validation.json. Needs Debian's python3-torch, python3-torchvision,
python3-onnx, python3-opencv, python3-matplotlib and libopenblas0-pthread. Uses a GPU where torch
finds one. With --epochs alone the same seed gives the same weights; --minutes bounds the time
instead, and the rate of learning falls with whichever is nearer its end.
"""

import hashlib
import math
import pathlib

import numpy as np
import torch

import mask_rcnn
import training_run
from training_run import to_tensor

LEAST_VISIBLE_PX = 12
LOSSES = ["objectness", "proposal", "plant", "class", "box", "stem", "mask", "kind"]
SCORES = ["precision", "recall", "class_right"]


def make_sample(image, ids, plants):
    return to_tensor(image), targets(ids, plants)


def targets(ids, plants):
    """What the network learns of one image: boxes, labels, masks and stems of what can be seen."""
    boxes, labels, masks, stems = [], [], [], []
    for i, (label, u, v) in enumerate(plants):
        mask = ids == i
        if mask.sum() < LEAST_VISIBLE_PX:
            continue
        rows, columns = np.where(mask.any(1))[0], np.where(mask.any(0))[0]
        boxes.append([columns[0], rows[0], columns[-1] + 1, rows[-1] + 1])
        labels.append(label)
        masks.append(mask)
        stems.append([u + 0.5, v + 0.5])
    return {"boxes": torch.tensor(boxes, dtype=torch.float32).reshape(-1, 4),
            "labels": torch.tensor(labels, dtype=torch.long),
            "masks": torch.from_numpy(np.array(masks, np.float32).reshape(-1, *ids.shape)),
            "stems": torch.tensor(stems, dtype=torch.float32).reshape(-1, 2)}


def collate(samples):
    images, wanted = zip(*samples)
    return torch.stack(images), list(wanted)


@torch.no_grad()
def validate(model, coco, crops, device, limit=60):
    """Precision and recall of boxes at IoU 0.5, how often a plant found is rightly crop or weed, and
    the median distance of its stem."""
    model.eval()
    truths, found, right, alike, off = 0, 0, 0, 0, []
    for i in range(0, len(coco), -(-len(coco) // limit)):
        image, ids, plants = coco.load(i)
        height, width = ids.shape[0] // 32 * 32, ids.shape[1] // 32 * 32
        wanted = targets(ids[:height, :width], plants)
        image = to_tensor(image[:height, :width])
        boxes, _, labels, stems = [x.cpu() for x in model.detect(image.to(device))]
        truths, found = truths + len(wanted["boxes"]), found + len(boxes)
        if len(boxes) == 0 or len(wanted["boxes"]) == 0:
            continue
        overlap = mask_rcnn.box_iou(boxes, wanted["boxes"])
        taken = set()
        for k in range(len(boxes)):
            best = int(overlap[k].argmax())
            if overlap[k, best] < 0.5 or best in taken:
                continue
            taken.add(best)
            right += 1
            alike += int((labels[k] < crops) == (wanted["labels"][best] < crops))
            off.append(float((stems[k] - wanted["stems"][best]).norm()))
    model.train()
    return {"precision": right / max(found, 1), "recall": right / max(truths, 1),
            "class_right": alike / max(right, 1), "stem_px": float(np.median(off)) if off else math.nan}


def write_part(module, example, file, inputs, outputs, axes):
    module.eval().cpu()
    torch.onnx.export(module, example, str(file), opset_version=11, input_names=inputs,
                      output_names=outputs, dynamic_axes=axes)
    content = file.read_bytes()
    return [f"{file.stem[len('mask_rcnn_'):]}: {file.name}",
            f"{file.stem[len('mask_rcnn_'):]}_bytes: {len(content)}",
            f"{file.stem[len('mask_rcnn_'):]}_sha256: {hashlib.sha256(content).hexdigest()}"]


def export(model, classes, out, resolution_mm_per_px):
    levels, channels = range(len(mask_rcnn.STRIDES)), mask_rcnn.CHANNELS
    names = [f"{kind}_{i}" for kind in ("features", "objectness", "deltas") for i in levels]
    lines = ["# Written by train_mask_rcnn.py beside the networks.", "kind: mask_rcnn",
             "name: mask_rcnn", f"ground_resolution_mm_per_px: {resolution_mm_per_px}",
             f"feature_levels: {len(levels)}", "stems: true",
             f"anchors: {{sizes_px: {list(mask_rcnn.ANCHOR_SIZES)}, "
             f"strides_px: {list(mask_rcnn.STRIDES)}, aspect_ratios: {list(mask_rcnn.ASPECT_RATIOS)}}}"]
    lines += write_part(mask_rcnn.ExportedBackbone(model), torch.zeros(1, 3, 480, 640),
                        out / "mask_rcnn_backbone.onnx", ["image"], names,
                        {name: {2: f"h_{name}", 3: f"w_{name}"} for name in ["image", *names]})
    regions = ["regions"]
    batch = {0: "n"}
    cells = mask_rcnn.BOX_CELLS
    outputs = ["class_logits", "box_deltas", "stems"]
    lines += write_part(mask_rcnn.ExportedBoxHead(model.box_head), torch.zeros(2, channels, cells, cells),
                        out / "mask_rcnn_box_head.onnx", regions, outputs,
                        {name: batch for name in regions + outputs})
    cells = mask_rcnn.MASK_CELLS
    lines += write_part(model.mask_head, torch.zeros(2, channels, cells, cells),
                        out / "mask_rcnn_mask_head.onnx", regions, ["mask_logits"],
                        {name: batch for name in regions + ["mask_logits"]})
    lines += ["classes:"] + [f"  - {{name: {name}, kind: {kind}}}" for name, kind in classes]
    (out / "mask_rcnn.yaml").write_text("\n".join(lines) + "\n")


def start_from(model, arguments, classes):
    """Weights of an earlier training: all of them, or those of a one-stage network's backbone."""
    if arguments.start:
        checkpoint = torch.load(arguments.start, map_location="cpu")
        weights = checkpoint["model"]
        if [tuple(c) for c in checkpoint["classes"]] != [tuple(c) for c in classes]:
            # Other classes: all but what tells them apart is kept.
            weights = {k: w for k, w in weights.items() if not k.startswith("box_head.sub_class")}
        model.load_state_dict(weights, strict=False)
    elif arguments.backbone:
        weights = torch.load(arguments.backbone, map_location="cpu")["model"]
        body = {k: w for k, w in weights.items() if k.startswith("down")}
        missing, unknown = model.backbone.load_state_dict(body, strict=False)
        if unknown or any(k.startswith("down") for k in missing):
            raise SystemExit(f"{arguments.backbone}: its backbone is another one")


def main():
    parser = training_run.parser(__doc__.split("\n")[0], batch=4, size=320, rate=1e-3)
    parser.add_argument("--backbone", type=pathlib.Path, help="one_stage.pt whose backbone is taken")
    parser.add_argument("--heads-only", action="store_true", help="leave backbone and proposals alone")
    arguments = parser.parse_args()
    device = training_run.prepare(arguments)
    train, validation, crops = training_run.load_sets(arguments)
    model = mask_rcnn.MaskRcnn(len(train.classes))
    start_from(model, arguments, train.classes)
    model.to(device)
    weights = training_run.class_weights(train).to(device)
    samples = training_run.Samples(train, arguments.size, arguments.seed, make_sample)
    loader = training_run.loader(samples, arguments, collate)
    if arguments.heads_only:
        model.train_heads_only()
    learning = [weight for weight in model.parameters() if weight.requires_grad]
    optimizer = torch.optim.AdamW(learning, lr=arguments.rate, weight_decay=1e-4)
    progress = training_run.Progress(arguments, len(loader))
    losses = LOSSES if 0 < crops < len(train.classes) else LOSSES[:-1]
    log = training_run.Log(arguments.out, "mask_rcnn_", losses, SCORES)
    for epoch in range(arguments.epochs):
        samples.epoch = epoch
        sums, first = {}, progress.steps
        if arguments.heads_only:
            model.backbone.eval()
        for images, wanted in loader:
            progress.set_rate(optimizer)
            wanted = [{k: t.to(device) for k, t in w.items()} for w in wanted]
            total, parts = model.loss(images.to(device), wanted, weights, crops)
            optimizer.zero_grad()
            total.backward()
            torch.nn.utils.clip_grad_norm_(learning, 5.0)
            optimizer.step()
            progress.steps += 1
            for name, value in parts.items():
                sums[name] = sums.get(name, 0.0) + float(value)
            if progress.steps % 50 == 0:
                print(f"step {progress.steps}: {60 * progress.minutes() / progress.steps:.2f} s a step, "
                      f"loss {float(total):.3f}", flush=True)
            if progress.done():
                break
        log.add({"epoch": epoch, "minutes": progress.minutes(),
                 **{name: value / (progress.steps - first) for name, value in sums.items()},
                 **validate(model, validation, crops, device)})
        torch.save({"model": model.state_dict(), "classes": train.classes}, arguments.out / "mask_rcnn.pt")
        if progress.done():
            break
    export(model, train.classes, arguments.out, arguments.resolution)


if __name__ == "__main__":
    main()
