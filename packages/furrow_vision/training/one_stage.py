"""The one-stage network: plant, stem, offset to the stem, and class, at a quarter of the image."""

import torch
from torch import nn
from torch.nn import functional as F


def _conv(inputs, outputs, kernel, stride=1):
    return nn.Sequential(nn.Conv2d(inputs, outputs, kernel, stride, kernel // 2, bias=False),
                         nn.BatchNorm2d(outputs), nn.ReLU(inplace=True))


class _Residual(nn.Module):
    """A basic residual block (He et al. 2016). Dense convolutions: on a CPU they take less time
    than depthwise ones of the same accuracy, in training by a factor of three."""

    def __init__(self, channels):
        super().__init__()
        self.body = nn.Sequential(_conv(channels, channels, 3),
                                  nn.Conv2d(channels, channels, 3, padding=1, bias=False),
                                  nn.BatchNorm2d(channels))

    def forward(self, x):
        return F.relu(x + self.body(x))


def _stage(inputs, outputs, blocks):
    return nn.Sequential(_conv(inputs, outputs, 3, 2), *[_Residual(outputs) for _ in range(blocks)])


class OneStage(nn.Module):
    """Input: BGR in [0, 1]. Output channels: plant, stem, du, dv, then one per class (logits)."""

    def __init__(self, classes, width=1.0):
        super().__init__()
        c = [int(round(n * width / 8) * 8) for n in (16, 24, 48, 80, 112, 32)]
        self.down2 = _conv(3, c[0], 3, 2)
        self.down4 = _stage(c[0], c[1], 1)
        self.down8 = _stage(c[1], c[2], 2)
        self.down16 = _stage(c[2], c[3], 2)
        self.down32 = _stage(c[3], c[4], 2)
        self.lateral = nn.ModuleList([nn.Conv2d(n, c[5], 1) for n in c[1:5]])
        self.smooth = nn.ModuleList([_conv(c[5], c[5], 3) for _ in range(3)])
        self.head = nn.Sequential(_conv(c[5], c[5], 3), nn.Conv2d(c[5], 4 + classes, 1))
        # Rare positives: start from low probabilities, or the first steps drown in background.
        with torch.no_grad():
            self.head[-1].bias.zero_()
            self.head[-1].bias[:2] = torch.tensor([-2.0, -4.0])

    def forward(self, x):
        features, maps = self.down2(x), []
        for down in (self.down4, self.down8, self.down16, self.down32):
            features = down(features)
            maps.append(features)
        top = self.lateral[3](maps[3])
        for level in (2, 1, 0):
            up = F.interpolate(top, scale_factor=2, mode="nearest")
            top = self.smooth[level](up + self.lateral[level](maps[level]))
        return self.head(top)


def loss(output, share, classes, heat, offsets, class_weights, crops):
    """Sum of the losses of the maps; the first `crops` classes are crops.

    - Plant, where it is known: cross entropy with Dice.
    - Stems: penalty-reduced focal loss (Zhou et al. 2019).
    - Offsets: L1.
    - Classes, on cells of plants: weighted cross entropy.
    - Crop against weed: see _kind_loss.
    """
    plant, stem, offset, logits = output[:, 0], output[:, 1], output[:, 2:4], output[:, 4:]
    known = share >= 0
    share = share.clamp(min=0)
    probability = torch.sigmoid(plant) * known
    plant_loss = F.binary_cross_entropy_with_logits(plant, share, known.float()) \
        + 0.5 * _dice(probability, share)

    p = torch.sigmoid(stem).clamp(1e-4, 1 - 1e-4)
    peak = (heat >= 0.999).float()
    positive = -((1 - p) ** 2) * torch.log(p) * peak
    negative = -((1 - heat) ** 4) * p ** 2 * torch.log(1 - p) * (1 - peak) * known
    stem_loss = (positive.sum() + negative.sum()) / peak.sum().clamp(min=1)

    inside = classes >= 0
    count = inside.sum().clamp(min=1)
    offset_loss = (F.l1_loss(offset, offsets, reduction="none").sum(1) * inside).sum() / count
    class_loss = (F.cross_entropy(logits, classes.clamp(min=0), class_weights, reduction="none")
                  * inside).sum() / count
    parts = {"plant": plant_loss, "stem": stem_loss, "offset": offset_loss, "class": class_loss}
    total = plant_loss + 0.5 * stem_loss + offset_loss + 0.5 * class_loss
    if 0 < crops < logits.shape[1]:
        parts["kind"] = _kind_loss(logits, probability, share, classes, crops)
        total = total + parts["kind"]
    return total, parts


def crop_log_odds(logits, crops):
    """Of the first `crops` classes together against the others; classes are the second dimension."""
    return torch.logsumexp(logits[:, :crops], 1) - torch.logsumexp(logits[:, crops:], 1)


def _dice(probability, share):
    return 1 - (2 * (probability * share).sum() + 1) / (probability.sum() + share.sum() + 1)


def _kind_loss(logits, probability, share, classes, crops):
    """Crop against weed: cross entropy with equal weight for each cell of a plant, and Dice of both
    masks. The Dice gives the rarer kind the same weight as the other."""
    odds = crop_log_odds(logits, crops)
    inside, crop = (classes >= 0).float(), ((classes >= 0) & (classes < crops)).float()
    entropy = F.binary_cross_entropy_with_logits(odds, crop, inside, reduction="sum") \
        / inside.sum().clamp(min=1)
    is_crop = torch.sigmoid(odds)
    return entropy + 0.5 * _dice(probability * is_crop, share * crop) \
        + 0.5 * _dice(probability * (1 - is_crop), share * (inside - crop))
