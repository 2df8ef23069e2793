# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_parts: previews a segmentation of the whole model, one color per part. Wheel, clicks and drags edit
it; the result goes to face sets, vertex groups, materials, seams, objects, bones, or pieces for a printer. Nothing
changes before the user confirms."""

from collections.abc import Set
import json

import bpy
import numpy as np

from ..mesh import (MeshSnapshot, Refused, Steps, arrays, element_counts, find_object, go_to_object_mode, labels,
                    poll_in_modes, report_errors, return_to_mode, rollback_on_error, run_steps)
from ..parts import builds, picks, registry
from ..pick.build import start_build
from ..pick.hover import highlight
from ..pick.view_cache import find_nearest_face
from ..solid import composition, copy_part
from ..view import keys, picking
from ..view.in_view import InView
from ..view.visible_surface import NO_FACE
from ..translations.lookup import iface_, rpt_
from . import armature, labeled_cut, objects, print_parts, saved_cut, states, writing
from .display import CutDisplay
from partwheel import Hierarchy
from partwheel.cut import Cut, printing

DEFAULT_RESULTS = {"OBJECT": {"OBJECTS"}, "EDIT_MESH": {"VERTEX_GROUPS"}, "SCULPT": {"FACE_SETS"}}
# What the parts can become: writing.TARGETS, and PRINT.
LABELS = {"FACE_SETS": ("Face Sets", "One for each part; they replace the existing ones"),
          "VERTEX_GROUPS": ("Vertex Groups", "For an armature: smooth across the borders, with a sum of 1"),
          "COLORS": ("Colored Materials", "A material with a color of its own for each part"),
          "MATERIALS": ("Material Slots", "The model's own materials, with a slot for each part"),
          "SEAMS": ("Seams", "For unwrapping: along the borders, in creases, and where a part would not lie flat"),
          "OBJECTS": ("Objects", "Each part becomes an object, parented to its neighbor"),
          "BONES": ("Bones", "An armature with a bone for each part, and its vertex groups, ready to pose"),
          "PRINT": ("For Printing", "Closed objects with flat cuts, pegs and sockets, checked")}
NEEDS_MESH = "Select a mesh object, in Object, Edit or Sculpt Mode."


class MESH_OT_partwheel_parts(InView, copy_part.CapProperties, bpy.types.Operator):
    """Divide the whole model into parts: the wheel changes the number, a click and the wheel one part, a drag merges"""

    bl_idname = "mesh.partwheel_parts"
    bl_label = "Parts to..."

    to: bpy.props.EnumProperty(
        name="Create", description="What to create from the parts; none: only save them in the mesh",
        items=[(name, *label) for name, label in LABELS.items()], options={"ENUM_FLAG", "SKIP_SAVE"}, default=set())
    count: bpy.props.IntProperty(
        name="Parts", description="Number of parts; 0: the parts saved in the mesh, or the automatic segmentation",
        min=0, soft_max=64, max=999, options={"SKIP_SAVE"})
    source: bpy.props.EnumProperty(
        name="Parts From", description="What divides the model at first",
        items=[("AUTOMATIC", "Automatic", "The parts saved in the mesh, or the automatic segmentation"),
               *((source, *labels.SOURCES[source]) for source in labels.SOURCES)], options={"SKIP_SAVE"})
    attribute: bpy.props.StringProperty(
        name="Attribute", description="The face attribute, if the parts come from one", options={"SKIP_SAVE"})
    clusters: bpy.props.StringProperty(
        name="Clusters", description="The parts, as lists of clusters of the tree", options={"HIDDEN", "SKIP_SAVE"})
    keeps_borders: bpy.props.BoolProperty(
        name="Keep Borders", description="The borders of the clusters were chosen: seams stay there",
        options={"HIDDEN", "SKIP_SAVE"})
    own_parts: bpy.props.StringProperty(
        name="Own Parts", description="The parts made by clicks and drags, as lists of clusters of the tree: wheel stops from then on",
        options={"HIDDEN", "SKIP_SAVE"})
    closed: bpy.props.BoolProperty(
        name="Closed", description="Close the objects where they were cut, so that they are solids that add up to "
                                   "the whole",
        default=True)
    origins: bpy.props.BoolProperty(
        name="Origins at Borders", description="Place the origin of each object at the center of its border",
        default=True)
    explode: bpy.props.FloatProperty(
        name="Explode", description="Distance by which the objects move apart, times the distance of their centers. "
                                    "You can change it later in a custom property of the largest object", min=0,
        soft_max=2, options={"SKIP_SAVE"})
    shell: bpy.props.FloatProperty(
        name="Shell", description="Thickness of the walls, by a modifier; 0: solid", min=0, unit="LENGTH")
    unwrap: bpy.props.BoolProperty(
        name="Unwrap", description="Unwrap the mesh along the seams, into a new UV map if there are others",
        default=True)
    joints: bpy.props.EnumProperty(
        name="Joints", description="What holds two pieces together at a cut that is large enough",
        items=[("PEGS", "Pegs", "A peg and a socket"),
               ("SNAP_PINS", "Snap Pins", "Pins of two halves with bumps that snap into their sockets; pegs where they don't fit"),
               ("DOVETAILS", "Dovetails", "Slide into their sockets from one side; pegs where they don't fit"),
               ("DOWELS", "Dowels", "Holes on both sides for dowels or pieces of filament"),
               ("MAGNETS", "Magnets", "A pocket on each side for a magnet"),
               ("NONE", "None", "Flat cuts")])
    insert_diameter: bpy.props.FloatProperty(
        name="Diameter (mm)", description="Of the dowels or magnets that you have", default=3, min=0.5, soft_max=20)
    insert_length: bpy.props.FloatProperty(
        name="Length (mm)", description="Of the dowels, or the height of the magnets", default=10, min=0.5, soft_max=50)
    numbers: bpy.props.BoolProperty(
        name="Numbers", description="Engrave the same number into the two sides of each cut")
    print_material: bpy.props.EnumProperty(
        name="Material", description="What you print with: it decides the clearance of the pegs",
        items=[("CUSTOM", "Custom", "The clearance below"),
               *((name.upper(), name.upper() if len(name) < 5 else name.title(), f"Clearance {gap:g} mm")
                 for name, gap in printing.CLEARANCES.items())])
    clearance: bpy.props.FloatProperty(
        name="Clearance (mm)", description="The gap around each peg, on all sides", default=0.2, min=0, soft_max=1)
    wall: bpy.props.FloatProperty(
        name="Wall (mm)", description="Minimum thickness of the walls around a socket; a message reports thinner "
                                      "walls",
        default=1.2, min=0, soft_max=10)
    bed: bpy.props.FloatVectorProperty(
        name="Bed (mm)", description="Size of the printer's bed: larger parts are split further; 0: no limit",
        default=(0, 0, 0), min=0, soft_max=1000, size=3)
    hide: bpy.props.BoolProperty(name="Hide Original", description="Hide the object that was divided", default=True)

    state = pressed_face = replaced_entry = None
    object_name, mode = "", ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        # Bones leave their armature active, and Blender polls before Adjust Last Operation undoes the operator.
        return (context.mode == "OBJECT" and armature.is_own_armature(context.active_object)
                or poll_in_modes(cls, context, DEFAULT_RESULTS, NEEDS_MESH))

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "count")
        layout.column().prop(self, "to")
        if "SEAMS" in self.to:
            layout.prop(self, "unwrap")
        if "OBJECTS" in self.to:
            for name in ("closed", "smooth", "material", "origins", "explode", "shell"):
                layout.prop(self, name)
        if "PRINT" in self.to:
            inserts = ("insert_diameter", "insert_length") if self.joints in {"DOWELS", "MAGNETS"} else ()
            for name in ("joints", *inserts, "numbers", "print_material", "clearance", "wall", "bed"):
                if name != "clearance" or self.print_material == "CUSTOM":
                    layout.prop(self, name)
        if self.to & {"OBJECTS", "PRINT"}:
            layout.prop(self, "hide")

    # ---- Without a window, and from Adjust Last Operation

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = self._find_model(context)
        snapshot, face_labels = MeshSnapshot(obj), self._read_labels(obj)
        hierarchy = registry.get_hierarchy(snapshot) if self.clusters else labeled_cut.find_exact_hierarchy(snapshot, face_labels)
        if not hierarchy:
            building = start_build(self, snapshot, **labeled_cut.build_options(face_labels))
            hierarchy = building and building.wait(context)
        if not hierarchy:
            return {"CANCELLED"}
        return run_steps(self._write(context, obj, *self._cut_from_options(obj, hierarchy)))

    def _find_model(self, context: bpy.types.Context) -> bpy.types.Object:
        """The active object. Raises Refused if it is an armature."""
        if context.active_object.type != "MESH":
            raise Refused(NEEDS_MESH)
        return context.active_object

    def _cut_from_options(self, obj: bpy.types.Object, hierarchy: Hierarchy) -> tuple[Cut, set[tuple[int, ...]]]:
        """The cut that the options define, and the clusters of the parts made by hand. Raises Refused."""
        if not self.clusters:
            return self._initial_cut(obj, hierarchy), set()
        try:
            cut = Cut.from_clusters(hierarchy, json.loads(self.clusters), self.keeps_borders)
            own_parts = {tuple(clusters) for clusters in json.loads(self.own_parts or "[]")}
        except (ValueError, TypeError, RecursionError) as error:
            raise Refused("These are not parts of {name}: {reason}", name=obj.name, reason=error) from error
        return cut.resize(self.count) if self.count else cut, own_parts

    def _write(self, context: bpy.types.Context, obj: bpy.types.Object, cut: Cut, own_parts: Set[tuple[int, ...]]) -> Steps:
        """Steps that create the results, after all computations. own_parts: clusters of the parts made by hand."""
        if not self.properties.is_property_set("to"):
            self.to = DEFAULT_RESULTS[context.mode]
        for sentence in self._loss_messages(obj):
            self.report({"WARNING"}, sentence)
        arrays.update_mesh(obj)
        known = self._load_names(obj, cut)
        printable = None
        if "PRINT" in self.to:
            printable = yield from print_parts.plan_print(context, obj, cut, known, self._print_options())
        plan = yield from writing.plan_write(obj, cut, self.to - {"PRINT"}, known, self.unwrap,
                                             [part for part, clusters in enumerate(cut.parts) if clusters in own_parts])
        with rollback_on_error():
            return self._write_in_object_mode(context, obj, cut, plan, printable)

    def _read_labels(self, obj: bpy.types.Object) -> labels.Labels | None:
        """The labels of the source, or of saved parts whose borders somebody chose; None: the shape decides. Raises Refused."""
        if self.source != "AUTOMATIC":
            return labels.read_labels(obj, self.source, self.attribute)
        return None if self.count else saved_cut.read_chosen_labels(obj.data)

    def _load_names(self, obj: bpy.types.Object, cut: Cut) -> dict:
        """{clusters: name} of the parts that have the name of their label, or were saved in the mesh."""
        saved = writing.load_names(obj, cut)
        if self.source == "AUTOMATIC":
            return saved
        _, names = labeled_cut.find_cut(cut.hierarchy, self._read_labels(obj))
        return {clusters: name for clusters, name in saved.items() if name not in names.values()} | names

    def _initial_cut(self, obj: bpy.types.Object, hierarchy: Hierarchy) -> Cut:
        """The cut to start from: of the labels, into a number of parts, saved in the mesh, or automatic."""
        if face_labels := self._read_labels(obj):
            cut, _ = labeled_cut.find_cut(hierarchy, face_labels)
            if count := labeled_cut.count_misplaced(cut, face_labels):
                self.report({"WARNING"}, rpt_(
                    "{count:,} of {total:,} faces are in a neighboring part, because the mesh was filled approximately. Repair "
                    "it for exact borders.").format(count=count, total=len(face_labels.of_face)))
            return cut.resize(self.count) if self.count else cut
        if self.count:
            return Cut.into(hierarchy, self.count)
        saved = saved_cut.load_cut(obj, hierarchy)
        return saved[0] if saved else Cut.automatic(hierarchy)

    def _print_options(self) -> printing.PrintOptions:
        insert = None
        if self.joints in {"DOWELS", "MAGNETS"}:  # half of a dowel is in each piece
            insert = printing.Insert(self.insert_diameter, self.insert_length / (2 if self.joints == "DOWELS" else 1))
        clearance = printing.CLEARANCES.get(self.print_material.lower(), self.clearance)
        return printing.PrintOptions(pegs=None if self.joints == "NONE" else clearance, wall=self.wall,
                                     bed=tuple(self.bed) if all(self.bed) else None, inserts=insert, numbers=self.numbers,
                                     joint={"SNAP_PINS": "snap pin", "DOVETAILS": "dovetail"}.get(self.joints, "peg"))

    def _loss_messages(self, obj: bpy.types.Object) -> list[str]:
        messages = composition.loss_messages(obj) if "OBJECTS" in self.to else []
        if "PRINT" in self.to and obj.modifiers:
            messages.append(rpt_("Only the mesh of {name} itself is printed, without the effect of its modifiers. "
                                 "To print it, apply them first.").format(name=obj.name))
        return messages

    def _write_in_object_mode(self, context: bpy.types.Context, obj: bpy.types.Object, cut: Cut, plan: writing.WritePlan,
                              printable: printing.Printable | None) -> set[str]:
        """Writes the cut in Object Mode, and returns to the original mode unless there are new objects."""
        mode = obj.mode
        go_to_object_mode(obj, self.options.is_repeat)
        options = objects.ObjectOptions(self.cap_options(), self.closed, origins=self.origins,
                                        explode=self.explode, shell=self.shell)
        print_objects = print_parts.create_print_objects(obj, printable) if printable else []
        _, part_objects, rig = writing.write(obj, cut, plan, options)
        new_objects = part_objects + print_objects
        if not new_objects:
            return_to_mode(mode)
        if new_objects or rig and mode == "OBJECT":
            copy_part.select_only(context, [*filter(None, [rig]), *new_objects])  # an active armature is ready for Pose Mode
        if new_objects and self.hide:
            obj.hide_set(True)
        self.count, self.clusters, self.keeps_borders = len(cut), json.dumps(cut.parts), cut.keeps_borders
        self.report({"INFO"}, rpt_("{name} now has {count} parts: {results}.").format(
            name=obj.name, count=len(cut), results=self._result_names()))
        if printable and printable.notes:
            self.report({"WARNING"}, " ".join(printable.notes))
        if "OBJECTS" in self.to and self.closed and not printable:
            for note in objects.difference_messages(obj, cut, new_objects, self.smooth):
                self.report({"WARNING"}, note)
        return {"FINISHED"}

    # ---- With the mouse

    def on_start(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        obj = self._find_model(context)
        self.object_name, self.mode = obj.name_full, context.mode
        if not self.properties.is_property_set("to"):
            self.to = DEFAULT_RESULTS[context.mode]
        self.scroll = keys.NotchCounter()
        snapshot, face_labels = MeshSnapshot(obj), self._read_labels(obj)
        hierarchy = None if builds.is_being_built(snapshot) else labeled_cut.find_exact_hierarchy(snapshot, face_labels)
        if hierarchy:
            return self._start_editing(context, obj, hierarchy)
        self.replaced_entry = registry.find_entry(obj.data)
        building = start_build(self, snapshot, **labeled_cut.build_options(face_labels))
        return self._wait_for_build(context, building, self._edit_after_build) if building else {"CANCELLED"}

    def _start_editing(self, context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy) -> set[str]:
        self.state = states.CutState(self._initial_cut(obj, hierarchy))
        if highlight.is_showing(obj):
            self.state = self.state.click(picks.get_pick(MeshSnapshot(obj)).face)
        self.counts = element_counts(obj.data)
        self.display = CutDisplay(self.object_name)
        self._add_draw_handler(lambda: self.display.draw(self.state))
        return self._set_state(context, self.state)

    def on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self.display.is_outdated():
            self._set_state(context, self.state)
        if event.type in keys.SYSTEM:
            return {"PASS_THROUGH"}
        if event.type in keys.MOVES:
            return {"RUNNING_MODAL"} if self.pressed_face is not None else {"PASS_THROUGH"}
        over = picking.find_view_under_mouse(context, event)
        is_plain = not (event.alt or event.oskey or event.ctrl or event.shift)
        if event.type == "TRACKPADPAN" and over and is_plain:
            return self._set_state(context, self.state.turn(self.scroll.add_pixels(event.mouse_y - event.mouse_prev_y)))
        if event.type in keys.NAVIGATE.events or not is_plain or not over and (
                event.type in {"WHEELUPMOUSE", "WHEELDOWNMOUSE", "LEFTMOUSE"}):
            return {"PASS_THROUGH"}
        if event.type == "LEFTMOUSE":
            return self._on_click(context, event, over)
        if event.value != "PRESS":
            return {"RUNNING_MODAL"}
        return self._on_key(context, event)

    def _edit_after_build(self, context: bpy.types.Context, hierarchy: Hierarchy | None) -> set[str]:
        obj = find_object(self.object_name)
        if not hierarchy or obj is None or context.area is None or context.mode != self.mode:
            return {"CANCELLED"}
        return self._start_editing(context, obj, hierarchy)

    def _on_click(self, context: bpy.types.Context, event: bpy.types.Event, over: tuple) -> set[str]:
        """A click activates a part for the wheel, one outside deactivates it, another confirms; a drag merges parts."""
        hit = find_nearest_face([find_object(self.object_name)], *over[1:])
        face = hit.face if hit else NO_FACE
        if event.value in {"PRESS", "DOUBLE_CLICK"}:
            self.pressed_face = face
        if event.value != "RELEASE" or self.pressed_face is None:  # None: pressed before the start
            return {"RUNNING_MODAL"}
        pressed_face, self.pressed_face = self.pressed_face, None
        if pressed_face == face == NO_FACE and self.state.part is None:
            return self.on_confirm(context)
        if NO_FACE in (pressed_face, face):
            return self._set_state(context, self.state.click(None)) if pressed_face == face else {"RUNNING_MODAL"}
        parts = self.state.cut.labels
        if parts[pressed_face] == parts[face]:
            return self._set_state(context, self.state.click(face))
        return self._set_state(context, self.state.merge(face, pressed_face))

    def _on_key(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in keys.CANCEL.events:
            return {"CANCELLED"}
        if event.type in keys.CONFIRM.events:
            return self.on_confirm(context)
        if event.type in keys.WHEEL_STEPS:
            return self._set_state(context, self.state.turn(keys.WHEEL_STEPS[event.type]))
        if event.type in keys.DIGITS:
            return self._set_state(context, self.state.with_digit(keys.DIGITS[event.type]))
        if event.type in keys.ERASE.events:
            return self._set_state(context, self.state.without_digit())
        if event.type in keys.AUTOMATIC.events:
            return self._set_state(context, states.CutState(Cut.automatic(self.state.base.hierarchy)))
        for name, key in keys.CUT_RESULTS.items():
            if event.type in key.events:
                self.to = self.to ^ {name}
                return self._set_state(context, self.state)
        return {"RUNNING_MODAL"}

    def _set_state(self, context: bpy.types.Context, state: states.CutState) -> set[str]:
        """Shows this state in the view and in the status bar."""
        self.state = state
        values = {"count": state.typed + "_" if state.typed else len(state.cut), "results": self._result_names()}
        if state.part is None:
            text, row = iface_("{count} parts: {results}"), keys.CUTTING
        else:
            text, row = iface_("{count} parts, one of {faces:,} faces: {results}"), keys.CUTTING_ONE_PART
            values["faces"] = np.count_nonzero(state.cut.labels == state.part)
        self._show_status(context, text.format(**values), row)
        self.display.update()
        return {"RUNNING_MODAL"}

    def _result_names(self) -> str:
        names = (iface_(label) for name, (label, _) in LABELS.items() if name in self.to)
        return ", ".join(names) or iface_("Saved in the Mesh")

    def on_confirm(self, context: bpy.types.Context) -> set[str]:
        own_parts = self.state.own_parts_so_far
        self.own_parts = json.dumps(sorted(own_parts))
        obj = find_object(self.object_name)
        return self._run_steps(context, self._write(context, obj, self.state.cut, own_parts))

    def can_continue(self, context: bpy.types.Context) -> bool:
        obj = context.active_object
        return (obj is not None and obj.name_full == self.object_name and context.mode == self.mode
                and registry.find_hierarchy(obj.data) is self.state.base.hierarchy
                and element_counts(obj.data) == self.counts)

    def on_cancel(self, context: bpy.types.Context) -> None:
        obj = find_object(self.object_name)
        if obj and self.replaced_entry:
            registry.restore(MeshSnapshot(obj), self.replaced_entry)
