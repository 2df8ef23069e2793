# SPDX-License-Identifier: GPL-3.0-or-later
"""What all modal operators share: where they may start, what they tell meanwhile, and that nothing of them is left once
they have ended, whatever ended them: the user, an error in any step or while drawing, Blender itself."""

import contextlib
import traceback

import bpy

from .. import trouble
from partwheel import Error, LibraryError
from . import overlay
from . import status
from ..words.say import label_of, rpt_


class InView:
    """Mixed into an operator. Its steps answer as invoke() and modal() do; "CANCELLED" takes back what they did."""

    lost = "{operator} stopped: the mesh is no longer being edited as it was."

    # ---- What operators differ in

    def _begin(self, context, event):
        """The first step, over a 3D view; the operator goes on if it answers that it is running."""
        raise NotImplementedError

    def _still_there(self, context):
        """Whether what it works on is as the last step left it."""
        raise NotImplementedError

    def _handle(self, context, event):
        """A step."""
        raise NotImplementedError

    def _take_back(self, context):
        """All that it works on is as it was before. Called after any step, even one that broke off in the middle."""

    # ---- Steps

    def invoke(self, context, event):
        if context.window is None or context.area is None or context.area.type != "VIEW_3D":
            self.report({"ERROR"}, rpt_("{operator}: start this with the mouse over a 3D view.").format(
                operator=label_of(self)))
            return {"CANCELLED"}
        return self._started(context, event)

    def _started(self, context, event):
        self._at_end, self._told, self._broken = contextlib.ExitStack(), None, []
        self._line = status.Line()
        return self._guarded(context, lambda: self._begun(context, event))

    def modal(self, context, event):
        return self._guarded(context, lambda: self._next(context, event))

    def cancel(self, context):
        """Blender itself ends the operator: the window closes or another file opens."""
        self._guarded(context, lambda: {"CANCELLED"})

    def _begun(self, context, event):
        answer = self._begin(context, event)
        if "RUNNING_MODAL" in answer:
            context.window_manager.modal_handler_add(self)
        return answer

    def _next(self, context, event):
        if self._broken:
            raise self._broken[0]
        if not self._still_there(context):
            self.report({"WARNING"}, rpt_(self.lost).format(operator=label_of(self)))
            return {"CANCELLED"}
        return self._handle(context, event)

    def _guarded(self, context, step):
        """One step. Whatever goes wrong in it, all is taken back and the operator ends, with a report."""
        try:
            answer = step()
            if "CANCELLED" in answer:
                self._take_back(context)
            if answer & {"CANCELLED", "FINISHED"}:
                self._end(context)
            return answer
        except LibraryError as error:
            self.report({"ERROR"}, trouble.logged(error))
        except Error as error:  # its text is for the user
            self.report({"ERROR"}, str(error))
        except Exception as error:  # any: a tool that dies in the middle leaves Blender with its keys and its changes
            traceback.print_exception(error)
            self.report({"ERROR"}, rpt_("Partwheel stopped: {reason}. The full report is in the system console.").format(
                reason=error))
        try:
            self._take_back(context)
        finally:
            self._end(context)
        return {"CANCELLED"}

    # ---- What is gone at the end

    def _end(self, context):
        with self._at_end:
            told, self._told = self._told, None
            self._line.end(context)
            if told and context.area:
                context.area.header_text_set(None)

    def _tell(self, context, header, row):
        """A line in the view's header, and in the status bar the keys that count, see status.drawer()."""
        if (header, row) != self._told:  # each time both bars are drawn anew
            self._told = header, row
            self._line.say(context, status.drawer(row))
            if context.area:
                context.area.header_text_set(f"Partwheel: {header}")

    def _tick_every(self, context, seconds, until=None):
        """TIMER events from now on; until: an ExitStack at whose end they end, else the operator's."""
        manager = context.window_manager
        (until or self._at_end).callback(
            manager.event_timer_remove, manager.event_timer_add(seconds, window=context.window))

    def _draw_with(self, function, over="POST_VIEW"):
        """function() is called whenever a 3D view is drawn; "POST_PIXEL": in pixels."""
        handler = bpy.types.SpaceView3D.draw_handler_add(self._drawing(function), (), "WINDOW", over)
        self._at_end.callback(overlay.redraw)
        self._at_end.callback(bpy.types.SpaceView3D.draw_handler_remove, handler, "WINDOW")

    def _before_saving(self, function):
        """function() before a file is saved meanwhile, so that it holds nothing that isn't confirmed."""
        handlers = bpy.app.handlers.save_pre
        handler = lambda *_: function()
        handlers.append(handler)
        self._at_end.callback(lambda: handler in handlers and handlers.remove(handler))  # opening a file removes them

    def _drawing(self, function):
        """function, whose errors end the operator at its next event, instead of being printed whenever Blender
        draws."""
        broken = self._broken

        def draw():
            try:
                if not broken:
                    function()
            except Exception as error:  # any, as above
                broken.append(error)
        return draw


@contextlib.contextmanager
def waiting(context):
    """What takes a while has Blender's cursor for it."""
    context.window.cursor_modal_set("WAIT")
    try:
        yield
    finally:
        context.window.cursor_modal_restore()
