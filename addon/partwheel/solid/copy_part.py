# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_copy, mesh.partwheel_remove: parts as solids."""

import bpy

from ..mesh import (MeshSnapshot, NeedsActiveMesh, Refused, Steps, arrays, go_to_object_mode, report_errors, return_to_mode,
                    rollback_on_error, run_steps)
from ..mesh.selection import KINDS, is_exact_selection
from ..parts import picks, registry
from ..pick import borders
from ..pick.build import BuildsFirst, build_and_wait, filter_without_hierarchy
from . import composition, solids
from partwheel import Hierarchy
from partwheel.likeness import best_node

MIN_OVERLAP = 0.9  # overlap of the selected faces with a part, to count as this part


class PartsOperator(NeedsActiveMesh):
    """Base of operators on an object with parts: leaves and reenters Edit Mode, reports errors."""

    bl_options = {"REGISTER", "UNDO"}
    edits_mesh = False  # whether it changes the mesh itself: then it returns to Edit Mode

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.active_object
        self.check(obj)
        if not build_and_wait(self, context, MeshSnapshot(obj)):
            return {"CANCELLED"}
        return run_steps(self._steps(context, obj))

    def _execute_in_window(self, context: bpy.types.Context) -> set[str]:
        self.check(context.active_object)
        return self._run_steps(context, self._steps(context, context.active_object))

    def _steps(self, context: bpy.types.Context, obj: bpy.types.Object) -> Steps:
        hierarchy = self.require_hierarchy(obj)
        for sentence in self.loss_messages(obj):
            self.report({"WARNING"}, sentence)
        plan = yield from self.plan(obj, hierarchy)
        if registry.get_hierarchy(MeshSnapshot(obj)) is not hierarchy:
            raise Refused("The mesh {name} has changed in the meantime. Try again.", name=obj.data.name)
        with rollback_on_error():
            self._run_in_object_mode(context, obj, hierarchy, plan)
        return {"FINISHED"}

    def plan(self, _obj: bpy.types.Object, _hierarchy: Hierarchy) -> Steps:
        """Steps that compute what run() needs and change nothing."""
        return
        yield

    def run(self, context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy, plan: object) -> None:
        """Change Blender's data. plan: what the steps of plan() return."""
        raise NotImplementedError

    def _run_in_object_mode(self, context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy,
                            plan: object) -> None:
        mode = obj.mode
        go_to_object_mode(obj, self.options.is_repeat)
        self.run(context, obj, hierarchy, plan)
        if self.edits_mesh:
            return_to_mode(mode)

    def loss_messages(self, _obj: bpy.types.Object) -> list[str]:
        """Warnings about what will be lost."""
        return []

    def _objects_to_build(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        self.check(context.active_object)
        return filter_without_hierarchy([context.active_object])

    def check(self, obj: bpy.types.Object) -> None:
        """Raises Refused for what is wrong before the parts are found."""

    def require_hierarchy(self, obj: bpy.types.Object) -> Hierarchy:
        """The object's hierarchy. Raises Refused."""
        return registry.require_hierarchy(MeshSnapshot(obj))


class PartOperator(PartsOperator):
    """Base of operators that cut out a part: the given node, else the last pick, else the selected faces.
    removes_faces: the mesh loses the part's faces, so these must be what the user has selected."""

    removes_faces = False

    snap: bpy.props.BoolProperty(
        name="Snap Border", description="Move the border of the part to the creases nearby, as far as the inside of "
                                        "the model allows",
        default=True)
    node: bpy.props.IntProperty(
        name="Part", description="Number of the part; -1: the last pick",
        default=-1, min=-1, options={"SKIP_SAVE"})

    def check(self, obj: bpy.types.Object) -> None:
        if self.node < 0 and not picks.get_pick_for_poll(obj) and not _has_selected_faces(obj):
            raise Refused(picks.NO_PICK)

    def require_hierarchy(self, obj: bpy.types.Object) -> Hierarchy:
        snapshot = MeshSnapshot(obj)
        uses_pick, pick = self.node < 0, picks.get_pick(snapshot)
        if uses_pick and not pick and _has_selected_faces(obj):
            hierarchy = registry.require_hierarchy(snapshot)
            self.node, overlap = best_node(hierarchy, arrays.read(obj.data.polygons, "select", bool))
            if overlap < MIN_OVERLAP:
                raise Refused("The selection is not a part. Pick one with Select Part by Wheel, and confirm it.")
        hierarchy, node = picks.resolve_node(snapshot, self.node)
        if uses_pick and self.removes_faces and not _is_part_selected(snapshot, hierarchy, node, [pick.snap] if pick
                                                                      else [False, True]):
            raise Refused("The selection must be exactly one whole part. Pick the part again with Select Part by "
                          "Wheel, and confirm it.")
        self.node = node
        return hierarchy


def _has_selected_faces(obj: bpy.types.Object) -> bool:
    """Whether faces are selected in Edit Mode: without a pick since the last edit, they define the part."""
    return obj.mode == "EDIT" and obj.data.total_face_sel > 0


def _is_part_selected(snapshot: MeshSnapshot, hierarchy: Hierarchy, node: int, snaps: list[bool]) -> bool:
    """Whether exactly the part's faces are selected. snaps: borders to compare: the part's own, that in creases."""
    modes = bpy.context.tool_settings.mesh_select_mode
    kind = next(kind for kind, on in zip(KINDS, modes) if on)
    return any(is_exact_selection(snapshot.mesh, borders.get_part_faces(snapshot, hierarchy, node, snap), kind)
               for snap in snaps)


class CapProperties:
    """Properties of operators that create caps."""

    smooth: bpy.props.BoolProperty(name="Smooth Caps", description="Close with a smooth surface instead of flat facets")
    material: bpy.props.BoolProperty(name="Cap Material", description="Give the caps a material of their own")

    def cap_options(self) -> solids.CapOptions:
        return solids.CapOptions(self.smooth, self.material)


class MESH_OT_partwheel_copy(PartOperator, BuildsFirst, CapProperties, bpy.types.Operator):
    """Copy the picked part as a solid: a new object, closed where it was cut; Ctrl C, Ctrl V take it to other files"""

    bl_idname = "mesh.partwheel_copy"
    bl_label = "Copy Part as Solid"
    loss_messages = staticmethod(composition.loss_messages)

    def run(self, context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy, _plan: None) -> None:
        select_only(context, [composition.create_part_object(obj, hierarchy, self.node, self.cap_options(), self.snap)])


class MESH_OT_partwheel_remove(PartOperator, BuildsFirst, CapProperties, bpy.types.Operator):
    """Remove the picked part from the mesh and close the hole"""

    bl_idname = "mesh.partwheel_remove"
    bl_label = "Remove Part"
    needs_editable = edits_mesh = removes_faces = True
    loss_messages = staticmethod(composition.bound_modifier_messages)

    def run(self, context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy, _plan: None) -> None:
        composition.remove_part(obj, hierarchy, self.node, self.cap_options(), self.snap)


def select_only(context: bpy.types.Context, objects: list[bpy.types.Object]) -> None:
    """Selects these objects and no other; the first becomes active."""
    for other in context.selected_objects:
        other.select_set(False)
    for obj in objects:
        obj.select_set(True)
    context.view_layer.objects.active = objects[0]
