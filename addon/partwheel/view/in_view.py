# SPDX-License-Identifier: GPL-3.0-or-later
"""What all modal operators share: where they may start, what they tell meanwhile, and that nothing of them is left once
they have ended, whatever ended them: the user, an error in any step or while drawing, Blender itself."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
import traceback

import bpy

from .. import library_error
from partwheel import Error, LibraryError
from . import overlay
from . import status
from ..words.say import get_operator_label, rpt_
from . import keys


class InView:
    """Mixed into an operator. Its steps answer as invoke() and modal() do; "CANCELLED" takes back what they did."""

    lost_message = "{operator} stopped: the mesh is no longer being edited as it was."

    # ---- What operators differ in

    def on_start(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """The first step, over a 3D view; the operator goes on if it answers that it is running."""
        raise NotImplementedError

    def can_continue(self, context: bpy.types.Context) -> bool:
        """Whether what it works on is as the last step left it."""
        raise NotImplementedError

    def on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """A step."""
        raise NotImplementedError

    def on_cancel(self, context: bpy.types.Context) -> None:
        """All that it works on is as it was before. Called after any step, even one that broke off in the middle."""

    # ---- Steps

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if context.window is None or context.area is None or context.area.type != "VIEW_3D":
            self.report({"ERROR"}, rpt_("{operator}: start this with the mouse over a 3D view.").format(
                operator=get_operator_label(self)))
            return {"CANCELLED"}
        return self._start_modal(context, event)

    def _start_modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self._exit_stack, self._status, self._draw_errors = contextlib.ExitStack(), None, []
        self._status_line = status.StatusLine()
        return self._run_guarded(context, lambda: self._call_on_start(context, event))

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        return self._run_guarded(context, lambda: self._call_on_event(context, event))

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender itself ends the operator: the window closes or another file opens."""
        self._run_guarded(context, lambda: {"CANCELLED"})

    def _call_on_start(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        answer = self.on_start(context, event)
        if "RUNNING_MODAL" in answer:
            context.window_manager.modal_handler_add(self)
        return answer

    def _call_on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self._draw_errors:
            raise self._draw_errors[0]
        if not self.can_continue(context):
            self.report({"WARNING"}, rpt_(self.lost_message).format(operator=get_operator_label(self)))
            return {"CANCELLED"}
        return self.on_event(context, event)

    def _run_guarded(self, context: bpy.types.Context, step: Callable[[], set[str]]) -> set[str]:
        """One step. Whatever goes wrong in it, all is taken back and the operator ends, with a report."""
        try:
            answer = step()
            if "CANCELLED" in answer:
                self.on_cancel(context)
            if answer & {"CANCELLED", "FINISHED"}:
                self._end(context)
            return answer
        except LibraryError as error:
            self.report({"ERROR"}, library_error.log_library_error(error))
        except Error as error:  # its text is for the user
            self.report({"ERROR"}, str(error))
        except Exception as error:  # any: a tool that dies in the middle leaves Blender with its keys and its changes
            traceback.print_exception(error)
            self.report({"ERROR"}, rpt_("Partwheel stopped: {reason}. The full report is in the system console.").format(
                reason=error))
        try:
            self.on_cancel(context)
        finally:
            self._end(context)
        return {"CANCELLED"}

    # ---- What is gone at the end

    def _end(self, context: bpy.types.Context) -> None:
        with self._exit_stack:
            shown, self._status = self._status, None
            self._status_line.remove(context)
            if shown and context.area:
                context.area.header_text_set(None)

    def _show_status(self, context: bpy.types.Context, header: str, row: Sequence[keys.Key | keys.Command]) -> None:
        """A line in the view's header, and in the status bar the keys that count, see status.make_drawer()."""
        if (header, row) != self._status:  # each time both bars are drawn anew
            self._status = header, row
            self._status_line.show(context, status.make_drawer(row))
            if context.area:
                context.area.header_text_set(f"Partwheel: {header}")

    def _add_timer(self, context: bpy.types.Context, seconds: float, until: contextlib.ExitStack | None = None) -> None:
        """TIMER events from now on; until: an ExitStack at whose end they end, else the operator's."""
        manager = context.window_manager
        (until or self._exit_stack).callback(
            manager.event_timer_remove, manager.event_timer_add(seconds, window=context.window))

    def _add_draw_handler(self, function: Callable[[], None], over: str = "POST_VIEW") -> None:
        """function() is called whenever a 3D view is drawn; "POST_PIXEL": in pixels."""
        handler = bpy.types.SpaceView3D.draw_handler_add(self._guard_drawing(function), (), "WINDOW", over)
        self._exit_stack.callback(overlay.redraw_views)
        self._exit_stack.callback(bpy.types.SpaceView3D.draw_handler_remove, handler, "WINDOW")

    def _call_before_saving(self, function: Callable[[], None]) -> None:
        """function() before a file is saved meanwhile, so that it holds nothing that isn't confirmed."""
        handlers = bpy.app.handlers.save_pre
        handler = lambda *_: function()
        handlers.append(handler)
        self._exit_stack.callback(lambda: handler in handlers and handlers.remove(handler))  # opening a file removes them

    def _guard_drawing(self, function: Callable[[], None]) -> Callable[[], None]:
        """function, whose errors end the operator at its next event, instead of being printed whenever Blender
        draws."""
        errors = self._draw_errors

        def draw():
            try:
                if not errors:
                    function()
            except Exception as error:  # any, as above
                errors.append(error)
        return draw


@contextlib.contextmanager
def show_wait_cursor(context: bpy.types.Context) -> Iterator[None]:
    """What takes a while has Blender's cursor for it."""
    context.window.cursor_modal_set("WAIT")
    try:
        yield
    finally:
        context.window.cursor_modal_restore()
