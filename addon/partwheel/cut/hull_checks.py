# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of a model's hulls before they are exported: what an engine would reject or place wrongly."""

import re

import bpy
import numpy as np

from ..library_error import draw_wrapped_text
from ..mesh import arrays, get_mesh_state
from ..parts import registry
from ..translations.lookup import rpt_
from . import hulls
from partwheel import Hierarchy
from partwheel.index import Index

MAX_VERTICES = 255  # PhysX: Unreal, Unity
MAX_MESSAGES = 6  # shown in the panel; further ones are counted
TOLERANCE = 1e-4  # of a hull's size: single precision, and corners of planar facets
ROUNDING = 2.0 ** -24  # of a coordinate in single precision
_PATTERNS = [re.compile(re.escape(pattern).replace(r"\{model\}", "(?P<model>.+)").replace(r"\{number:02\}", r"\d{2,}"))
             for patterns in hulls.NAME_PATTERNS.values() for pattern in patterns.values()]
_cache = {}  # object name -> (key, sentences): panels are drawn often


def check_hulls(obj: bpy.types.Object) -> list[str]:
    """A sentence for each problem; [] if the hulls can be exported. Cached until the hulls or the object change."""
    children = hulls.find_hulls(obj)
    hierarchy = registry.find_hierarchy(obj.data)
    key = (np.array(obj.matrix_world).tobytes(), id(hierarchy), *(
        (child.name, np.array(child.matrix_local).tobytes(), get_mesh_state(child.data).geometry_revision) for child in children))
    if _cache.get(obj.name, (None,))[0] != key:
        _cache.clear()
        _cache[obj.name] = key, _find_problems(obj, children, hierarchy)
    return _cache[obj.name][1]


def _find_problems(obj: bpy.types.Object, children: list[bpy.types.Object], hierarchy: Hierarchy | None) -> list[str]:
    problems = []
    scale = np.linalg.svd(np.array(obj.matrix_world)[:3, :3], compute_uv=False)  # also where a stretched parent shears it
    if np.linalg.det(np.array(obj.matrix_world)[:3, :3]) < 0:
        problems.append(rpt_("{name} is mirrored. Apply its scale (Object > Apply > Scale).").format(name=obj.name))
    elif np.ptp(scale) > TOLERANCE * scale.max():
        problems.append(rpt_("The scale of {name} differs between axes. Apply it (Object > Apply > Scale).").format(
            name=obj.name))
    elif abs(scale.max() - 1) > TOLERANCE:
        problems.append(rpt_("The scale of {name} is not 1. Apply it (Object > Apply > Scale).").format(name=obj.name))
    for child in children:
        problems += [problem.format(name=child.name, model=obj.name) for problem in _find_hull_problems(obj, child)]
    bounded = [child for child in children if hulls.TOLERANCE_PROPERTY in child]
    index = Index(hierarchy) if bounded and hierarchy else None
    for child in bounded if index else []:
        tolerance = child[hulls.TOLERANCE_PROPERTY]
        if (distance := index.nearest(_sample(child))[1].max()) > tolerance * (1 + TOLERANCE):
            text = rpt_("{name} leaves {model} by {distance:.3g}, more than {tolerance:.3g}. Create the hulls again.")
            problems.append(text.format(name=child.name, model=obj.name, distance=distance, tolerance=tolerance))
    return problems


def _read_hull(child: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    return arrays.read_positions(child.data).astype(float), arrays.read_triangles(child.data)[0]


def _sample(child: bpy.types.Object) -> np.ndarray:
    """(n, 3) the hull's vertices and the middles of its edges and triangles, in the space of the model."""
    vertices, triangles = _read_hull(child)
    corners = vertices[triangles]
    middles = [corners.mean(axis=1), *((corners[:, k] + corners[:, k - 1]) / 2 for k in range(3))]
    matrix = np.array(child.matrix_local)
    return np.concatenate([vertices, *middles]) @ matrix[:3, :3].T + matrix[:3, 3]


def _find_hull_problems(obj: bpy.types.Object, child: bpy.types.Object) -> list[str]:
    problems = []
    name = next(filter(None, (pattern.fullmatch(child.name) for pattern in _PATTERNS)), None)
    if not name or name["model"] != obj.name:
        problems.append(rpt_("The name {name} is not that of a hull of {model}. Create the hulls again."))
    is_primitive = not np.allclose(child.matrix_local, np.eye(4), atol=TOLERANCE)
    linear = np.array(child.matrix_local)[:3, :3]
    if is_primitive and not np.allclose(linear @ linear.T, np.eye(3), atol=TOLERANCE):
        problems.append(rpt_("{name} was scaled. Apply its scale (Object > Apply > Scale)."))
    vertices, triangles = _read_hull(child)
    if len(vertices) > MAX_VERTICES:
        problems.append(rpt_("{name} has more than 255 vertices. Set Vertices to at most 255."))
    size = np.ptp(vertices, axis=0).max() if len(vertices) else 0
    normals = np.cross(*(vertices[triangles[:, k]] - vertices[triangles[:, 0]] for k in (1, 2)))
    lengths = np.linalg.norm(normals, axis=1)
    volume = arrays.enclosed_volume(vertices, triangles)
    if abs(volume) <= TOLERANCE ** 2 * size ** 3:
        problems.append(rpt_("{name} is flat. Delete it."))
    elif volume < 0:
        problems.append(rpt_("The faces of {name} point inward. Recalculate them (Mesh > Normals)."))
    else:
        # Rounding turns the normals of slivers by more than the tolerance.
        corners = vertices[triangles]
        longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        is_exact = lengths * TOLERANCE > longest * ROUNDING * abs(vertices).max()
        units, corners = normals[is_exact] / lengths[is_exact, None], vertices[triangles[is_exact, 0]]
        if ((vertices @ units.T - np.einsum("ij,ij->i", units, corners)) > TOLERANCE * size).any():
            problems.append(rpt_("{name} is not convex. Create the hulls again."))
    return problems


def draw(context: bpy.types.Context, layout: bpy.types.UILayout, obj: bpy.types.Object) -> None:
    """Draw the problems of the object's hulls, or that there are none."""
    if not hulls.find_hulls(obj):
        return
    problems = check_hulls(obj)
    column = layout.column(align=True)
    for problem in problems[:MAX_MESSAGES]:
        draw_wrapped_text(context, column, problem, icon="ERROR")
    if len(problems) > MAX_MESSAGES:
        column.label(text=rpt_("{count} more").format(count=len(problems) - MAX_MESSAGES), translate=False)
    if not problems:
        column.label(text="Hulls Are Ready for Export", icon="CHECKMARK")
