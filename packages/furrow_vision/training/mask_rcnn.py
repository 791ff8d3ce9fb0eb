"""A slim Mask R-CNN (He et al. 2017) with super-class and sub-class scores (Halstead et al. 2018) and
a stem per plant: the backbone of the one-stage network, a pyramid of 64 channels, light heads."""

import torch
from torch import nn
from torch.nn import functional as F
from torchvision.models.detection import _utils as detection
from torchvision.models.detection.anchor_utils import AnchorGenerator
from torchvision.models.detection.image_list import ImageList
from torchvision.models.detection.rpn import RegionProposalNetwork, RPNHead
from torchvision.ops import FeaturePyramidNetwork, MultiScaleRoIAlign, box_iou, roi_align

import one_stage

CHANNELS = 64
STRIDES = (4, 8, 16, 32)
ANCHOR_SIZES = (12, 24, 48, 96)
ASPECT_RATIOS = (0.5, 1.0, 2.0)
BOX_CELLS, MASK_CELLS = 7, 14
BOX_WEIGHTS = (10.0, 10.0, 5.0, 5.0)
FEATURES = ["0", "1", "2", "3"]


class Pyramid(FeaturePyramidNetwork):
    """With fixed factors between its levels, which OpenCV can read; sides are multiples of 32."""

    def forward(self, x):
        top, maps = None, {}
        for i in reversed(range(len(FEATURES))):
            side = self.inner_blocks[i](x[FEATURES[i]])
            top = side if top is None else side + F.interpolate(top, scale_factor=2, mode="nearest")
            maps[FEATURES[i]] = self.layer_blocks[i](top)
        return {name: maps[name] for name in FEATURES}


class Backbone(nn.Module):
    """Maps of strides 4, 8, 16, 32. Takes the weights of a trained one-stage network."""

    def __init__(self, width=1.0):
        super().__init__()
        body = one_stage.OneStage(1, width)
        self.down2, self.down4, self.down8 = body.down2, body.down4, body.down8
        self.down16, self.down32 = body.down16, body.down32
        inputs = [lateral.in_channels for lateral in body.lateral]
        self.pyramid = Pyramid(inputs, CHANNELS)

    def forward(self, x):
        features, maps = self.down2(x), {}
        stages = (self.down4, self.down8, self.down16, self.down32)
        for name, down in zip(FEATURES, stages):
            features = down(features)
            maps[name] = features
        return self.pyramid(maps)


class BoxHead(nn.Module):
    """Of regions: background or plant, class of a plant, box, stem (from the region's centre, in
    its sizes)."""

    def __init__(self, classes, inner=256):
        super().__init__()
        self.classes = classes
        self.body = nn.Sequential(nn.Flatten(), nn.Linear(CHANNELS * BOX_CELLS ** 2, inner), nn.ReLU(),
                                  nn.Linear(inner, inner), nn.ReLU())
        self.super_class = nn.Linear(inner, 2)
        self.sub_class = nn.Linear(inner, classes)
        self.box = nn.Linear(inner, 4)
        self.stem = nn.Linear(inner, 2)

    def forward(self, regions):
        x = self.body(regions)
        return self.super_class(x), self.sub_class(x), self.box(x), self.stem(x)


class ExportedBoxHead(nn.Module):
    """The same with one row of logits: their softmax is p(background) and p(plant) p(class|plant)."""

    def __init__(self, head):
        super().__init__()
        self.head = head
        weight, bias = head.super_class.weight.data, head.super_class.bias.data
        self.background = _linear(weight[:1], bias[:1])
        self.plant = _linear(weight[1:].repeat(head.classes, 1), bias[1:].repeat(head.classes))

    def forward(self, regions):
        x = self.head.body(regions)
        plant = self.plant(x) + F.log_softmax(self.head.sub_class(x), dim=1)
        return torch.cat([self.background(x), plant], dim=1), self.head.box(x), self.head.stem(x)


def _linear(weight, bias):
    layer = nn.Linear(weight.shape[1], weight.shape[0])
    layer.weight.data, layer.bias.data = weight.clone(), bias.clone()
    return layer


class MaskHead(nn.Sequential):
    """One mask a region, whatever its class."""

    def __init__(self, convolutions=2, inner=48):
        layers, channels = [], CHANNELS
        for _ in range(convolutions):
            layers += [nn.Conv2d(channels, inner, 3, padding=1), nn.ReLU()]
            channels = inner
        super().__init__(*layers, nn.ConvTranspose2d(inner, inner, 2, 2), nn.ReLU(),
                         nn.Conv2d(inner, 1, 1))


class MaskRcnn(nn.Module):
    def __init__(self, classes, width=1.0, samples=64):
        super().__init__()
        self.backbone = Backbone(width)
        anchors = AnchorGenerator(tuple((size,) for size in ANCHOR_SIZES), (ASPECT_RATIOS,) * len(STRIDES))
        limits = {"training": 400, "testing": 400}, {"training": 200, "testing": 200}
        self.proposals = RegionProposalNetwork(
            anchors, RPNHead(CHANNELS, len(ASPECT_RATIOS)), fg_iou_thresh=0.6, bg_iou_thresh=0.3,
            batch_size_per_image=128, positive_fraction=0.5, pre_nms_top_n=limits[0],
            post_nms_top_n=limits[1], nms_thresh=0.7)
        self.box_head, self.mask_head = BoxHead(classes), MaskHead()
        self.cut_boxes = MultiScaleRoIAlign(FEATURES, BOX_CELLS, sampling_ratio=2)
        self.cut_masks = MultiScaleRoIAlign(FEATURES, MASK_CELLS, sampling_ratio=2)
        self.sampler = detection.BalancedPositiveNegativeSampler(samples, 0.4)
        self.coder = detection.BoxCoder(BOX_WEIGHTS)

    def _propose(self, images, targets=None):
        features = self.backbone(images)
        sizes = [tuple(images.shape[-2:])] * len(images)
        proposals, losses = self.proposals(ImageList(images, sizes), features, targets)
        return features, sizes, proposals, losses

    def loss(self, images, targets, class_weights, crops):
        """`targets`: for each image boxes, labels, masks (float), stems. Sum of parts, and parts. The
        first `crops` classes are crops."""
        features, sizes, proposals, losses = self._propose(images, targets)
        samples = [self._sample(p, t) for p, t in zip(proposals, targets)]
        boxes = [s["boxes"] for s in samples]
        plant = torch.cat([s["plant"] for s in samples])
        labels = torch.cat([s["labels"] for s in samples])
        super_class, sub_class, deltas, stems = self.box_head(self.cut_boxes(features, boxes, sizes))
        count = plant.sum().clamp(min=1)
        regression = self.coder.encode([s["matched"] for s in samples], boxes)
        off = F.smooth_l1_loss(deltas, torch.cat(regression), beta=0.3, reduction="none").sum(1)
        stem_off = F.smooth_l1_loss(stems, torch.cat([s["stems"] for s in samples]), beta=0.05,
                                    reduction="none").sum(1)
        sub = F.cross_entropy(sub_class, labels, class_weights, reduction="none")
        parts = {"objectness": losses["loss_objectness"], "proposal": losses["loss_rpn_box_reg"],
                 "plant": F.cross_entropy(super_class, plant.long()),
                 "class": (sub * plant).sum() / count, "box": (off * plant).sum() / count,
                 "stem": (stem_off * plant).sum() / count,
                 "mask": self._mask_loss(features, sizes, samples)}
        if 0 < crops < sub_class.shape[1]:
            odds = one_stage.crop_log_odds(sub_class, crops)
            parts["kind"] = F.binary_cross_entropy_with_logits(odds, (labels < crops).float(), plant,
                                                               reduction="sum") / count
        weights = {"plant": 2.0, "class": 0.5, "box": 0.5, "stem": 2.0}
        return sum(weights.get(name, 1.0) * part for name, part in parts.items()), parts

    def train_heads_only(self):
        """What finds regions stays as it is, with its means and deviations."""
        for part in (self.backbone, self.proposals):
            part.requires_grad_(False)
        self.backbone.eval()

    @torch.no_grad()
    def _sample(self, proposals, target):
        """Regions for the heads: proposals and the true boxes, plants and background."""
        boxes = torch.cat([proposals, target["boxes"]])
        if len(target["boxes"]) == 0:
            chosen = torch.randperm(len(boxes))[:self.sampler.batch_size_per_image]
            none = torch.zeros(len(chosen), dtype=torch.long, device=boxes.device)
            return {"boxes": boxes[chosen], "matched": boxes[chosen], "plant": none.float(), "owner": none,
                    "labels": none, "stems": boxes.new_zeros(len(chosen), 2), "masks": target["masks"]}
        overlap, owner = box_iou(boxes, target["boxes"]).max(1)
        positive, negative = self.sampler([(overlap >= 0.5).long()])
        chosen = torch.where(positive[0] | negative[0])[0]
        boxes, owner = boxes[chosen], owner[chosen]
        size = (boxes[:, 2:] - boxes[:, :2]).clamp(min=1)
        stems = (target["stems"][owner] - (boxes[:, :2] + boxes[:, 2:]) / 2) / size
        return {"boxes": boxes, "matched": target["boxes"][owner], "owner": owner,
                "plant": (overlap[chosen] >= 0.5).float(), "labels": target["labels"][owner],
                "stems": stems.clamp(-1.5, 1.5), "masks": target["masks"]}

    def _mask_loss(self, features, sizes, samples, most=16):
        boxes, wanted = [], []
        for sample in samples:
            positive = torch.where(sample["plant"] > 0)[0]
            positive = positive[torch.randperm(len(positive))[:most]]
            boxes.append(sample["boxes"][positive])
            if len(positive) == 0:
                continue
            regions = torch.cat([sample["owner"][positive, None].float(), boxes[-1]], 1)
            # Aligned: the detector stretches masks so that cells' centres count.
            wanted.append(roi_align(sample["masks"][:, None], regions, 2 * MASK_CELLS, aligned=True))
        if not wanted:
            return features["0"].sum() * 0
        logits = self.mask_head(self.cut_masks(features, boxes, sizes))
        return F.binary_cross_entropy_with_logits(logits, torch.cat(wanted))

    @torch.no_grad()
    def detect(self, image, score_min=0.5):
        """Boxes, scores and classes of one image, to watch the training."""
        features, sizes, proposals, _ = self._propose(image[None])
        super_class, sub_class, deltas, stems = self.box_head(self.cut_boxes(features, proposals, sizes))
        scores = super_class.softmax(1)[:, 1]
        boxes = self.coder.decode(deltas, proposals)[:, 0]
        region = proposals[0]
        stems = (region[:, :2] + region[:, 2:]) / 2 + stems * (region[:, 2:] - region[:, :2])
        keep = torch.where(scores >= score_min)[0]
        keep = keep[torch.ops.torchvision.nms(boxes[keep], scores[keep], 0.5)]
        return boxes[keep], scores[keep], sub_class[keep].argmax(1), stems[keep]


class ExportedBackbone(nn.Module):
    def __init__(self, model):
        super().__init__()
        self.backbone, self.head = model.backbone, model.proposals.head

    def forward(self, image):
        maps = list(self.backbone(image).values())
        objectness, deltas = self.head(maps)
        return (*maps, *objectness, *deltas)
