#!/usr/bin/env python3
"""Writes the three parts of a Mask R-CNN that was not trained but made by hand. Features are the
mean colours of cells of 4 x 4 pixels; with g = 2 G - R - B:

    objectness = mean g of 9 x 9 cells          box deltas = 0
    background = 0    crop = 100 g - 25 + 100 (R - 0.32)    weed = 100 g - 25 - 100 (R - 0.32)
    mask = 20 g - 8
"""

import hashlib
import pathlib

import numpy as np
from onnx import TensorProto, checker, helper, numpy_helper, save

folder = pathlib.Path(__file__).parent
green = np.array([-1, 2, -1], np.float32)  # of B, G, R
red = np.array([0, 0, 1], np.float32)


def constant(name, value):
    return numpy_helper.from_array(np.asarray(value, np.float32), name)


def write(name, nodes, inputs, outputs, constants):
    info = helper.make_tensor_value_info
    graph = helper.make_graph(nodes, name, [info(n, TensorProto.FLOAT, s) for n, s in inputs],
                              [info(n, TensorProto.FLOAT, s) for n, s in outputs], constants)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 11)])
    checker.check_model(model)
    save(model, str(folder / f"mask_rcnn_{name}.onnx"))


node = helper.make_node
write("backbone",
      [node("AveragePool", ["image"], ["features_0"], kernel_shape=[4, 4], strides=[4, 4]),
       node("Conv", ["features_0", "green"], ["cells"], kernel_shape=[1, 1]),
       node("AveragePool", ["cells"], ["objectness_0"], kernel_shape=[9, 9], pads=[4, 4, 4, 4],
            count_include_pad=1),
       node("Conv", ["features_0", "nothing"], ["deltas_0"], kernel_shape=[1, 1])],
      [("image", [1, 3, 128, 128])],
      [("features_0", [1, 3, 32, 32]), ("objectness_0", [1, 1, 32, 32]),
       ("deltas_0", [1, 4, 32, 32])],
      [constant("green", green.reshape(1, 3, 1, 1)), constant("nothing", np.zeros((4, 3, 1, 1)))])

classes = np.stack([0 * green, 100 * green + 100 * red, 100 * green - 100 * red])
write("box_head",
      [node("GlobalAveragePool", ["regions"], ["mean"]),
       node("Flatten", ["mean"], ["colour"]),
       node("Gemm", ["colour", "classes", "bias"], ["class_logits"], transB=1),
       node("Gemm", ["colour", "nothing", "zero"], ["box_deltas"], transB=1)],
      [("regions", ["n", 3, 7, 7])], [("class_logits", ["n", 3]), ("box_deltas", ["n", 4])],
      [constant("classes", classes), constant("bias", [0, -25 - 32, -25 + 32]),
       constant("nothing", np.zeros((4, 3))), constant("zero", np.zeros(4))])

write("mask_head",
      [node("Conv", ["regions", "green", "bias"], ["mask_logits"], kernel_shape=[1, 1])],
      [("regions", ["n", 3, 14, 14])], [("mask_logits", ["n", 2, 14, 14])],
      [constant("green", np.stack([20 * green] * 2).reshape(2, 3, 1, 1)), constant("bias", [-8, -8])])

lines = ["# Written by make_mask_rcnn.py.", "kind: mask_rcnn", "name: made_by_hand",
         "ground_resolution_mm_per_px: 2.0", "feature_levels: 1",
         "anchors: {sizes_px: [32], strides_px: [4], aspect_ratios: [1]}"]
for part in ("backbone", "box_head", "mask_head"):
    content = (folder / f"mask_rcnn_{part}.onnx").read_bytes()
    lines += [f"{part}: mask_rcnn_{part}.onnx", f"{part}_bytes: {len(content)}",
              f"{part}_sha256: {hashlib.sha256(content).hexdigest()}"]
lines += ["classes:", "  - {name: beet, kind: crop}", "  - {name: goosefoot, kind: weed}"]
(folder / "mask_rcnn.yaml").write_text("\n".join(lines) + "\n")
