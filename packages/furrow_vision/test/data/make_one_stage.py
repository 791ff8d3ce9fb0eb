#!/usr/bin/env python3
"""Writes one_stage.onnx, a network that was made by hand and not trained.

It averages cells of 4 x 4 pixels, and reads plant from green, stem from blue, and crop or weed from
red.

    plant = 20 (2 G - R - B) - 4      stem = 40 B - 20
    crop = 10 R - 2                   weed = 2 - 10 R        offsets = 0
"""

import hashlib
import pathlib

import numpy as np
from onnx import TensorProto, checker, helper, numpy_helper, save

folder = pathlib.Path(__file__).parent
#                  B    G    R
weights = np.array([[-20, 40, -20], [40, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 10], [0, 0, -10]],
                   np.float32).reshape(6, 3, 1, 1)
bias = np.array([-4, -20, 0, 0, -2, 2], np.float32)
nodes = [helper.make_node("AveragePool", ["image"], ["cells"], kernel_shape=[4, 4], strides=[4, 4]),
         helper.make_node("Conv", ["cells", "weights", "bias"], ["output"], kernel_shape=[1, 1])]
graph = helper.make_graph(
    nodes, "one_stage",
    [helper.make_tensor_value_info("image", TensorProto.FLOAT, [1, 3, 64, 64])],
    [helper.make_tensor_value_info("output", TensorProto.FLOAT, [1, 6, 16, 16])],
    [numpy_helper.from_array(weights, "weights"), numpy_helper.from_array(bias, "bias")])
model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 11)])
checker.check_model(model)
save(model, str(folder / "one_stage.onnx"))
content = (folder / "one_stage.onnx").read_bytes()
(folder / "one_stage.yaml").write_text(f"""# Written by make_one_stage.py.
name: made_by_hand
network: one_stage.onnx
network_bytes: {len(content)}
network_sha256: {hashlib.sha256(content).hexdigest()}
stride: 4
offset_unit_px: 32.0
ground_resolution_mm_per_px: 2.0
classes:
  - {{name: beet, kind: crop}}
  - {{name: goosefoot, kind: weed}}
""")
