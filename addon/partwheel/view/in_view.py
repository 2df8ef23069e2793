# SPDX-License-Identifier: GPL-3.0-or-later
"""The base of all modal operators: start in a 3D view, status texts, and cleanup.

Whatever ends an operator - the user, an error in any step or while drawing, or Blender - nothing of it is left behind."""

import contextlib
from collections.abc import Callable, Iterator, Sequence
import traceback
from typing import Any

import bpy

from ..library_error import describe_error
from partwheel import Error
from . import overlay
from . import status
from ..mesh import Steps
from ..mesh.computation import BackgroundSteps
from ..translations.lookup import get_operator_label, iface_, rpt_
from . import keys

NOTICEABLE = 0.1  # seconds that a computation may block Blender, and Esc
TICK = 0.1  # seconds between polls of a longer one, or of a build


class InView:
    """Mixin for modal operators. Subclasses implement on_start, can_continue, on_event and on_cancel.

    Steps return what invoke() and modal() return. After {"CANCELLED"}, on_cancel() is called. Subclasses that confirm
    on a key do so in on_confirm(context)."""

    bl_options = {"REGISTER", "UNDO"}
    lost_message = "{operator} stopped: the mesh or its mode has changed."

    # ---- Implemented by operators

    def on_start(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """The first step, over a 3D view. The operator continues if this returns {"RUNNING_MODAL"}."""
        raise NotImplementedError

    def can_continue(self, context: bpy.types.Context) -> bool:
        """Return whether the data that the operator works on is as the last step left it."""
        raise NotImplementedError

    def on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        raise NotImplementedError

    def on_cancel(self, context: bpy.types.Context) -> None:
        """Restore the data that the operator has changed. Called after any step, including one that raised."""

    # ---- Steps

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if context.window is None or context.area is None or context.area.type != "VIEW_3D":
            self.report({"ERROR"}, rpt_("{operator}: start this with the mouse over a 3D view.").format(
                operator=get_operator_label(self)))
            return {"CANCELLED"}
        return self._start_modal(context, event)

    def _start_modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self._exit_stack, self._status, self._draw_errors = contextlib.ExitStack(), None, []
        self._status_line, self._computing, self._building = status.StatusLine(), None, None
        return self._run_guarded(context, lambda: self._call_on_start(context, event))

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        return self._run_guarded(context, lambda: self._call_on_event(context, event))

    def cancel(self, context: bpy.types.Context) -> None:
        """Called when Blender itself ends the operator: the window closes, or another file opens."""
        self._run_guarded(context, lambda: {"CANCELLED"})

    def _call_on_start(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        answer = self.on_start(context, event)
        if "RUNNING_MODAL" in answer:
            context.window_manager.modal_handler_add(self)
        return answer

    def _call_on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self._draw_errors:
            raise self._draw_errors[0]
        if self._building:
            return self._on_building(context, event)
        if not self.can_continue(context):
            self.report({"WARNING"}, rpt_(self.lost_message).format(operator=get_operator_label(self)))
            return {"CANCELLED"}
        return self._on_computing(context, event) if self._computing else self.on_event(context, event)

    # ---- Builds

    def _wait_for_build(self, context: bpy.types.Context, building: Any,
                        then: Callable[[bpy.types.Context, Any], set[str]]) -> set[str]:
        """Watch a build.BuildMonitor until it ends, then return what then(context, its hierarchy or None) returns."""
        self._building, self._on_built = building, then
        building.watch(context)
        return {"RUNNING_MODAL"}

    def _on_building(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Meanwhile Blender itself handles all events but Esc."""
        if not self._building.on_event(context, event):
            return {"PASS_THROUGH"}
        building, self._building = self._building, None
        answer = {"CANCELLED"} if event.type == "ESC" else self._on_built(context, building.hierarchy)
        return {"PASS_THROUGH"} if self._building else answer

    # ---- Long computations

    def _run_steps(self, context: bpy.types.Context, steps: Steps) -> set[str]:
        """Run steps that end the operator and return what modal() returns. If they take long, the operator continues:
        the steps run in the background, with the progress in the status bar, and Esc cancels."""
        self._computing = BackgroundSteps(steps)
        self._exit_stack.callback(self._computing.cancel)
        if self._computing.poll(NOTICEABLE) is None:
            return self._computing.result
        self._add_timer(context, TICK)
        self._exit_stack.callback(context.window_manager.progress_end)
        context.window_manager.progress_begin(0, 100)
        return {"RUNNING_MODAL"}

    def _on_computing(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Meanwhile only the view can change: the steps have read the data that they will change."""
        if event.type == "ESC" and event.value == "PRESS":
            self.report({"INFO"}, rpt_("Canceled: nothing has changed."))
            return {"CANCELLED"}
        if event.type == "TIMER":
            fraction = self._computing.poll()
            if fraction is None:
                return self._computing.result
            context.window_manager.progress_update(int(100 * fraction))
            text = iface_("{operator}: {fraction:.0%}").format(operator=get_operator_label(self), fraction=fraction)
            self._show_status(context, text, keys.COMPUTING)
        is_view = event.type in keys.NAVIGATE.events | keys.SYSTEM | keys.MOVES
        return {"PASS_THROUGH"} if is_view else {"RUNNING_MODAL"}

    def _run_guarded(self, context: bpy.types.Context, step: Callable[[], set[str]]) -> set[str]:
        """Run a step. On an error, restore everything, end the operator and report the error."""
        try:
            answer = step()
            if "CANCELLED" in answer:
                self._cancel(context)
            if answer & {"CANCELLED", "FINISHED"}:
                self._end(context)
            return answer
        except Error as error:  # its message is for the user
            self.report({"ERROR"}, describe_error(error))
        except Exception as error:  # any: otherwise the operator's keys and changes would stay
            traceback.print_exception(error)
            self.report({"ERROR"}, rpt_("Partwheel stopped: {reason}. The full report is in the system console.").format(
                reason=error))
        try:
            self._cancel(context)
        finally:
            self._end(context)
        return {"CANCELLED"}

    def _cancel(self, context: bpy.types.Context) -> None:
        if self._building:
            self._building.cancel(context)
        self.on_cancel(context)

    # ---- Added to Blender, and removed at the end

    def _end(self, context: bpy.types.Context) -> None:
        """Remove everything that the operator has added to Blender."""
        with self._exit_stack:
            status_shown, self._status = self._status, None
            self._status_line.remove(context)
            if status_shown and context.area:
                context.area.header_text_set(None)

    def _show_status(self, context: bpy.types.Context, header: str, row: Sequence[keys.Key | keys.Command]) -> None:
        """Show a line in the header of the view, and these keys in the status bar; see status.make_drawer()."""
        if (header, row) != self._status:  # setting either text redraws both bars
            self._status = header, row
            self._status_line.show(context, status.make_drawer(row))
            if context.area:
                context.area.header_text_set(f"Partwheel: {header}")

    def _add_timer(self, context: bpy.types.Context, seconds: float, until: contextlib.ExitStack | None = None) -> None:
        """Send TIMER events until the operator ends, or until this ExitStack closes."""
        manager = context.window_manager
        (until or self._exit_stack).callback(
            manager.event_timer_remove, manager.event_timer_add(seconds, window=context.window))

    def _add_draw_handler(self, function: Callable[[], None], over: str = "POST_VIEW") -> None:
        """Call function() whenever a 3D view is drawn, in world space or, with "POST_PIXEL", in pixels."""
        handler = bpy.types.SpaceView3D.draw_handler_add(self._guard_drawing(function), (), "WINDOW", over)
        self._exit_stack.callback(overlay.redraw_views)
        self._exit_stack.callback(bpy.types.SpaceView3D.draw_handler_remove, handler, "WINDOW")

    def _call_before_saving(self, function: Callable[[], None]) -> None:
        """Call function() before a file is saved, so that the file contains nothing unconfirmed."""
        handlers = bpy.app.handlers.save_pre
        handler = lambda *_: function()
        handlers.append(handler)
        self._exit_stack.callback(lambda: handler in handlers and handlers.remove(handler))  # opening a file removes it

    def _guard_drawing(self, function: Callable[[], None]) -> Callable[[], None]:
        """Return function with errors caught: one ends the operator at its next event, not printed at each drawing."""
        errors = self._draw_errors

        def draw():
            try:
                if not errors:
                    function()
            except Exception as error:  # any: _call_on_event() raises it
                errors.append(error)
        return draw


@contextlib.contextmanager
def show_wait_cursor(context: bpy.types.Context) -> Iterator[None]:
    context.window.cursor_modal_set("WAIT")
    try:
        yield
    finally:
        context.window.cursor_modal_restore()
