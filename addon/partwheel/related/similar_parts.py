# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts similar to a given one, in its own mesh and in other objects', and its mirror images. Results are cached,
since wheel and Adjust Last Operation ask again."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..mesh import MeshSnapshot, Refused, arrays
from ..parts import registry
from partwheel import Hierarchy, likeness

_cache = {}  # kind of query -> ((the meshes' fingerprints, their hierarchies, ...), result)


class SimilarPart(NamedTuple):
    """A node of an object that is similar to another, by a likeness from 1 downward. name: the object's full name."""

    name: str
    node: int
    likeness: float


def find_similar(snapshot: MeshSnapshot, hierarchy: Hierarchy, node: int,
                 others: Sequence[MeshSnapshot] = ()) -> list[SimilarPart]:
    """[SimilarPart, ...] of the object's other nodes, and of those of other objects with parts, the most similar
    first: see partwheel.likeness.similar_parts(). Sizes are those in the world. hierarchy: from
    registry.get_hierarchy(snapshot)."""
    models = [(snapshot.obj, hierarchy)] + [(other.obj, other_hierarchy) for other in others
                                            if (other_hierarchy := registry.get_hierarchy(other))]
    matrices = [np.array(model_obj.matrix_world) for model_obj, _ in models]

    def search() -> list[SimilarPart]:
        measures = [likeness.measure_nodes(model_hierarchy, *arrays.read_surface(model_obj.data)[:3], matrix)
                    for (model_obj, model_hierarchy), matrix in zip(models, matrices)]
        among = [None, *((model_hierarchy, model_measures)
                         for (_, model_hierarchy), model_measures in list(zip(models, measures))[1:])]
        parts = [SimilarPart(model_obj.name_full, *pair) for (model_obj, _), target in zip(models, among)
                 for pair in likeness.similar_parts(hierarchy, measures[0], node, target)]
        return sorted(parts, key=lambda part: -part.likeness)

    key = [(model_obj.name_full, registry.find_entry(model_obj.data).fingerprint, model_hierarchy)
           for model_obj, model_hierarchy in models]
    return _cached("alike", (key, [matrix.tobytes() for matrix in matrices], node), search)


def find_mirror_images(snapshot: MeshSnapshot, hierarchy: Hierarchy, node: int) -> list[likeness.MirrorImage]:
    """[partwheel.likeness.MirrorImage, ...], one for each symmetry plane, the best first. Raises Refused."""
    if node == len(hierarchy.parent) - 1:
        raise Refused("The part is the whole model, which has no other side. Pick a smaller one.")
    key = snapshot.state.entry.fingerprint, hierarchy, node
    mirror_images = _cached("images", key,
                            lambda: likeness.mirrored_parts(hierarchy, *arrays.read_surface(snapshot.mesh)[:3], node))
    if not mirror_images:
        raise Refused("The part has no mirror image in {name}: it crosses the symmetry plane, or the model is not "
                      "symmetric.", name=snapshot.obj.name)
    return mirror_images


def _cached(kind: str, key: tuple, search: Callable[[], Any]) -> Any:
    """The cached result for this key, or a new one. One result of each kind is kept."""
    if kind not in _cache or _cache[kind][0] != key:
        _cache[kind] = key, search()
    return _cache[kind][1]


def unregister() -> None:
    _cache.clear()
