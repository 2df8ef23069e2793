# SPDX-License-Identifier: GPL-3.0-or-later
"""The names of what regroup's networks are told, in order, from the only list of them."""

import re
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2] / "native" / "src" / "tree" / "regroup"


def documented_names(struct):
    text = (SOURCE / "measures.h").read_text()
    body = re.search(r"struct %s \{(.*?)\n\};" % struct, text, re.DOTALL).group(1)
    return re.findall(r"^    double (\w+);", body, re.MULTILINE)


PAIR_NAMES = documented_names("PairMeasures")
NODE_NAMES = documented_names("OwnMeasures") + documented_names("NodeMeasures")
