# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on's tests share: the installed package, meshes, and what is selected."""

import functools
import importlib
import tempfile
import time
import unittest
from pathlib import Path

import bmesh
import bpy
import numpy

MODULE = None  # the installed add-on's module name, set by run.py
ZIP = None  # what it was installed from, likewise
NEVER = 600  # seconds until something counts as never happening, however busy the machine is
MESHES = Path(__file__).resolve().parents[2] / "build" / "deps" / "meshes"


def only_in(*blenders):
    """For a test, or a class of them, that is not for each Blender, "oldest", "between" and "newest". What takes long and asks
    more of our own code than of Blender leaves out those between; what takes longest, and asks our own code alone (what goes
    on in the worker, say, or the shape of what it made), the oldest too."""
    def marked(tests):
        tests.blenders = blenders
        return tests
    return marked


def part(name):
    """A module of the installed add-on: part("parts.registry")."""
    return importlib.import_module(f"{MODULE}.{name}")


def snapshot(obj):
    """A MeshSnapshot of the object as it is now."""
    return part("mesh.snapshot").MeshSnapshot(obj)


def package(name=""):
    """The Python package that the add-on brings, or a module of it: package("hierarchy")."""
    return importlib.import_module(f"partwheel.{name}".rstrip("."))


def read_off(name):
    """(vertices, polygons) of a plain OFF file."""
    return tuple(map(list, _off(name)))


@functools.cache
def _off(name):
    lines = [line.split() for line in (MESHES / f"{name}.off").read_text().splitlines()
             if line.strip() and not line.startswith("#")]
    vertex_count, face_count = map(int, lines[1][:2])
    vertices = tuple(tuple(map(float, line[:3])) for line in lines[2:2 + vertex_count])
    return vertices, tuple(tuple(map(int, line[1:1 + int(line[0])]))
                           for line in lines[2 + vertex_count:2 + vertex_count + face_count])


BOX = ([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)],
       [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])

SHEET = ([(x, y, 0.1 * x * x) for x in range(4) for y in range(4)],
         [(4 * x + y, 4 * x + y + 4, 4 * x + y + 5, 4 * x + y + 1) for x in range(3) for y in range(3)])

NO_AREA = ([(x, 0, 0) for x in range(16)], SHEET[1])  # its corners are on one line, so it has no parts


def until(predicate):
    """Waits for something that must happen."""
    start_time = time.monotonic()
    while not predicate():
        if time.monotonic() - start_time > NEVER:
            raise AssertionError("never seen")
        time.sleep(0.005)


def alive(process):
    """Whether there is such a process, and not only what is left of one that nobody has asked after."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


class MeshTest(unittest.TestCase):
    """Each test starts in an empty scene, in Object Mode, with nothing built."""

    def setUp(self):
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for data in (bpy.data.objects, bpy.data.meshes, bpy.data.libraries, bpy.data.collections):
            for item in list(data):
                data.remove(item)
        bpy.context.scene.collection.children.link(bpy.data.collections.new("Collection"))
        layer = bpy.context.view_layer
        layer.active_layer_collection = layer.layer_collection.children["Collection"]
        part("parts.files").on_load()
        part("view.status").StatusLine.stack.clear()
        bpy.context.tool_settings.mesh_select_mode = (False, False, True)
        part("preferences").preferences().use_view = False  # most tests say which stop a click takes, from wherever

    def tearDown(self):
        self.assertEqual([key.name for key in bpy.data.shape_keys if not key.user or key.user.shape_keys != key], [],
                         "shape keys without a mesh: a file with them opens with an error")

    def add(self, vertices, polygons, name="model"):
        """A new active object with this mesh."""
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(vertices, [], polygons)
        return self.link(bpy.data.objects.new(name, mesh))

    def link(self, obj):
        bpy.context.collection.objects.link(obj)
        bpy.context.view_layer.update()
        for other in bpy.context.view_layer.objects:
            other.select_set(other == obj)
        bpy.context.view_layer.objects.active = obj
        return obj

    def linked(self, obj):
        """The object anew, linked from another file; the one that was here has gone, and its name is that of a box."""
        with tempfile.TemporaryDirectory() as directory:
            path = str(Path(directory) / "library.blend")
            bpy.data.libraries.write(path, {obj})
            name, matrix = obj.name, obj.matrix_world.copy()
            bpy.data.objects.remove(obj)
            with bpy.data.libraries.load(path, link=True) as (_, linked):
                linked.objects = [name]
        far = self.add(*BOX, name)
        far.location = 100, 100, 100
        linked_object = self.link(linked.objects[0])
        assert far.name == linked_object.name != linked_object.name_full and linked_object.matrix_world == matrix
        return linked_object

    def edit(self, obj, kinds=("FACE",)):
        """Enters Edit Mode with nothing selected."""
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.context.tool_settings.mesh_select_mode = tuple(kind in kinds for kind in ("VERT", "EDGE", "FACE"))
        bpy.ops.mesh.select_all(action="DESELECT")
        return bmesh.from_edit_mesh(obj.data)

    def hierarchy(self, obj):
        """Built by the core alone from the mesh as Python sees it: Blender's triangles of each polygon, or the
        core's where one of Blender's has no area."""
        mesh = obj.data
        mesh.calc_loop_triangles()
        triangles = [(tuple(triangle.vertices), triangle.polygon_index) for triangle in mesh.loop_triangles]
        bad = {triangle.polygon_index for triangle in mesh.loop_triangles if triangle.area < 1e-9}
        triangles = [pair for pair in triangles if pair[1] not in bad]
        for face in bad:
            corners = list(mesh.polygons[face].vertices)
            pieces = package("polygons").triangulate(numpy.array([mesh.vertices[i].co[:] for i in corners]), corners)
            triangles += [(piece, face) for piece in pieces]
        return package().Hierarchy.build([tuple(vertex.co) for vertex in mesh.vertices],
                                            [triangle for triangle, _ in triangles],
                                            [face for _, face in triangles], len(mesh.polygons))


def selected(obj):
    """Indices of the selected faces of the mesh in Edit Mode."""
    return {face.index for face in _faces(obj) if face.select}


def flags(obj):
    """Everything about the selection: of vertices, edges, faces, the history, the active face."""
    bm = bmesh.from_edit_mesh(obj.data)
    for sequence in (bm.verts, bm.edges, bm.faces):
        sequence.index_update()
    return (*([element.select for element in sequence] for sequence in (bm.verts, bm.edges, bm.faces)),
            [(type(element).__name__, element.index) for element in bm.select_history],
            bm.faces.active and bm.faces.active.index)


def _faces(obj):
    bm = bmesh.from_edit_mesh(obj.data)
    bm.faces.index_update()
    return bm.faces
