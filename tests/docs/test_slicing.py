# SPDX-License-Identifier: GPL-3.0-or-later
"""PrusaSlicer takes the pieces of ten models as they are: each is one closed body, and all lie on the bed."""

import re
import sys

import pytest
from conftest import ROOT
from test_recipes import needs

sys.path.insert(0, str(ROOT / "tests" / "core"))  # models made by script, readers of others

pytest.importorskip("manifold3d")
from partwheel import convex  # noqa: E402
from test_printing import read_model  # noqa: E402
from test_separation import BUILT, surface_of  # noqa: E402

BED = 150
COARSE = ("--layer-height", "0.3", "--fill-density", "0", "--gcode-label-objects")  # faster


@needs("prusa-slicer", "prusa-slicer")
@pytest.mark.parametrize("name", ["bar", "beads", "frame", "U", "figure", "kaykit_Knight", "NormalCar1", "armadillo", "Horse", "dino"])
def test_a_slicer_takes_all_pieces(name, command, tmp_path):
    (tmp_path / "home").mkdir()
    vertices, triangles = surface_of(BUILT[name]()) if name in BUILT else (
        read_model(name).vertices, read_model(name).triangles)
    convex.write_obj(tmp_path / "model.obj", [(name, vertices, triangles)])
    command(sys.executable, "-m", "partwheel", "parts", "model.obj", "-o", "pieces", "--size", 200, "--pegs", "pla",
            "--bed", f"{BED},{BED},{BED}")
    pieces = sorted((tmp_path / "pieces").glob("*.stl"))
    info = command("prusa-slicer", "--info", *pieces)
    assert re.findall("manifold = (.+)", info) == ["yes"] * len(pieces)
    assert re.findall(r"number_of_parts = +(\d+)", info) == ["1"] * len(pieces)
    printed = []
    for plate in sorted((tmp_path / "pieces").glob("*.3mf")):
        code = plate.with_suffix(".gcode")
        said = command("prusa-slicer", "--export-gcode", "--dont-arrange", "--bed-shape", f"0x0,{BED}x0,{BED}x{BED},0x{BED}",
                       "--max-print-height", BED, *COARSE, "--output", code, plate)
        assert not re.search("repair|outside|error|empty", said, re.I), said
        printed += {*re.findall(r"^; printing object (.+) id:", code.read_text(), re.M)}
    print(name, len(pieces), "pieces")
    assert len(printed) == len(pieces)
