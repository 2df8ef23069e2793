"""Outside Edit Mode what is seen is picked and tinted: a bent and subdivided hand in Weight Paint, its multires levels
in Sculpt Mode, its displaced faces in Object Mode; not what local view hides. A vertex group is one undo step."""
import bpy
import numpy
from mathutils import Matrix, Vector
from view import picture


def play(stage):
    yield from stage.open("hand")
    yield from weights(stage)
    yield from undone(stage)
    yield from stage.open("hand")
    yield from sculpted(stage)
    yield from stage.open("hand")
    yield from displaced(stage)
    yield from stage.open("hand")
    yield from alone(stage)


def mode(stage, name):
    with stage.override():
        bpy.ops.object.mode_set(mode=name)
        bpy.ops.ed.undo_push(message=name)  # as when a user does it


def bend(model):
    modifier = model.modifiers.new("bend", "SIMPLE_DEFORM")
    modifier.deform_method, modifier.deform_axis, modifier.angle = "BEND", "Y", 1.2


def shown(model):
    """(V,3) where the mesh's own vertices are seen, which come first in what modifiers make."""
    mesh = model.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return numpy.array([vertex.co for vertex in mesh.vertices][:len(model.data.vertices)])


def picked(stage, when, **arguments):
    """Picks where the mesh is seen now, and checks the tint: (the wheel's stops, the index of the part held)."""
    yield from stage.wait_for_redraw()
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stops, start = stage.wheels.stops(face)
    stage.mouse.move(x, y)
    before = picture((yield from stage.screenshot(f"{when}-before")))
    with stage.override():
        bpy.ops.mesh.partwheel_paint("INVOKE_DEFAULT", **arguments)
    yield from stage.until(f"a part is shown ({when})", lambda: stage.drawn_things() == 1)
    after = picture((yield from stage.screenshot(f"{when}-held")))
    changed = numpy.abs(after - before)[..., :3].max(axis=2) > 0.03
    part, rest = (stage.view.visible_centers(sorted(faces)[::len(faces) // 100 + 1]).round().astype(int) for faces in
                  (stops[start], set(range(len(stage.wheels.triangles))) - stops[start + 1]))
    inside, outside = (changed[places[:, 1], places[:, 0]].mean() for places in (part, rest))
    stage.check(inside > 0.85 and outside < 0.05,
                f"the part is tinted where it is seen, and nothing else ({when}: {inside:.2f}, {outside:.2f})")
    return stops, start


def weights(stage):
    """The user's own weights, in a locked group, stay."""
    model, positions = stage.object, stage.wheels.vertices
    mode(stage, "OBJECT")
    arm = model.vertex_groups.new(name="Arm.L")
    arm.add(range(len(positions)), 0.37, "REPLACE")
    arm.lock_weight = True
    bend(model)
    model.modifiers.new("smooth", "SUBSURF").levels = 1
    mode(stage, "WEIGHT_PAINT")
    stage.wheels.vertices = shown(model)
    stage.check(numpy.abs(stage.wheels.vertices - positions).max() > 0.05 * numpy.ptp(positions), "it is bent a good deal")
    stops, start = yield from picked(stage, "weights")
    stage.mouse.key("RET")
    yield from stage.until("the part is a vertex group", lambda: len(stage.object.vertex_groups) == 2)
    stage.check(group(stage, 1) == stage.elements(stops[start], "verts"), "exactly the part has weight 1")
    stage.check(len(group(stage, 0, 0.37)) == len(positions), "the locked group is as it was")
    stage.check(f"is the new vertex group {stage.object.vertex_groups[1].name}" in stage.reports(), "a report says so")
    # A larger part, by the panel of the last operation: the same group, no other.
    yield from stage.adjusted(level=1)
    yield from stage.until("the larger part has weight 1", lambda: group(stage, 1) ==
                           stage.elements(stops[start + 1], "verts"))
    stage.check(len(stage.object.vertex_groups) == 2, "there is no other new group")
    yield from stage.screenshot("weights-written")


def undone(stage):
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one Ctrl Z takes the group away", lambda: len(stage.object.vertex_groups) == 1)
    stage.check(stage.object.mode == "WEIGHT_PAINT", "Weight Paint goes on")
    stage.check(len(group(stage, 0, 0.37)) == len(stage.object.data.vertices), "the locked group is still as it was")
    stage.mouse.key("Z", ctrl=True, shift=True)
    yield from stage.until("Shift Ctrl Z brings it back", lambda: len(stage.object.vertex_groups) == 2)


def group(stage, index, weight=1):
    """The vertices that have this weight in a vertex group."""
    return frozenset(vertex.index for vertex in stage.object.data.vertices for group in vertex.groups
                     if group.group == index and abs(group.weight - weight) < 1e-6)


def sculpted(stage):
    model = stage.object
    mode(stage, "OBJECT")
    multires = model.modifiers.new("multires", "MULTIRES")
    with stage.override():
        bpy.ops.object.multires_subdivide(modifier="multires")
        bpy.ops.object.multires_subdivide(modifier="multires")
        multires.levels = 2
    stage.wheels.vertices = shown(model)
    multires.levels, multires.sculpt_levels = 0, 2
    mode(stage, "SCULPT")
    stops, start = yield from picked(stage, "multires", write="FACE_SET")
    stage.mouse.key("RET")
    yield from stage.until("Enter ends it", lambda: stage.drawn_things() == 0)
    sets = [value.value for value in stage.object.data.attributes[".sculpt_face_set"].data]
    value = sets[min(stops[start])]
    stage.check({index for index, face_set in enumerate(sets) if face_set == value} == set(stops[start]),
                "exactly the part is a face set")
    if bpy.app.version < (4, 1):  # later ones would not undo it
        stage.object.data.polygons[0].hide = True
        with stage.override():
            for options in ({}, {"extend": True}, {"deselect": True}):
                bpy.ops.mesh.partwheel_paint(face_index=min(stops[start]), write="MASK", **options)
        stage.check([polygon.index for polygon in stage.object.data.polygons if polygon.hide] == [0] and model.mode == "SCULPT",
                    "a mask of the levels leaves nothing else hidden")
        stage.object.data.polygons[0].hide = False
    mode(stage, "OBJECT")


def displaced(stage):
    """Edit Mode shows the hand at its own place again; selected is the part that was under the mouse."""
    model = stage.object
    mode(stage, "OBJECT")
    bend(model)
    displace = model.modifiers.new("away", "DISPLACE")
    displace.direction, displace.mid_level = "X", 0
    displace.strength = 0.3 * numpy.ptp(stage.wheels.vertices)
    displace.show_in_editmode = model.modifiers["bend"].show_in_editmode = False
    positions, stage.wheels.vertices = stage.wheels.vertices, shown(model)
    yield from stage.wait_for_redraw()
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stops, start = stage.wheels.stops(face)
    stage.mouse.move(x, y)
    yield from stage.screenshot("displaced-before")
    with stage.override():
        bpy.ops.object.partwheel_select("INVOKE_DEFAULT")
    yield from stage.until("the part is shown", lambda: stage.drawn_things() == 1)
    yield from stage.screenshot("displaced-shown")
    stage.mouse.key("RET")
    yield from stage.until("Edit Mode is entered", lambda: stage.object.mode == "EDIT")
    yield from stage.selected(stops[start], "the part that was under the mouse")
    yield from stage.screenshot("displaced-edited")
    stage.wheels.vertices = positions
    yield from stage.ended()


def alone(stage):
    """A box stands before the hand; in the hand's local view it is not there."""
    model = stage.object
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stops, start = stage.wheels.stops(face)
    mode(stage, "OBJECT")
    with stage.override():
        bpy.ops.mesh.primitive_cube_add(size=4)
    box = bpy.context.view_layer.objects.active
    eye = stage.view_3d.view_matrix.inverted()
    box.matrix_world = eye @ Matrix.Translation((0, 0, -2)) @ Matrix.Diagonal((1, 1, 0.1, 1))
    box.name = "box"
    stage.window.view_layer.objects.active = model
    box.select_set(False)
    model.select_set(True)
    place, distance = Vector(stage.view_3d.view_location), stage.view_3d.view_distance
    with stage.override():
        bpy.ops.view3d.localview(frame_selected=False)
    yield from stage.wait_for_redraw()
    stage.check((Vector(stage.view_3d.view_location), stage.view_3d.view_distance) == (place, distance),
                "local view looks from where it did")
    stage.mouse.move(x, y)
    yield from stage.screenshot("local-view")
    with stage.override():
        bpy.ops.object.partwheel_select("INVOKE_DEFAULT")
    yield from stage.until("the part is shown in local view", lambda: stage.drawn_things() == 1)
    stage.mouse.key("RET")
    yield from stage.until("Edit Mode is entered", lambda: model.mode == "EDIT")
    yield from stage.selected(stops[start], "in local view")
    stage.check(box.mode == "OBJECT", "the box is left alone")
    yield from stage.ended()
    mode(stage, "OBJECT")
    with stage.override():
        bpy.ops.view3d.localview(frame_selected=False)
    yield from stage.wait_for_redraw()
    stage.mouse.move(x, y)
    with stage.override():
        bpy.ops.object.partwheel_select("INVOKE_DEFAULT")
    yield from stage.until("outside of it a part is shown", lambda: stage.drawn_things() == 1)
    stage.mouse.key("RET")
    yield from stage.until("the box's", lambda: box.mode == "EDIT")
    yield from stage.until("which is all of its part", lambda: box.data.total_face_sel > 0)
    yield from stage.ended()
