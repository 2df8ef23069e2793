"""Runs inside Blender, started by run.py: plays one scenario in Blender's window and writes what came of it.

    blender --python inside.py -- SCENARIO DRIVER LOOKS WORK_DIRECTORY PICTURE_PREFIX RESULT.json
"""
import importlib
import pathlib
import sys

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "faults")]
sys.path.append(str(HERE.parent / "addon"))  # for models
from stage import Stage  # noqa: E402

name, driver, looks, *paths = sys.argv[sys.argv.index("--") + 1:]
Stage(driver, looks, *map(pathlib.Path, paths)).play(importlib.import_module(f"scenarios.{name}").play)
