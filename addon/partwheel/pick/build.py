# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_build finds the parts of the active mesh; mesh.partwheel_clear removes them.

Also shows builds to the user: in the background, with the progress at the cursor and in the status bar; or, for
scripts and without windows, blocking."""

from collections.abc import Callable, Iterable
import re
import time

import bpy

from ..library_error import describe_error
from ..parts import builds, registry
from partwheel import Error, Hierarchy, PartwheelError, Status
from ..mesh import MeshSnapshot, NeedsActiveMesh, check_poll, find_object, poll_is_editable
from ..mesh.faulty_elements import point_out
from ..view import overlay, status
from ..view.in_view import TICK, InView
from ..translations.lookup import iface_, format_percent, rpt_, translate_error

# Fill method -> how the panel describes it. off: deviation from the mesh, as a fraction of its size.
FILL_DESCRIPTIONS = {
    "exact": "From the mesh as it is", "repaired": "Repaired copy, {off} off",
    "points": "Filled from points, {off} off", "sheet": "Filled as thin solids, {off} off",
}
PROXY_DESCRIPTION = "Coarser copy, {off} off"


def describe_fill(hierarchy: Hierarchy) -> str:
    """Return a line on how the mesh was filled to find its parts."""
    summary = hierarchy.summary
    description = PROXY_DESCRIPTION if summary.proxy_triangles else FILL_DESCRIPTIONS[summary.fill_method]
    line = iface_(description).format(off=format_percent(summary.deviation))
    return line if summary.shells == 1 else f"{iface_('{count:,} shells').format(count=summary.shells)}: {line}"


def describe_marks(hierarchy: Hierarchy) -> list[str]:
    """Return a sentence for each kind of marks that was found."""
    return re.findall(r"Marks: .*?\.(?= |$)", hierarchy.notes)


class BuildMonitor:
    """A build that an operator requests and whose result the operator reports.

    hierarchy: the result; None before the end, and after an error."""

    def __init__(self, operator: bpy.types.Operator, snapshot: MeshSnapshot, **options: object) -> None:
        """options: of builds.request_build(). Raises Error if the build can't start."""
        state = snapshot.state
        self.operator, self.object_name, self.hierarchy = operator, snapshot.obj.name_full, None
        self.start_time = time.perf_counter()
        self.build = builds.request_build(snapshot, **options)
        is_from_newer_version, state.is_from_newer_version = state.is_from_newer_version, False
        if is_from_newer_version:
            operator.report({"WARNING"}, rpt_(
                "The parts saved with {name} come from a newer version of Partwheel, so they are found again. Update "
                "Partwheel to use the saved parts.").format(name=snapshot.mesh.name))
        self.timer, self.status_line = None, status.StatusLine()
        self.printed_percent = 0

    # ---- Blocking

    def wait(self, context: bpy.types.Context) -> Hierarchy | None:
        """Wait and return the hierarchy. Shows the progress at the cursor, or without windows in the terminal."""
        try:
            self._finish(lambda *progress: self._show(context, *progress))
        finally:
            self._end_progress(context)
        return self.hierarchy

    # ---- In the background

    def watch(self, context: bpy.types.Context) -> None:
        """Start to watch: call on_event() with every event from now on. An earlier monitor of the same build ends, so
        the last one gets the parts."""
        self.build.watcher = self
        self.timer = context.window_manager.event_timer_add(TICK, window=context.window)
        self._show_in_status_bar(context, 0.0, "")

    def on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Handle an event and return whether the build has ended, or another monitor has taken it over. Esc cancels the
        build, even if its answer has arrived, as long as a TIMER event has not taken over and shown it."""
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            return True
        if event.type != "TIMER":
            return False
        is_watcher = self.build.watcher is self
        progress = self.build.poll() if is_watcher else None
        if progress:
            self._show(context, *progress)
            self._show_in_status_bar(context, *progress)
            return False
        self._stop_watching(context)
        if is_watcher:
            self._finish()
        return True

    def cancel(self, context: bpy.types.Context) -> None:
        self.build.cancel()
        self._stop_watching(context)
        self._finish()

    def _stop_watching(self, context: bpy.types.Context) -> None:
        if self.timer:
            context.window_manager.event_timer_remove(self.timer)
            self.timer = None
        self._end_progress(context)
        self.status_line.remove(context)

    def _show_in_status_bar(self, context: bpy.types.Context, fraction: float, stage: str) -> None:
        is_waiting = stage and not self.build.job
        text = (iface_("Partwheel finds the parts of {name} after those of {other}") if is_waiting
                else iface_("Partwheel finds the parts of {name}: {fraction:.0%}"))
        text = text.format(name=self.build.name, other=stage, fraction=fraction)
        self.status_line.show(context, "   ".join([text, iface_("Esc: Cancel")]))

    # ---- Both

    def _end_progress(self, context: bpy.types.Context) -> None:
        if not bpy.app.background:
            context.window_manager.progress_end()

    def _show(self, context: bpy.types.Context, fraction: float, stage: str) -> None:
        if not self.build.job:
            return  # the cursor shows the progress of the running build
        percent = int(fraction * 100)
        if not bpy.app.background:
            context.window_manager.progress_begin(0, 100)  # each time, because another build may have ended it
            context.window_manager.progress_update(percent)
        elif percent >= self.printed_percent + 10:
            print(f"Partwheel: {percent:3d} % {stage}", flush=True)
            self.printed_percent = percent

    def _finish(self, progress: Callable[[float, str], object] | None = None) -> None:
        """Take the result over, if there is one, and report."""
        name, report = self.build.name, self.operator.report
        try:
            self.hierarchy = self.build.result(progress)
        except PartwheelError as error:
            if error.status == Status.CANCELED:
                report({"INFO"}, rpt_("Canceled: no parts were found."))
                return
            hints = [rpt_("To do so, use the panel Partwheel in the sidebar.")] * (error.status == Status.NOT_SOLID)
            text = rpt_("No parts for {name}: {reason}").format(name=name, reason=translate_error(error))
            obj = None if self.build.is_outdated() else find_object(self.object_name)
            report({"ERROR"}, " ".join([text, *hints, point_out(obj, error) if obj else ""]).strip())
            return
        except builds.Outdated as reason:
            report({"WARNING"}, str(reason))
            return
        overlay.redraw_views()  # with the tool's header and the panel, which say that there are no parts
        for failure in self.build.job.failures:
            report({"WARNING"}, rpt_("A method that was tried first failed: {reason}").format(
                reason=translate_error(failure)))
        text = rpt_("{name}, {count:,} faces: its parts were found in {seconds:.1f} s.").format(
            name=name, count=len(self.hierarchy.order), seconds=time.perf_counter() - self.start_time)
        report({"INFO"}, f"{text} ({describe_fill(self.hierarchy)})")


def start_build(operator: bpy.types.Operator, snapshot: MeshSnapshot, **options: object) -> BuildMonitor | None:
    """Return a BuildMonitor, or report why there is none and return None."""
    try:
        return BuildMonitor(operator, snapshot, **options)
    except Error as error:
        operator.report({"ERROR"}, rpt_("No parts for {name}: {reason}").format(
            name=snapshot.mesh.name, reason=describe_error(error)))
    return None


def build_and_wait(operator: bpy.types.Operator, context: bpy.types.Context, snapshot: MeshSnapshot) -> Hierarchy | None:
    """Return the hierarchy of the mesh, built now if there is none; or report why not and return None."""
    hierarchy = registry.get_hierarchy(snapshot)
    if not hierarchy:
        building = start_build(operator, snapshot)
        hierarchy = building and building.wait(context)
    return hierarchy


class BuildsFirst(InView):
    """Mixin for operators, listed before those with execute(): in a window, builds parts first, in the background;
    Esc cancels. Then _on_parts_found() continues. All builds are queued at once."""

    buildings = ()

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        return self._start_modal(context, event) if context.window else self.execute(context)

    def _objects_to_build(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        """Return the objects whose parts are needed."""
        return filter_without_hierarchy([context.active_object])

    def _start_build(self, snapshot: MeshSnapshot) -> BuildMonitor | None:
        return start_build(self, snapshot)

    def _on_parts_found(self, context: bpy.types.Context) -> set[str]:
        """Continue if the user has not changed to another object or mode in the meantime."""
        return self._execute_in_window(context) if self._is_still_active(context) else {"CANCELLED"}

    def _execute_in_window(self, context: bpy.types.Context) -> set[str]:
        """What the operator does once there are parts."""
        return self.execute(context)

    def _is_still_active(self, context: bpy.types.Context) -> bool:
        obj = context.active_object
        return obj is not None and obj.name_full == self.object_name and self.poll(context)

    def on_start(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        self.object_name, self.buildings = context.active_object.name_full, []
        objects = self._objects_to_build(context)
        if not objects:
            return self._execute_in_window(context)
        for obj in objects:
            self.buildings += filter(None, [self._start_build(MeshSnapshot(obj))])
        return self._wait_for_next(context, None)

    def _wait_for_next(self, context: bpy.types.Context, hierarchy: Hierarchy | None) -> set[str]:
        if self.buildings:
            return self._wait_for_build(context, self.buildings.pop(0), self._wait_for_next)
        return self._on_parts_found(context) if hierarchy else {"CANCELLED"}

    def can_continue(self, context: bpy.types.Context) -> bool:
        return self._is_still_active(context)

    def on_cancel(self, context: bpy.types.Context) -> None:
        for building in self.buildings:
            building.cancel(context)


class FindsParts(BuildsFirst):
    """Mixin for operators that only find parts."""

    def execute(self, context: bpy.types.Context) -> set[str]:
        buildings = list(filter(None, map(self._start_build, map(MeshSnapshot, self._objects_to_build(context)))))
        return {"FINISHED"} if [building for building in buildings if building.wait(context)] else {"CANCELLED"}

    def _on_parts_found(self, _context: bpy.types.Context) -> set[str]:
        return {"FINISHED"}


def filter_without_hierarchy(objects: Iterable[bpy.types.Object]) -> list[bpy.types.Object]:
    """Return the objects that registry.get_hierarchy() has nothing for."""
    return [obj for obj in objects if not registry.get_hierarchy(MeshSnapshot(obj))]


def filter_without_parts(objects: Iterable[bpy.types.Object]) -> list[bpy.types.Object]:
    """Return one object for each mesh without parts."""
    meshes = {obj.data: obj for obj in objects if obj.type == "MESH"}
    return [obj for mesh, obj in meshes.items() if registry.get_state(mesh)[0] not in registry.USABLE]


class _BuildOperator(NeedsActiveMesh, FindsParts):
    """Base of the operators that build and find."""

    quality: bpy.props.FloatProperty(
        name="Quality", description="0 is fastest and right for nearly all meshes. From 1.1 on, the inside is divided "
                                    "more evenly (1.4 is usual, smaller is slower)", min=0.0, soft_max=3.0)
    full_resolution: bpy.props.BoolProperty(
        name="Full Resolution",
        description="Find the parts of a mesh with more than 200,000 triangles at full resolution, not "
                    "on a coarser copy. Takes about ten times the time and memory. The add-on's "
                    "preferences can set this for all meshes")

    def _objects_to_build(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        return [context.active_object]

    def _start_build(self, snapshot: MeshSnapshot) -> BuildMonitor | None:
        return start_build(self, snapshot, quality=self.quality, full_resolution=self.full_resolution or None)


class MESH_OT_partwheel_build(_BuildOperator, bpy.types.Operator):
    """Find the parts of the active mesh, and of other selected ones that have none, at all sizes for the wheel"""

    bl_idname = "mesh.partwheel_build"
    bl_label = "Find Parts of Mesh"
    bl_options = {"REGISTER"}

    def _objects_to_build(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        obj = context.active_object
        return [obj, *filter_without_parts(other for other in context.selected_objects if other.data != obj.data)]


class MESH_OT_partwheel_find(_BuildOperator, bpy.types.Operator):
    """Find the parts of a mesh that another operator has just created; that operator stays the last operation, with its panel"""

    bl_idname = "mesh.partwheel_find"
    bl_label = "Find Parts"
    bl_options = {"INTERNAL"}


class MESH_OT_partwheel_clear(bpy.types.Operator):
    """Remove the parts of the active mesh, also those saved with the file. The mesh stays as it is"""

    bl_idname = "mesh.partwheel_clear"
    bl_label = "Clear Parts"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        obj = context.active_object
        has_parts = (obj is not None and obj.type == "MESH"
                     and registry.get_state(obj.data)[0] != registry.State.NONE)
        return check_poll(cls, has_parts, "The active object has no parts.") and poll_is_editable(cls, obj)

    def execute(self, context: bpy.types.Context) -> set[str]:
        registry.clear(context.active_object.data)
        overlay.redraw_views()
        return {"FINISHED"}
