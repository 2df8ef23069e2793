# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators: build, clear, select by wheel, the same outside Edit Mode; copy, remove, split, place, unite, swap;
deform."""

import bpy

from . import proportional
from .build import MESH_OT_partwheel_build, MESH_OT_partwheel_clear, MESH_OT_partwheel_find
from .copy_part import MESH_OT_partwheel_copy, MESH_OT_partwheel_remove, MESH_OT_partwheel_split
from .deform import PARTWHEEL_PG_handle, MESH_OT_partwheel_deform
from .paint import MESH_OT_partwheel_paint, OBJECT_OT_partwheel_select
from .place import OBJECT_OT_partwheel_place
from .proportional import MESH_OT_partwheel_move
from .select import MESH_OT_partwheel_select
from .swap import MESH_OT_partwheel_swap
from .unite import OBJECT_OT_partwheel_unite

CLASSES = (
    MESH_OT_partwheel_build, MESH_OT_partwheel_find, MESH_OT_partwheel_clear,
    MESH_OT_partwheel_select, OBJECT_OT_partwheel_select, MESH_OT_partwheel_paint,
    MESH_OT_partwheel_copy, MESH_OT_partwheel_remove, MESH_OT_partwheel_split,
    OBJECT_OT_partwheel_place, OBJECT_OT_partwheel_unite, MESH_OT_partwheel_swap,
    PARTWHEEL_PG_handle, MESH_OT_partwheel_deform, MESH_OT_partwheel_move,
)

register, _unregister_classes = bpy.utils.register_classes_factory(CLASSES)


def unregister():
    proportional.unregister()
    _unregister_classes()
