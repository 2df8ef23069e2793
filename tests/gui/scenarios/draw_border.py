"""A border drawn around Homer's navel with Shift Ctrl and the mouse: a part from then on, one undo step; Esc draws nothing; drawing
over it erases it."""
import bmesh
import numpy

RADIUS = 40  # pixels
STEPS = 10


def play(stage):
    yield from stage.open("homer", build=False)
    stage.use_tool()
    mesh = stage.object.data
    x, y, face = stage.spot(0.5, 0.5)
    angles = numpy.linspace(0, 2 * numpy.pi, STEPS, endpoint=False)
    circle = numpy.c_[x + RADIUS * numpy.cos(angles), y + RADIUS * numpy.sin(angles)].round().astype(int).tolist()

    yield from stroke(stage, circle[:STEPS // 2])
    yield from stage.screenshot("drawing")
    stage.mouse.key("ESC")
    yield from stage.settle()
    release(stage)
    yield from stage.settle()
    stage.check(not drawn_edges(mesh), "Esc draws nothing")

    before = stage.registry.find_hierarchy(mesh)
    yield from stroke(stage, circle)
    stage.check(not drawn_edges(mesh), "nothing changes before the end of the stroke")
    release(stage)
    yield from stage.until("a border", lambda: len(drawn_edges(mesh)) > 10)
    ends = numpy.array(sorted(drawn_edges(mesh)))
    stage.check((numpy.unique(ends, return_counts=True)[1] >= 2).all(), "the border is closed")
    yield from stage.until("its parts are found in the background", lambda: stage.registry.find_hierarchy(mesh) is not before)
    inside = enclosed(stage.wheels.triangles, drawn_edges(mesh), face)
    stage.check(20 < len(inside) < len(stage.wheels.triangles) / 10, f"it encloses {len(inside)} faces")
    hierarchy = stage.registry.find_hierarchy(mesh)
    stops = [frozenset(hierarchy.faces(stop).tolist()) for stop in hierarchy.wheel(face)[0]]
    stage.check(inside in stops, f"what the border encloses is a stop, not only {list(map(len, stops))} faces")
    stage.check(all(stop <= inside or stop >= inside for stop in stops), "no part crosses it")
    stage.mouse.move(x, y)
    yield from stage.settle()
    stage.mouse.click()
    yield from stage.selected(inside, "after a click in the border")
    yield from stage.screenshot("drawn")
    stage.mouse.key("ESC")
    yield from stage.until("Esc clears", lambda: not stage.selection())

    border = drawn_edges(mesh)
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one step back, there is no border", lambda: not drawn_edges(mesh))
    stage.mouse.key("Z", ctrl=True, shift=True)
    yield from stage.until("and again", lambda: drawn_edges(mesh) == border)
    yield from stroke(stage, circle)
    release(stage)
    yield from stage.until("drawing over it erases it", lambda: len(drawn_edges(mesh)) < len(border) / 4)
    yield from stage.until("the parts are found again", lambda: stage.registry.find_hierarchy(mesh) is not hierarchy)
    yield from stage.settle()


def stroke(stage, places):
    """Drags along the places; the button stays pressed."""
    stage.mouse.move(*places[0])
    yield from stage.settle()
    stage.mouse.press("LEFTMOUSE", shift=True, ctrl=True)
    yield from stage.settle()
    for place in [*places[1:], places[0]] if len(places) == STEPS else places[1:]:
        stage.mouse.move(*place, shift=True, ctrl=True)
        yield from stage.settle()


def release(stage):
    stage.mouse.release("LEFTMOUSE", shift=True, ctrl=True)


def drawn_edges(mesh):
    """The drawn edges as pairs of vertices."""
    edited = bmesh.from_edit_mesh(mesh)
    layer = edited.edges.layers.int.get("partwheel_border")
    return {tuple(sorted(vertex.index for vertex in edge.verts)) for edge in edited.edges if layer and edge[layer]}


def enclosed(triangles, edges, face):
    """The triangles that a face reaches without crossing these edges."""
    sides = {}
    for number, corners in enumerate(triangles.tolist()):
        for a, b in zip(corners, corners[1:] + corners[:1]):
            sides.setdefault((min(a, b), max(a, b)), []).append(number)
    found, queue = {face}, [face]
    while queue:
        corners = triangles[queue.pop()].tolist()
        for a, b in zip(corners, corners[1:] + corners[:1]):
            pair = min(a, b), max(a, b)
            new = set() if pair in edges else set(sides[pair]) - found
            found |= new
            queue += new
    return frozenset(found)
