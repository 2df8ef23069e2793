# SPDX-License-Identifier: GPL-3.0-or-later
"""What a command needs is checked before it reads a model: optional packages, by hiding them from it."""

import os
import re
from pathlib import Path

import pytest
from conftest import PACKAGES, ROOT
from partwheel import requirements
from test_command_line import run

OPTIONAL = sorted(requirements.EXTRAS)


def hide(folder, *names):
    """PYTHONPATH for a Python that lacks these modules."""
    folder.mkdir(exist_ok=True)
    for name in names:
        (folder / f"{name}.py").write_text(f"raise ImportError('no {name} here')")
    return os.pathsep.join([str(folder), PACKAGES])


# What is asked for, without the module that it needs: the extra that is named.
CASES = [
    (["build", "none.stl"], "trimesh", "meshes"),
    (["build", "none.3mf"], "networkx", "meshes"),
    (["build", "none.dae"], "collada", "meshes"),
    (["parts", "none.off", "-o", "out"], "trimesh", "meshes"),
    (["parts", "none.off", "-o", "out", "--formats", "stl"], "trimesh", "meshes"),
    (["parts", "none.off", "-o", "out", "--formats", "3mf"], "lxml", "meshes"),
    (["parts", "none.off", "-o", "out", "--flat"], "manifold3d", "printing"),
    (["parts", "none.off", "-o", "out", "--pegs", "0.2"], "manifold3d", "printing"),
    (["parts", "none.off", "-o", "out", "--bed", "9,9,9"], "manifold3d", "printing"),
    *((["convex", "none.off", "-o", "out", "--formats", form], "trimesh", "meshes") for form in ("glb", "unreal", "godot")),
    (["batch", "none.stl", "-o", "out"], "trimesh", "meshes"),
    (["batch", "none.off", "-o", "out", "--make", "objects"], "trimesh", "meshes"),
    (["batch", "none.off", "-o", "out", "--make", "preview"], "embreex", "batch"),
    (["batch", "none.off", "-o", "out", "--make", "cut,preview"], "PIL", "batch"),
    (["batch", "none.off", "-o", "out", "--ray", "local"], "ray", "ray"),
    (["batch", "none.off", "-o", "out", "--ray", "local"], "fsspec", "ray"),
]


@pytest.mark.parametrize(("arguments", "module", "extra"), CASES, ids=lambda value: value if isinstance(value, str) else "-")
def test_what_is_missing_is_said_before_the_model_is_opened(arguments, module, extra, tmp_path):
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


def test_all_that_is_missing_is_said_at_once(tmp_path):
    path = hide(tmp_path / "hidden", "trimesh", "embreex", "PIL")
    result = run("batch", tmp_path / "none.stl", "-o", tmp_path / "out", "--make", "preview", PYTHONPATH=path)
    assert result.returncode == 1
    assert re.findall(r'pip install "(.*?)"', result.stderr) == ["partwheel[meshes]", "partwheel[batch,meshes]"]
    assert "trimesh and embreex and pillow" in result.stderr


@pytest.mark.parametrize("arguments", [
    ["build"], ["convex", "--formats", "obj,urdf,mjcf,usd", "--hulls", 2], ["batch"], ["batch", "--make", "cut,colliders"]],
    ids=lambda words: words[0])
def test_what_needs_numpy_alone_runs_without_the_others(arguments, tmp_path, meshes_directory):
    command, *more = arguments
    result = run(command, meshes_directory / "sphere.off", "-o", tmp_path / "out", *more,
                 PYTHONPATH=hide(tmp_path / "hidden", *OPTIONAL))
    assert result.returncode == 0, result.stderr


def test_a_blend_file_without_blender(tmp_path):
    result = run("batch", tmp_path / "none.blend", "-o", tmp_path / "out", PATH=str(tmp_path))
    assert result.returncode == 1 and "no program blender on the PATH" in result.stderr
    assert not (tmp_path / "out").exists()


def test_every_module_is_in_the_extra_that_is_named():
    """As pyproject.toml has it; read by hand, for Python 3.9 has no tomllib."""
    text = (ROOT / "pyproject.toml").read_text()
    for module, extra in requirements.EXTRAS.items():
        packages = re.search(rf"^{extra} = \[(.*)\]", text, re.MULTILINE)[1]
        assert f'"{requirements.PACKAGES.get(module, module)}"' in packages, module


def test_every_optional_import_goes_through_it():
    """Other imports of optional packages follow a load_module() that has checked for them."""
    needs = {}
    for path in Path(requirements.__file__).parent.rglob("*.py"):
        for name in re.findall(r"^\s+(?:import|from) (\w+)", path.read_text("utf-8"), re.MULTILINE):
            if name in requirements.EXTRAS:
                needs.setdefault(path.name, set()).add(name)
    assert needs == {"preview.py": {"PIL", "trimesh"}, "on_ray.py": {"fsspec"}}
