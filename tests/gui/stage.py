"""The stage that scenarios play on: opens models in Blender's window, sends events, waits, checks, takes pictures.

A scenario is a generator, play(stage), advanced by a Blender timer. It yields (what, predicate) to let Blender run until
predicate() holds, mostly through the methods below: `yield from stage.selected(faces, "after the click")`.

How fast the machine is must not matter: nothing is bounded in seconds but what never happens.
"""
import contextlib
import importlib
import json
import os
import re
import subprocess
import sys
import time
import traceback

import addon_utils
import bmesh
import bpy
import numpy
from bl_ui.space_toolsystem_toolbar import VIEW3D_PT_tools_active
from mathutils import Euler, Matrix, Quaternion, Vector

from events import DRIVERS
from gate import Gate
from model import Wheels
from view import View, picture

WAIT = int(os.environ.get("PARTWHEEL_WAIT", 600))  # seconds until something counts as never happening, far more than a machine under load needs for it
TICK = 0.01  # seconds
SLOW = 1.0  # seconds for one step; the log tells which took longer
FILL = 0.8  # share of the viewport's height or width that an opened model takes
# How each model is looked at, in its own space: the rotation that the view has (w, x, y, z).
VIEWS = {"hand": (0.7071, 0.7071, 0, 0), "homer": (1, 0, 0, 0), "bear": (1, 0, 0, 0), "armadillo": (0, 0, 1, 0),
         "large": (0, 0, 1, 0), "elephant": (0.7071, 0.7071, 0, 0), "dino": (0.5, 0.5, 0.5, 0.5), "figure": (0.7071, 0.7071, 0, 0),
         "character": (0.7071, 0.7071, 0, 0), "million": (1, 0, 0, 0), "shells": (1, 0, 0, 0)}


class Failure(Exception):
    """What the scenario expected and did not see."""


class WM_OT_stage_timers(bpy.types.Operator):
    """Counts the events of timers that others have started, while one of its own ticks some times"""

    bl_idname = "wm.stage_timers"
    bl_label = "Count Timers"
    SLOWEST, TICKS = 0.1, 5  # seconds between the ticks of the add-on's slowest timer; by Blender's clock, busy or not
    own = others = 0

    def invoke(self, context, _event):
        self.timer = context.window_manager.event_timer_add(self.SLOWEST, window=context.window)
        self.ran = self.timer.time_duration
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        counts = WM_OT_stage_timers
        if event.type == "TIMER":  # which timer's is not said, but its own has run on when it is its own
            is_own, self.ran = self.timer.time_duration != self.ran, self.timer.time_duration
            counts.own, counts.others = counts.own + is_own, counts.others + (not is_own)
        if counts.own < self.TICKS:
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self.timer)
        return {"FINISHED", "PASS_THROUGH"}


class Stage:
    def __init__(self, driver, looks, work, pictures, result):
        self._work, self._pictures, self._result = work, pictures, result
        self._driver, self._looks = driver, looks
        self.checks, self.skipped = 0, ""
        self._ticks = self._draws = 0
        self._noted = time.monotonic()
        self.mouse = None

    # ---- Running ------------------------------------------------------------------------------------------------

    def play(self, scenario):
        bpy.types.SpaceView3D.draw_handler_add(self._count_draw, (), "WINDOW", "POST_PIXEL")
        self._watch_drawing()
        steps = self._all(scenario)
        waiting = None  # (what, predicate, when it counts as never happening)

        def tick():
            nonlocal waiting
            self._ticks += 1
            try:
                if waiting:
                    what, predicate, deadline = waiting
                    if not predicate():
                        if time.monotonic() > deadline:
                            raise Failure(f"{_text(what)}: not seen in time")
                        time.sleep(TICK)  # with --enable-event-simulate Blender itself never does, and keeps a core busy
                        return 0
                    self._note(what, time.monotonic())
                what, predicate = next(steps)
                self._note("the scenario itself", time.monotonic())
                waiting = what, predicate, time.monotonic() + WAIT
                return 0
            except StopIteration:
                self._end("")
            except Failure as failure:
                self._picture("failed")
                self._end(str(failure))
            except Exception as error:  # the timer's last chance to report: nothing is swallowed
                traceback.print_exc()
                self._end(f"{type(error).__name__}: {error}")
            return None

        bpy.app.timers.register(tick, persistent=True)  # over the opening of files

    def _note(self, what, now):
        """Tells the log what took long."""
        if now - self._noted > SLOW:
            print(f"{now - self._noted:.1f} s: {_text(what)}", flush=True)
        self._noted = now

    def _all(self, scenario):
        yield "a first draw of the 3D viewport", lambda: self._draws > 0
        if self._looks == "plain":
            draw_plainly()
        self.mouse = DRIVERS[self._driver](self.window)
        self.part("preferences").preferences().use_view = False  # scenarios know the start level, whatever the view
        yield from scenario(self)
        yield from self._nothing_left()

    def _watch_drawing(self):
        """Blender can't tell what draws in its views, so it is written down from now on."""
        view, self._drawing = bpy.types.SpaceView3D, []
        add, remove = view.draw_handler_add, view.draw_handler_remove

        def added(*arguments):
            self._drawing.append(add(*arguments))
            return self._drawing[-1]

        def removed(handler, region):
            remove(handler, region)
            self._drawing.remove(handler)

        view.draw_handler_add, view.draw_handler_remove = staticmethod(added), staticmethod(removed)

    def _nothing_left(self):
        """Checks at the end of every scenario that nothing goes on or is drawn any more; and that the add-on takes
        everything with it when it is disabled: classes, handlers, keys, menu entries, the tool."""
        bpy.utils.register_class(WM_OT_stage_timers)
        yield from self.settle()
        with self.override():
            bpy.ops.wm.stage_timers("INVOKE_DEFAULT")
        counts = WM_OT_stage_timers
        yield "some time has passed", lambda: counts.own >= counts.TICKS
        self.check(counts.others == 0, "no timer runs")
        self.check(not self._drawing, lambda: f"nothing is drawn by the add-on ({self._drawing})")
        self.check(not self.has_builds(), "nothing is being built")
        bar = bpy.types.STATUSBAR_HT_header
        self.check(bar.draw == getattr(bar, "_draw_orig", bar.draw), "the status bar is Blender's own")
        package = self.registry.__name__.rpartition(".parts.")[0]
        addon_utils.disable(package)
        yield from self.wait_for_redraw()  # without the add-on's tool, panels and gizmos
        left = leftovers(package)
        self.check(not left, f"the disabled add-on leaves nothing behind ({left})")

    def _count_draw(self):
        self._draws += 1

    @property
    def draws(self):
        """How often the viewport has been drawn so far."""
        return self._draws

    def _end(self, failure):
        self._result.write_text(json.dumps({"failure": failure, "skipped": self.skipped, "checks": self.checks}))
        with bpy.context.temp_override(window=self.window):  # which may have no 3D view any more
            bpy.ops.wm.quit_blender()

    # ---- Blender's state, looked up afresh each time since undo replaces it ---------------------------------------

    @property
    def window(self):
        return bpy.data.window_managers[0].windows[0]

    @property
    def area(self):
        return next(area for area in self.window.screen.areas if area.type == "VIEW_3D")

    @property
    def view_3d(self):
        return self.area.spaces.active.region_3d

    @property
    def object(self):
        return self.window.view_layer.objects.active

    @property
    def view(self):
        return self._view()

    def _view(self, quarter=None):
        return View(self.area, self.object, self.wheels.vertices, self.wheels.triangles, quarter)

    def override(self):
        region = next(region for region in self.area.regions if region.type == "WINDOW")
        return bpy.context.temp_override(window=self.window, area=self.area, region=region)

    @property
    def last(self):
        """The last operation, of those that can be repeated."""
        return bpy.data.window_managers[0].operators[-1]

    def adjusted(self, **options):
        """What the panel of the last operation does when the user changes these in it; True: with its step in the history.
        An operation may begin a build, which old Pythons don't survive under temp_override(), see worker/job.py; and
        newer Blenders crash without a window."""
        for name, value in options.items():
            setattr(self.last.properties, name, value)
        with self.override() if bpy.app.version >= (4, 2) else contextlib.nullcontext():
            bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)
        yield from self.settle()

    def selection(self, kind="faces"):
        """Indices of the selected "faces", "edges" or "verts"."""
        elements = getattr(bmesh.from_edit_mesh(self.object.data), kind)
        return frozenset(element.index for element in elements if element.select)

    def kind(self):
        """What the select mode selects."""
        mode = self.window.scene.tool_settings.mesh_select_mode
        return next(kind for kind, on in zip(("verts", "edges", "faces"), mode) if on)

    def elements(self, faces, kind):
        """The faces themselves, or their vertices or edges."""
        if kind == "faces":
            return frozenset(faces)
        polygons = [self.object.data.polygons[face] for face in faces]
        if kind == "verts":
            return frozenset(vertex for polygon in polygons for vertex in polygon.vertices)
        sides = {side for polygon in polygons for side in polygon.edge_keys}
        return frozenset(edge.index for edge in self.object.data.edges if edge.key in sides)

    def whole_selection(self):
        """All that belongs to a selection, to be compared: its elements of every kind, their order, the active one."""
        bm = bmesh.from_edit_mesh(self.object.data)
        active = bm.select_history.active
        return {**{kind: self.selection(kind) for kind in ("faces", "edges", "verts")},
                "history": [(type(element).__name__, element.index) for element in list(bm.select_history)],
                "active": active and (type(active).__name__, active.index)}

    def reports(self):
        """All that Blender has reported so far, as the Info editor shows it."""
        area = next(area for area in self.window.screen.areas if area.type == "DOPESHEET_EDITOR")
        area.ui_type = "INFO"
        with bpy.context.temp_override(window=self.window, area=area):
            bpy.ops.info.select_all(action="SELECT")
            bpy.ops.info.report_copy()
        area.ui_type = "TIMELINE"
        return bpy.data.window_managers[0].clipboard

    def coordinates(self):
        """(V,3) of the mesh as it is being edited."""
        return numpy.array([vertex.co for vertex in bmesh.from_edit_mesh(self.object.data).verts])

    def view_state(self):
        """What navigation changes: (view matrix, distance) as plain numbers."""
        return [tuple(row) for row in self.view_3d.view_matrix], self.view_3d.view_distance

    def part(self, name):
        """A module of the add-on."""
        package = bpy.types.VIEW3D_PT_partwheel.__module__.rpartition(".ui.")[0]
        return sys.modules[f"{package}.{name}"]

    def snapshot(self, obj):
        """A MeshSnapshot of the object as it is now."""
        return self.part("mesh.snapshot").MeshSnapshot(obj)

    def package(self, name=""):
        """The Python package that the add-on brings, or a module of it."""
        return importlib.import_module(f"partwheel.{name}".rstrip("."))

    @property
    def registry(self):
        """The add-on's module that knows what is built."""
        return self.part("parts.registry")

    @property
    def builds(self):
        """The one that knows what is being built."""
        return self.part("parts.builds")

    def has_builds(self):
        """Whether any build has not ended."""
        return bool(self.builds._builds)

    def hold_workers(self):
        """A closed Gate: workers that are started from now on wait until it is opened."""
        return Gate(self.package("worker.job"))

    def use_tool(self):
        """Makes the add-on's tool the active one of the toolbar."""
        with self.override():
            bpy.ops.wm.tool_set_by_id(name="partwheel.select")

    def hovered(self):
        """The faces of the part that hover shows, or None."""
        target = self.part("pick.hover").hover.target
        return target and frozenset(target[1].hierarchy.faces(target[2]).tolist())

    def overlay_faces(self):
        """The faces of the part that the overlay shows as picked, or None."""
        target = self.part("pick.display").pick_display._target
        return target and frozenset(target[1].hierarchy.faces(target[2]).tolist())

    def drawn_things(self):
        """How many handlers of the add-on draw in the 3D views."""
        return int(self.part("pick.display").pick_display.is_shown)

    # ---- Setting the scene ----------------------------------------------------------------------------------------

    def open(self, name, mode="FACE", build=True):
        """Makes the model the only object: in Edit Mode, in this select mode, framed; with its hierarchy, if build."""
        self.wheels = Wheels(self._work / f"{name}.npz")
        for obj in list(bpy.data.objects):
            bpy.data.objects.remove(obj)
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(self.wheels.vertices, [], self.wheels.triangles.tolist())
        mesh.update()
        model = bpy.data.objects.new(name, mesh)
        self.window.scene.collection.objects.link(model)
        self.window.view_layer.objects.active = model
        model.select_set(True)
        # Turned, moved and scaled to about two units: picking has to get through the object's matrix.
        low, high = self.wheels.vertices.min(axis=0), self.wheels.vertices.max(axis=0)
        scale = 2 / (high - low).max()
        model.matrix_world = (Matrix.Translation((0.3, -0.2, 0.5)) @ Euler((0.1, 0.2, 0.3)).to_matrix().to_4x4()
                              @ Matrix.Scale(scale, 4) @ Matrix.Translation(-(low + high) / 2))
        with self.override():
            bpy.ops.object.mode_set(mode="EDIT")
            self.window.scene.tool_settings.mesh_select_mode = [mode == select_mode for select_mode in ("VERT", "EDGE", "FACE")]
            if build:
                bpy.ops.mesh.partwheel_build()
            else:
                self.part("parts.files").on_load()  # or the parts of the same model, opened before, would serve
        self.tidy()
        self.view_3d.view_rotation = model.matrix_world.to_quaternion() @ Quaternion(VIEWS[name])
        self.view_3d.view_perspective = "PERSP"
        self.view_3d.view_location = model.matrix_world @ Vector((low + high) / 2)
        self.view_3d.view_distance = 4
        yield from self.wait_for_redraw()
        view = self.view
        extent = numpy.ptp(view.centers(), axis=0) / [view.region.width, view.region.height]
        self.view_3d.view_distance *= extent.max() / FILL
        self.select(())
        yield from self.wait_for_redraw()

    def tidy(self):
        """For pictures: hides what is not the model, on a light background."""
        if self._looks != "full":
            return
        space = self.area.spaces.active
        for name in ("floor", "axis_x", "axis_y", "text", "cursor", "object_origins", "relationship_lines"):
            setattr(space.overlay, f"show_{name}", False)
        space.show_gizmo_navigate = space.show_region_toolbar = space.show_region_hud = False
        space.shading.background_type, space.shading.background_color = "VIEWPORT", (0.75, 0.77, 0.8)

    def shortcut(self, operator):
        """Presses the key that the user's keymap has for an operator of Edit Mode."""
        keymap = bpy.data.window_managers[0].keyconfigs.user.keymaps["Mesh"]
        item = next((item for item in keymap.keymap_items if item.idname == operator and item.active), None)
        self.check(item is not None, f"the Mesh keymap has a key for {operator}")
        self.mouse.key(item.type, **{name: True for name in ("shift", "ctrl", "alt") if getattr(item, name)})

    def select(self, indices, kind="faces"):
        """Selects exactly these faces (edges, verts), the last one active, as an undo step of its own."""
        with self.override():
            bpy.ops.mesh.select_all(action="DESELECT")
            bm = bmesh.from_edit_mesh(self.object.data)
            elements = getattr(bm, kind)
            elements.ensure_lookup_table()
            for index in indices:
                elements[index].select_set(True)
                bm.select_history.add(elements[index])
                if kind == "faces":
                    bm.faces.active = elements[index]
            bmesh.update_edit_mesh(self.object.data)
            bpy.ops.ed.undo_push(message="Test selection")

    def spot(self, x, y, above=0, quarter=None, more_than=0):
        """(x, y, face) of the safest pixel near a place given as shares (0..1) of the model's extent on the screen, of
        a face whose wheel has at least so many stops above the start, and more than more_than in all. quarter: see View."""
        def wanted(face):
            stops, start = self.wheels.stops(face)
            return len(stops) > max(start + above, more_than)

        view = self._view(quarter)
        centers = view.centers()
        low, high = centers.min(axis=0), centers.max(axis=0)
        return view.spot(*(low + (high - low) * [x, y]), wanted)

    def empty_spot(self):
        """(x, y) of a pixel of the viewport that shows no face and no gizmo."""
        region, view = self.view.region, self.view
        x, y = region.x + region.width // 5, region.y + region.height // 6
        self.check(view.face_around(x, y, 20) is None and view.face_at(x, y) is None, "the empty spot is empty")
        return x, y

    def pick(self, x, y, above=0, more_than=0):
        """Starts the tool by its key over a spot() and waits for its part: (face, its wheel's stops, the index of the
        first)."""
        px, py, face = self.spot(x, y, above, more_than=more_than)
        stops, start = self.wheels.stops(face)
        self.mouse.move(px, py)
        self.shortcut("mesh.partwheel_select")
        yield from self.selected(stops[start], "after the start")
        return face, stops, start

    def parts_to(self, x, y, *keys):
        """Parts to... with the mouse there, then these keys."""
        self.mouse.move(x, y)
        with self.override():
            bpy.ops.mesh.partwheel_parts("INVOKE_DEFAULT")
        yield from self.wait_for_redraw()
        for key in keys:
            self.mouse.key(key)

    def record_cuts(self):
        """(the states that Parts to... shows from now on, a function that ends it); without a reference to the operator."""
        states, operator = [], self.part("cut.parts_to").MESH_OT_partwheel_parts
        show = operator._set_state

        def shown(self, context, state):
            states.append(state)
            return show(self, context, state)

        operator._set_state = shown
        return states, lambda: setattr(operator, "_set_state", show)

    def take(self, spot, when, notches=1):
        """Hover, a click with the tool and notches up take the part at a spot(): (its wheel's stops, the index of the
        first)."""
        x, y, face = spot
        stops, start = self.wheels.stops(face)
        self.mouse.move(x - 3, y)
        self.mouse.move(x, y)
        yield from self.until(f"hover shows the part of a click ({when})", lambda: self.hovered() == stops[start])
        self.mouse.click()
        yield from self.selected(stops[start], f"after a click ({when})")
        if notches:
            self.mouse.wheel(notches)
            yield from self.selected(stops[start + notches], f"after notches up: {notches} ({when})")
        return stops, start

    # ---- Waiting and checking -------------------------------------------------------------------------------------

    def check(self, truth, what):
        if not truth:
            raise Failure(f"{_text(what)}: does not hold")
        self.checks += 1

    def until(self, what, predicate):
        yield what, predicate
        self.checks += 1

    def settle(self):
        """Waits until the events sent so far have been handled, for checks that something does not happen.

        A simulated event is handled before the timer's next tick. For a real one ten ticks make that very likely;
        should it come later still, such a check could pass wrongly, never fail wrongly.
        """
        target = self._ticks + (2 if self._driver == "simulate" else 10)
        yield "events handled", lambda: self._ticks >= target

    def drag(self, button, dx, dy, **modifiers):
        """Drags the mouse from where it is. Waits in between: Blender gives all events that it finds at once the same
        position, the last."""
        x, y = self.mouse.x, self.mouse.y
        self.mouse.press(button, **modifiers)
        yield from self.settle()
        for step in range(1, 5):
            self.mouse.move(x + dx * step // 4, y + dy * step // 4, **modifiers)
        yield from self.settle()
        self.mouse.release(button, **modifiers)
        yield from self.settle()

    def wait_for_redraw(self):
        """Waits until the viewport has been drawn twice, the second time with all that is there now."""
        for _ in range(2):
            target = self._draws + 1
            self.area.tag_redraw()
            yield "the viewport is drawn", lambda: self._draws >= target

    def sidebar(self):
        """Opens the sidebar and goes to our tab: its region."""
        self.area.spaces.active.show_region_ui = True
        yield from self.wait_for_redraw()
        sidebar = next(region for region in self.area.regions if region.type == "UI")
        self.mouse.move(sidebar.x + sidebar.width - 8, sidebar.y + sidebar.height - 40)
        for _ in range(6):  # over the tabs, Ctrl and the wheel go from one to the next; ours is the last
            self.mouse.wheel(-1, ctrl=True)
        return sidebar

    def selected(self, faces, when):
        """Waits until exactly these faces are selected, then checks that they stay so. In the vertex and edge select
        modes: until exactly their vertices, or edges, are."""
        kind = self.kind()
        expected = self.elements(faces, kind)

        def difference():
            current = self.selection(kind)
            return (f"{when}, exactly {len(expected)} {kind} selected"
                    f" (now {len(current)}: {len(current - expected)} too many, {len(expected - current)} missing)")

        yield difference, lambda: self.selection(kind) == expected
        yield from self.settle()
        self.check(self.selection(kind) == expected, difference)

    def ended(self):
        """Checks that the operator has ended: the wheel zooms again and leaves the selection alone; and that nothing of
        it is left: what it drew, its status text, its build."""
        yield from self.settle()
        self.check(self.drawn_things() == 0, "the overlay is gone")
        bar = bpy.types.STATUSBAR_HT_header
        self.check(bar.draw == getattr(bar, "_draw_orig", bar.draw), "the status bar is Blender's own again")
        self.check(not self.has_builds(), "nothing is being built")
        selection, distance = self.selection(), self.view_3d.view_distance
        self.mouse.wheel(1)
        yield from self.until("the wheel zooms again", lambda: self.view_3d.view_distance < distance)
        self.mouse.wheel(-1)
        yield from self.until("the wheel zooms back", lambda: abs(self.view_3d.view_distance - distance) < 1e-3)
        yield from self.wait_for_redraw()  # only then the view's matrices are those of that distance again
        self.check(self.selection() == selection, "the wheel has left the selection alone")

    # ---- Pictures -------------------------------------------------------------------------------------------------

    def screenshot(self, name):
        """Saves the screen as build/gui/SCENARIO-NAME.png once all is drawn; returns its path."""
        yield from self.wait_for_redraw()
        return self._picture(name)

    def bar_fits(self, path):
        """Checks on a picture that the status bar says something, and that the window doesn't cut it off: beyond its
        end there is more space than between any two of its entries."""
        bar = picture(path)[3:17, :-2, :3]
        self.check(numpy.ptp(bar[:, :100]) > 0.2, "the status bar says something")
        self.check(numpy.ptp(bar[:, -24:]) < 0.05, "all that it says can be seen")

    def file(self, name):
        """A path for a file that the scenario makes; it is gone after the run."""
        return self._work / name

    def _picture(self, name):
        path = self._pictures.with_name(f"{self._pictures.name}-{name}.png")
        subprocess.run(["import", "-window", "root", "-define", "png:compression-level=1", str(path)], check=True)
        return path


def draw_plainly():
    """Leaves out what takes the processor more than half of the time of a drawing and no test looks at."""
    system = bpy.context.preferences.system
    system.use_overlay_smooth_wire = system.use_edit_mode_smooth_wire = False
    for space in (area.spaces.active for screen in bpy.data.screens for area in screen.areas if area.type == "VIEW_3D"):
        overlay, shading = space.overlay, space.shading
        overlay.show_floor = overlay.show_axis_x = overlay.show_axis_y = False
        shading.show_object_outline = shading.show_shadows = shading.show_specular_highlight = False


def leftovers(package):
    """What of a disabled add-on Blender still knows, by name."""
    package_name = package.rpartition(".")[2]
    remains = [name for name in dir(bpy.types) if package_name in name.lower()]
    handlers = [handler_list for handler_list in (getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers))
                if isinstance(handler_list, list)]
    menus = [menu.draw for menu in (getattr(bpy.types, name) for name in dir(bpy.types)) if hasattr(menu, "draw")]
    functions = [each for some in handlers for each in some] + [
        each for draw in menus for each in getattr(draw, "_draw_funcs", ())]
    remains += [f"{function.__module__}.{function.__qualname__}" for function in functions if function.__module__.startswith(package)]
    keys = bpy.data.window_managers[0].keyconfigs
    for configuration in (keys.default, keys.addon):  # the third, the user's, keeps what any tool once had
        remains += [f"a key of {configuration.name}, {keymap.name}" for keymap in configuration.keymaps
                  for item in keymap.keymap_items if package_name in item.idname]
    tools = VIEW3D_PT_tools_active._tools["EDIT_MESH"]
    return remains + [name for name in re.findall(r"idname='([^']*)'", repr(tools)) if package_name in name]


def _text(what):
    """A sentence, or a function that makes one when it is needed: of the state at that time."""
    return what() if callable(what) else what

