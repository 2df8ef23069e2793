# SPDX-License-Identifier: GPL-3.0-or-later
"""What a command needs is checked before it reads a model: optional packages, by hiding them from it."""

import os

import pytest
from conftest import PACKAGES
from partwheel import requirements
from test_command_line import run


def hide(folder, *names):
    """PYTHONPATH for a Python that lacks these modules."""
    folder.mkdir(exist_ok=True)
    for name in names:
        (folder / f"{name}.py").write_text(f"raise ImportError('no {name} here')")
    return os.pathsep.join([str(folder), PACKAGES])


# What is asked for, without the module that it needs: the extra that is named.
CASES = [
    (["build", "none.stl"], "trimesh", "meshes"),
    (["build", "none.ply"], "plyfile", "meshes"),
    (["build", "none.3mf"], "networkx", "meshes"),
    (["build", "none.dae"], "collada", "meshes"),
    (["parts", "none.off", "-o", "out"], "trimesh", "meshes"),
    (["parts", "none.off", "-o", "out", "--formats", "stl"], "trimesh", "meshes"),
    (["parts", "none.off", "-o", "out", "--flat"], "manifold3d", "printing"),
    (["parts", "none.off", "-o", "out", "--pegs", "0.2"], "manifold3d", "printing"),
    (["parts", "none.off", "-o", "out", "--bed", "9,9,9"], "manifold3d", "printing"),
    (["batch", "none.stl", "-o", "out"], "trimesh", "meshes"),
    (["batch", "none.off", "-o", "out", "--make", "preview"], "embreex", "batch"),
    (["batch", "none.off", "-o", "out", "--make", "cut,preview"], "PIL", "batch"),
    (["batch", "none.off", "-o", "out", "--ray", "local"], "ray", "ray"),
    (["batch", "none.off", "-o", "out", "--ray", "local"], "fsspec", "ray"),
]


@pytest.mark.parametrize(("arguments", "module", "extra"), CASES, ids=lambda value: value if isinstance(value, str) else "-")
def test_missing_packages_are_reported_before_reading_the_model(arguments, module, extra, tmp_path):
    """No such model exists: a command that opened it would say that."""
    arguments = [str(tmp_path / word) if word.startswith("none.") or word == "out" else word for word in arguments]
    other_modules = {"ray", "fsspec"} - {module} if "--ray" in arguments else ()
    for name in other_modules:
        (tmp_path / "there").mkdir(exist_ok=True)
        (tmp_path / "there" / f"{name}.py").write_text("")
    path = os.pathsep.join([hide(tmp_path / "hidden", module), str(tmp_path / "there")])
    result = run(*arguments, PYTHONPATH=path)
    assert result.returncode == 1 and "Traceback" not in result.stderr, result.stderr
    assert f'pip install "partwheel[{extra}]"' in result.stderr and f"no {module} here" in result.stderr
    assert requirements.PACKAGES.get(module, module) in result.stderr and "No such file" not in result.stderr
    assert not (tmp_path / "out").exists()
