"""Delete Loose Bits shows what it will delete; the wheel changes the size; Esc leaves all as it was; Enter deletes, as one
undo step."""
import bmesh
import bpy
from mathutils import Vector


def play(stage):
    yield from stage.open("hand")
    bm = bmesh.from_edit_mesh(stage.object.data)
    low, high = (Vector(extreme(vert.co[axis] for vert in bm.verts) for axis in range(3)) for extreme in (min, max))
    for number, scale in enumerate((0.005, 0.05), 1):
        corner = low + number * 0.2 * (high - low)
        bm.faces.new([bm.verts.new(corner + scale * (high - low).length * Vector(axis))
                      for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))])
    bmesh.update_edit_mesh(stage.object.data)
    with stage.override():
        bpy.ops.ed.undo_push(message="Litter")
    count = faces(stage)

    yield from begun(stage)
    stage.mouse.wheel(1)
    yield from stage.settle()
    stage.check(faces(stage) == count, "nothing is deleted yet")
    yield from stage.screenshot("1-small")
    stage.mouse.key("ESC")
    yield from stage.settle()
    stage.check(faces(stage) == count, "Esc deletes nothing")
    yield from stage.ended()

    yield from begun(stage)
    stage.mouse.wheel(8)
    yield from stage.settle()
    yield from stage.screenshot("2-both")
    stage.mouse.key("RET")
    yield from stage.until("Enter deletes both", lambda: faces(stage) == count - 2)
    yield from stage.ended()
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one undo step brings both back", lambda: faces(stage) == count)

    with stage.override():
        bpy.ops.mesh.partwheel_loose("EXEC_DEFAULT", True, size=0.02)
    yield from stage.settle()
    stage.check(faces(stage) == count - 1, "a small size takes one")
    yield from stage.adjusted(size=0.2)
    stage.check(faces(stage) == count - 2, "a larger one in the panel both")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("and it is one undo step", lambda: faces(stage) == count)


def begun(stage):
    stage.mouse.move(*stage.empty_spot())
    yield from stage.settle()
    with stage.override():
        bpy.ops.mesh.partwheel_loose("INVOKE_DEFAULT")
    yield from stage.settle()


def faces(stage):
    return len(bmesh.from_edit_mesh(stage.object.data).faces)
