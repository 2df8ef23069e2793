# SPDX-License-Identifier: GPL-3.0-or-later
"""The names of the features of the merge policy in their order, and the weights of its networks, read from the headers."""

import re
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).resolve().parents[2] / "native" / "src" / "parts" / "merge"


def documented_names(struct):
    text = (SOURCE / "feature_names.h").read_text()
    body = re.search(r"struct %s \{(.*?)\n\};" % struct, text, re.DOTALL).group(1)
    return re.findall(r"^    double (\w+);", body, re.MULTILINE)


def network_weights(name):
    text = (SOURCE / "network_weights.h").read_text()
    numbers = re.search(name + r" = \{(.*?)\};", text, re.DOTALL).group(1)
    return np.array([float(number) for number in numbers.split(",") if number.strip()])


PAIR_NAMES = documented_names("PairFeatures")
NODE_NAMES = documented_names("OwnFeatures") + documented_names("NodeFeatures")
