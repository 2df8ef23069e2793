# SPDX-License-Identifier: GPL-3.0-or-later
"""The cut whose parts are what divides a mesh already: its materials, face sets, ..."""

import numpy as np

from ..mesh import Labels, MeshSnapshot
from ..parts import registry
from partwheel import Hierarchy
from partwheel.cut import Cut


def find_cut(hierarchy: Hierarchy, labels: Labels, keeps_borders: bool = True) -> tuple[Cut, dict]:
    """(the cut with a part for each label, {clusters: name}). A cluster's majority decides. keeps_borders: see Cut."""
    cut, names = Cut.from_labels(hierarchy, labels.of_face, keeps_borders), {}
    for part, clusters in enumerate(cut.parts):
        values, counts = np.unique(labels.of_face[cut.labels == part], return_counts=True)
        if (name := labels.names.get(int(values[counts.argmax()]))) and name not in names.values():
            names[clusters] = name
    return cut, names


def count_misplaced(cut: Cut, labels: Labels) -> int:
    """The number of faces that are in another part than their label says."""
    values = np.unique(labels.of_face)
    if len(values) != len(cut):
        return len(labels.of_face)
    return int(np.count_nonzero(values[cut.labels] != labels.of_face))


def find_exact_hierarchy(snapshot: MeshSnapshot, labels: Labels | None) -> Hierarchy | None:
    """The hierarchy of the mesh, if its parts end exactly at the labels' borders; None: build one, see build_options()."""
    hierarchy = registry.get_hierarchy(snapshot)
    is_exact = not hierarchy or not labels or not count_misplaced(Cut.from_labels(hierarchy, labels.of_face), labels)
    return hierarchy if is_exact else None


def build_options(labels: Labels | None) -> dict:
    """Options of builds.request_build()."""
    return {"labels": labels.of_face.tobytes()} if labels else {}
