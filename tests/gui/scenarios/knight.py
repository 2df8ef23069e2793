"""A knight of fifteen objects joined to one mesh, in Edit Mode: a click on each piece that can be seen from one of four sides,
and at most two notches, select that piece. A piece is what Blender's Select Linked takes once vertices are merged."""
import types

import bmesh
import bpy
import numpy
from mathutils import Matrix, Quaternion
from scenarios.assembly import KNIGHT, import_knight, knight, select
from scenarios.modes import hover
from view import View

SIDES = {"front": (0.7071, 0.7071, 0, 0), "behind": (0, 0, 0.7071, 0.7071), "right": (0.5, 0.5, 0.5, 0.5),
         "left": (0.5, 0.5, -0.5, -0.5)}
NOTCHES = 1, 1, -1, -1, -1, -1  # from the click: up to two larger, then down to two smaller
SAME = 0.9  # overlap by area


def play(stage):
    if not KNIGHT.exists():
        print(f"(not tried: there is no {KNIGHT})")
        return
    yield from import_knight(stage)
    join(stage)
    with stage.override():
        bpy.ops.mesh.partwheel_build()
        bpy.ops.object.mode_set(mode="EDIT")
        stage.window.scene.tool_settings.mesh_select_mode = (False, False, True)
        bpy.ops.mesh.select_all(action="DESELECT")
        bpy.ops.ed.undo_push(message="Edit Mode")
    stage.use_tool()
    vertices, triangles, owners, piece, area = measure(bmesh.from_edit_mesh(stage.object.data))
    best = {}
    for side, rotation in SIDES.items():
        stage.view_3d.view_rotation = Quaternion(rotation)
        yield from stage.wait_for_redraw()
        yield from stage.settle()
        view = View(stage.area, types.SimpleNamespace(matrix_world=Matrix()), vertices, triangles)
        centers = view.centers()
        for number in numpy.unique(piece):
            spot = find_spot(view, centers, piece[owners] == number)
            if spot is None or max(best.get(number, [0])) >= SAME:
                continue  # hidden, too small from here, or selected from another side
            x, y = spot
            yield from pick(stage, x, y, piece == number, area, best.setdefault(int(number), []))
            if number % 5 == 0 or number == 24:
                yield from stage.screenshot(f"{side}-{number}")
            stage.mouse.key("ESC")
            yield from stage.until("Esc clears", lambda: not stage.selection())
    stage.check(len(best) == 32, f"all but two pieces in the helmet can be seen of {piece.max() + 1} ({len(best)})")
    missed = {number: round(max(overlaps), 2) for number, overlaps in best.items() if max(overlaps) < SAME}
    stage.check(not missed, f"each of {len(best)} pieces is selected by a click and two notches, but {missed}")


def find_spot(view, centers, is_piece):
    """(x, y) of a pixel near the middle of a piece that shows it with all pixels around, or None."""
    places = centers[is_piece]
    for x, y in places[((places - places.mean(axis=0)) ** 2).sum(axis=1).argsort()].round().astype(int).tolist():
        around = [view.face_at(x, y)]
        if around[0] is not None and is_piece[around[0]]:
            around += [view.face_at(x + dx, y + dy) for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1))]
            if all(face is not None and is_piece[face] for face in around):
                return x, y
    return None


def join(stage):
    """Makes the knight's objects one mesh without an armature."""
    names = knight()
    bpy.data.objects.remove(bpy.data.objects["Other"])
    for each in (bpy.data.objects[name] for name in names):
        matrix = each.matrix_world.copy()
        each.parent, each.matrix_world = None, matrix
        each.modifiers.clear()
    select(stage, names, "Knight_Body")
    with stage.override():
        bpy.ops.object.transform_apply(location=True, rotation=True, scale=True)
        bpy.ops.object.join()
    stage.view_3d.view_location, stage.view_3d.view_distance = (0, 0, 1.2), 6


def measure(bm):
    """(vertices, triangles, the face of each, the piece of each face, its area)."""
    bm.faces.index_update()
    bm.verts.index_update()
    vertices = numpy.array([vertex.co for vertex in bm.verts])
    loops = bm.calc_loop_triangles()
    triangles = numpy.array([[loop.vert.index for loop in three] for three in loops])
    owners = numpy.array([three[0].face.index for three in loops])
    _, place = numpy.unique(vertices.round(5), axis=0, return_inverse=True)
    place = place.ravel()
    label = numpy.arange(place.max() + 1)
    corners = [[place[vertex.index] for vertex in face.verts] for face in bm.faces]
    while True:
        before = label.copy()
        for row in corners:
            label[row] = label[row].min()
        if (label == before).all():
            break
    _, piece = numpy.unique(label[[row[0] for row in corners]], return_inverse=True)
    return vertices, triangles, owners, piece.ravel(), numpy.array([face.calc_area() for face in bm.faces])


def pick(stage, x, y, is_piece, area, overlaps):
    """Clicks and turns the wheel; puts the overlap of each stop with the piece into overlaps."""
    def overlap():
        chosen = numpy.zeros(len(is_piece), bool)
        chosen[list(stage.selection())] = True
        return area[chosen & is_piece].sum() / area[chosen | is_piece].sum()

    yield from hover(stage, x, y)
    yield from stage.settle()
    stage.mouse.click()
    yield from stage.until("something is selected", lambda: stage.selection())
    overlaps.append(overlap())
    for step in NOTCHES if overlaps[-1] < SAME else ():
        stage.mouse.wheel(step)
        yield from stage.settle()
        overlaps.append(overlap())
        if overlaps[-1] >= SAME:
            break
