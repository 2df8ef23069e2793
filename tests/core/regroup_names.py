# SPDX-License-Identifier: GPL-3.0-or-later
"""What regroup's networks are told, by name and in order, and their numbers, from the only lists of them."""

import re
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).resolve().parents[2] / "native" / "src" / "tree" / "regroup"


def documented_names(struct):
    text = (SOURCE / "measures.h").read_text()
    body = re.search(r"struct %s \{(.*?)\n\};" % struct, text, re.DOTALL).group(1)
    return re.findall(r"^    double (\w+);", body, re.MULTILINE)


def fitted_numbers(name):
    text = (SOURCE / "fitted.h").read_text()
    numbers = re.search(name + r" = \{(.*?)\};", text, re.DOTALL).group(1)
    return np.array([float(number) for number in numbers.split(",") if number.strip()])


PAIR_NAMES = documented_names("PairMeasures")
NODE_NAMES = documented_names("OwnMeasures") + documented_names("NodeMeasures")
