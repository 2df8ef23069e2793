# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's meshes: arrays, selections, and what is stored for each mesh; computations in the background; error messages."""

from .arrays import Fingerprint
from .computation import Computation, Steps, is_running, run_steps, start_thread
from .datablocks import parse_json, remove_object, rename, rollback_on_error
from .errors import (NeedsActiveMesh, NeedsEditMode, Refused, check_poll, poll_in_modes, poll_is_editable,
                     read_only_reason, report_errors)
from .labels import Labels
from .marks import FACE_SET
from .mesh_state import MeshState, element_counts, find_deleted, find_object, get_mesh_state, resolve_object
from .selection import Selections, select_outside_edit_mode
from .snapshot import MeshSnapshot

__all__ = ["Computation", "FACE_SET", "Fingerprint", "Labels", "MeshSnapshot", "MeshState", "NeedsActiveMesh",
           "NeedsEditMode", "Refused", "Selections", "Steps", "check_poll", "element_counts", "find_deleted", "find_object",
           "get_mesh_state", "is_running", "parse_json", "poll_in_modes", "poll_is_editable", "read_only_reason",
           "remove_object", "rename", "report_errors", "resolve_object", "rollback_on_error", "run_steps",
           "select_outside_edit_mode", "start_thread"]
