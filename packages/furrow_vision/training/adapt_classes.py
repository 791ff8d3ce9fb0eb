#!/usr/bin/env python3
"""Makes weights of other classes from trained ones, to start a fine-tuning from.

  adapt_classes.py models/one_stage.pt OWN_DATA --out start.pt
  train_one_stage.py OWN_DATA --start start.pt --out OWN_MODEL

Each crop of OWN_DATA/train.json starts as the mean of the crops of the weights, each weed as the
mean of their weeds. A class of the same name is kept. Works on one_stage.pt and mask_rcnn.pt.
"""

import argparse
import pathlib

import torch

import data

# The last layer's rows for the first class, by the name of its weights.
HEADS = {"head.1.weight": 4, "box_head.sub_class.weight": 0}


def adapt(model, old, new):
    """Replaces the rows of the last layer; `old` and `new` are lists of (name, kind)."""
    weight = next(name for name in HEADS if name in model)
    first = HEADS[weight]
    names = [name for name, _ in old]
    for key in (weight, weight.replace("weight", "bias")):
        rows = model[key].float()
        made = []
        for name, kind in new:
            alike = [i for i, (_, other) in enumerate(old) if other == kind]
            chosen = [names.index(name)] if name in names else alike or list(range(len(old)))
            made.append(rows[[first + i for i in chosen]].mean(0))
        model[key] = torch.cat([rows[:first], torch.stack(made)])
    return model


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("weights", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    checkpoint = torch.load(arguments.weights, map_location="cpu")
    old = [tuple(c) for c in checkpoint["classes"]]
    new = data.CocoSet(arguments.data / "train.json").classes
    adapt(checkpoint["model"], old, new)
    checkpoint["classes"] = new
    torch.save(checkpoint, arguments.out)
    print(f"{arguments.out}: {', '.join(name for name, _ in new)}")


if __name__ == "__main__":
    main()
