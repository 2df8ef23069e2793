# SPDX-License-Identifier: GPL-3.0-or-later
# ruff: noqa: F401 names for other layers
"""Blender's meshes: arrays, selections, and what is stored for each mesh; computations in the background; error messages."""

from .arrays import Fingerprint
from .computation import Computation, Steps, is_running, run_steps, start_thread
from .datablocks import find_users, local_copy, parse_json, remove_object, rename, rollback_on_error
from .edit_mode import go_to_object_mode, return_to_mode
from .errors import (NeedsActiveMesh, NeedsEditMode, Refused, check_poll, poll_in_modes, poll_is_editable,
                     read_only_reason, report_errors)
from .labels import Labels
from .marks import FACE_SET
from .mesh_state import MeshState, element_counts, find_deleted, find_object, get_mesh_state, resolve_object
from .selection import Selections, select_outside_edit_mode
from .snapshot import MeshSnapshot
