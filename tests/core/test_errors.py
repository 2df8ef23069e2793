# SPDX-License-Identifier: GPL-3.0-or-later
"""Every error a build can be made to give, each by an input that deserves it and no other."""

import os
import subprocess
import sys
import textwrap

import numpy as np
import pytest
import shapes
from conftest import PACKAGES, PLAIN, ROOT
from partwheel import Hierarchy, PartwheelError, FillMethod, Status
from solid_checks import count_crossings

CUBE = shapes.cube()


def with_vertex(shape, vertex, value):
    vertices = shape.vertices.copy()
    vertices[vertex] = value
    return shape._replace(vertices=vertices)


def with_triangle(shape, triangle, value):
    triangles = shape.triangles.copy()
    triangles[triangle] = value
    return shape._replace(triangles=triangles)


def without_triangle(shape):
    return shapes.Shape(shape.vertices, shape.triangles[1:], None, None)


def collinear():
    """A cube with a vertex put on the middle of an edge, and a triangle along that edge."""
    cube = shapes.polygons(CUBE.vertices, [[a, b, c] for a, b, c in CUBE.triangles.tolist()])
    a, b, c = cube.triangles[0].tolist()
    vertices = np.vstack([cube.vertices, (cube.vertices[a] + cube.vertices[b]) / 2])
    middle = len(cube.vertices)
    return shapes.polygons(vertices, [[middle, b, c], [a, middle, c], [a, b, middle],
                                      *cube.triangles[1:].tolist()])


def sharing_a_vertex():
    return shapes.polycube([(0, 0, 0), (1, 1, 1)])


def sharing_an_edge():
    return shapes.polycube([(0, 0, 0), (1, 1, 0)])


def spindle():
    """A torus whose tube is thicker than its ring is wide, so that it passes through itself."""
    return shapes.torus(radius=0.6, tube=1.0)


CASES = {
    "no vertices": (Status.EMPTY, lambda: (np.zeros((0, 3)), np.zeros((0, 3), int))),
    "no triangles": (Status.EMPTY, lambda: (CUBE.vertices, np.zeros((0, 3), int))),
    "nan": (Status.NOT_FINITE, lambda: with_vertex(CUBE, 3, (0, np.nan, 0))),
    "infinity": (Status.NOT_FINITE, lambda: with_vertex(CUBE, 3, (0, -np.inf, 0))),
    "too far": (Status.NOT_FINITE, lambda: with_vertex(CUBE, 3, (1e101, 0, 0))),
    "no such vertex": (Status.INDEX, lambda: with_triangle(CUBE, 4, (0, 1, 8))),
    "negative vertex": (Status.INDEX, lambda: with_triangle(CUBE, 4, (0, 1, -1))),
    "vertex beyond 32 bits": (Status.INDEX, lambda: (CUBE.vertices, CUBE.triangles.astype(np.int64) + 2**32)),
    "no such face": (Status.INDEX, lambda: CUBE._replace(faces=CUBE.faces + 1)),
    "negative face": (Status.INDEX, lambda: CUBE._replace(faces=CUBE.faces - 1)),
    "repeated corner": (Status.DEGENERATE, lambda: with_triangle(CUBE, 4, (0, 1, 1))),
    "corners on a line": (Status.DEGENERATE, collinear),
    "hole": (Status.OPEN, lambda: without_triangle(CUBE)),
    "edge of four faces": (Status.NON_MANIFOLD, sharing_an_edge),
    "sheets touching at a vertex": (Status.NON_MANIFOLD, sharing_a_vertex),
    "one triangle turned": (Status.ORIENTATION, lambda: with_triangle(CUBE, 4, CUBE.triangles[4][::-1])),
    "a surface through itself": (Status.SELF_INTERSECTION, spindle),
}


@pytest.mark.parametrize("name", CASES)
def test_broken_surfaces_are_named(name):
    status, make = CASES[name]
    with pytest.raises(PartwheelError) as refused:
        Hierarchy.build(*make(), fill_methods=FillMethod.EXACT)
    assert refused.value.status == status, str(refused.value)
    assert refused.value.name and str(refused.value).endswith(".")


# name -> faces, vertices, triangle, as far as one answer is right
PLACES = {
    "nan": ((), (3,), None),
    "no such vertex": ((), (), 4),
    "negative vertex": ((), (), 4),
    "no such face": ((), (), 10),
    "no vertices": ((), (), None),
}


@pytest.mark.parametrize("name", PLACES)
def test_errors_say_where(name):
    with pytest.raises(PartwheelError) as refused:
        Hierarchy.build(*CASES[name][1](), fill_methods=FillMethod.EXACT)
    assert (refused.value.faces, refused.value.vertices, refused.value.triangle) == PLACES[name]


def test_both_faces_that_intersect_are_named():
    shape = spindle()
    with pytest.raises(PartwheelError) as refused:
        Hierarchy.build(*shape, fill_methods=FillMethod.EXACT)
    one, other = (shape.triangles[shape.faces == face] for face in refused.value.faces)
    assert count_crossings(shape.vertices, np.vstack([one, other])) > 0


def test_every_face_needs_a_triangle():
    with pytest.raises(PartwheelError):
        Hierarchy.build(*CUBE._replace(face_count=7))
    with pytest.raises(PartwheelError) as refused:
        Hierarchy.build(CUBE.vertices, CUBE.triangles, None, 6)
    assert refused.value.status == Status.ARGUMENT


# AddressSanitizer itself takes more address space than any limit, so under it this can't be tried.
if PLAIN:

    def test_running_out_of_memory_is_an_error_not_a_crash():
        """Wherever in a build the memory ends."""
        script = textwrap.dedent("""
            import resource, shapes
            from partwheel import Hierarchy, PartwheelError, version
            shape = shapes.off("homer")
            version()  # loads the library
            for megabytes in (12, 14, 17, 20, 24, 29, 35, 42, 50, 1000):  # a thread's stack alone takes 8
                pages = int(open("/proc/self/statm").read().split()[0])
                resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + megabytes * 2**20, -1))
                try:
                    Hierarchy.build(*shape)
                    print("built")
                except PartwheelError as error:
                    print(error.name)
        """)
        path = os.pathsep.join([PACKAGES, str(ROOT / "tests" / "core")])
        run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=1800,
                             env={**os.environ, "PYTHONPATH": path})
        assert run.returncode == 0, run.stderr
        results = run.stdout.split("\n")[:-1]
        assert len(results) == 10 and set(results) == {"memory", "built"}, results
        assert results[0] == "memory" and results[-1] == "built"


def test_numbers_that_make_no_sense_are_refused_by_name():
    box = shapes.cube()
    hierarchy = Hierarchy.build(*box)
    integers = {
        "face": hierarchy.path, "node": hierarchy.faces, "parts": hierarchy.cut_parts, "hulls": hierarchy.convex_parts,
        "max_vertices": lambda value: hierarchy.convex_parts(2, max_vertices=value),
        "threads": lambda value: hierarchy.convex_parts(2, threads=value),
        "exact_triangles": lambda value: Hierarchy.build(*box, exact_triangles=value)}
    for name, function in integers.items():
        for value, kind in (("a", TypeError), (1.5, TypeError), (-1, PartwheelError), (2**31, PartwheelError), (2**64 + 1, PartwheelError)):
            with pytest.raises(kind, match=name):
                function(value)
    numbers = {"height": hierarchy.cut_height, "error": lambda value: hierarchy.convex_parts(error=value),
               "quality": lambda value: Hierarchy.build(*box, quality=value)}
    for name, function in numbers.items():
        for value, kind in (("a", TypeError), ([1], TypeError), (float("nan"), PartwheelError), (-1, PartwheelError)):
            with pytest.raises(kind, match=name):
                function(value)
