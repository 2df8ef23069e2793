# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands partwheel batch and partwheel report: options, progress, Ctrl-C, summaries, exit codes."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import signal
import sys
import threading
from pathlib import Path
from typing import Any, Dict, Tuple

from . import inputs
from .model import OUTPUTS
from .run import BatchOptions, BatchRun, Counts, available_cores, default_memory
from .. import argument_types as types, requirements
from ..library import Error

SUCCESS, FAILED, USAGE, INTERRUPTED = 0, 1, 2, 130
PROGRESS_SECONDS = 30  # between two lines of progress if standard error is not a terminal


def add_to(commands: Any) -> None:
    """Adds the commands batch and report to argparse's subparsers."""
    batch = commands.add_parser("batch", help="build many models into a folder of results; a run can be resumed")
    batch.add_argument("inputs", nargs="+", metavar="IN", help="mesh files, .blend files, folders of them, @FILE: a list")
    batch.add_argument("-o", "--output", metavar="OUT", required=True, help="the folder of results")
    batch.add_argument("--make", type=lambda text: sorted(types.some_of(OUTPUTS)(text), key=OUTPUTS.index),
                       default="hierarchy,cut", metavar="O,...",
                       help=f"outputs for each model: {', '.join(OUTPUTS)} (default: hierarchy,cut)")
    batch.add_argument("--parts", type=types.count, default=0, metavar="N", help="number of parts (default: automatic)")
    batch.add_argument("--hulls", type=types.count, default=16, metavar="N",
                       help="number of convex hulls in colliders (default: 16)")
    batch.add_argument("--max-vertices", type=int, default=0, metavar="N",
                       help="per hull, 8 or more (default: any number)")
    batch.add_argument("--preview-size", type=types.count, default=192, metavar="PIXELS",
                       help="size of previews (default: 192)")
    batch.add_argument("--jobs", type=types.count, default=available_cores(), metavar="N",
                       help="number of models to build at once (default: number of cores)")
    batch.add_argument("--memory", type=types.size, metavar="SIZE",
                       help="memory for all models that are built at once, such as 6G; a model that needs more fails "
                            "(default: 80 %% of the available memory; Linux only)")
    batch.add_argument("--cpu-limit", type=float, metavar="SECONDS",
                       help="limit of the processor time to read, and to build, one model (default: depends on its size)")
    batch.add_argument("--retry", action="append", default=[], metavar="NAME",
                       help="build models again that failed with this error, such as memory; all: with any error")
    batch.add_argument("--shard", type=types.shard, default=(1, 1), metavar="I/N",
                       help="build only the I-th of N shares of the files, 1 <= I <= N; other machines build the rest")
    batch.add_argument("--ray", metavar="ADDRESS",
                       help="run on a Ray cluster: its address, auto, or local; IN and OUT are fsspec paths that all nodes "
                            "can reach, --memory is per model (needs pip install partwheel[ray])")
    batch.add_argument("--json", action="store_true", help="print the totals as JSON on one line")
    types.add_build_options(batch)
    report = commands.add_parser("report", help="write an HTML page about a folder of results of batch")
    report.add_argument("folder", type=Path, metavar="OUT", help="the folder; the page is its report.html")


def write_report(options: argparse.Namespace) -> int:
    """Runs partwheel report. Exit code: 0 written, 2 the folder can't be read or written."""
    from . import report
    try:
        path, models = report.write(options.folder)
    except OSError as error:
        return _fail(f"{error.strerror}: {error.filename}", USAGE)
    print(f"{path}: {models} models")
    return SUCCESS


def settings(options: argparse.Namespace) -> Dict[str, Any]:
    """The options that affect the results, as JSON values; part of each model's key. Irrelevant ones are 0."""
    result: Dict[str, Any] = {"outputs": options.make, "build": types.build_options(options)}
    if options.use:
        result["use"] = options.use
    result["parts"] = options.parts if set(options.make) & {"cut", "objects", "preview"} else 0
    has_colliders = "colliders" in options.make
    result["hulls"], result["max_vertices"] = (options.hulls, options.max_vertices) if has_colliders else (0, 0)
    result["preview"] = options.preview_size if "preview" in options.make else 0
    return result


def run(options: argparse.Namespace) -> int:
    """Runs partwheel batch. Exit code: 0 success, 1 models failed or the run could not start, 2 wrong usage, 130
    Ctrl-C."""
    progress = _Progress()
    failure = ""
    try:
        report, code = _run_on_ray(options) if options.ray else _run_here(options, progress)
    except KeyboardInterrupt:
        failure, code = "Stopped. Finished results are kept; the same command continues with the rest.", INTERRUPTED
    except OSError as error:
        failure, code = f"{error.strerror or error}: {error.filename or options.output}", USAGE
    except Error as error:
        failure, code = str(error), FAILED
    progress.clear()
    if failure:
        return _fail(failure, code)
    print(report)  # the command itself handles a pipe that nobody reads
    return code


def _run_here(options: argparse.Namespace, progress: _Progress) -> Tuple[str, int]:
    """(the report, the exit code)"""
    paths = inputs.shard_files(inputs.expand_inputs(options.inputs), *options.shard)
    requirements.check_command(options, paths)
    memory = default_memory() if options.memory is None else options.memory
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, _interrupt)  # sent by job schedulers
        if os.name == "posix":
            signal.signal(signal.SIGINT, signal.default_int_handler)  # background jobs of a shell ignore it
    counts = BatchRun(options.output, paths, _batch_options(options, options.jobs, memory)).run(progress)
    report = json.dumps(counts._asdict()) if options.json else describe(counts)
    return report, FAILED if counts.failed or counts.changed else SUCCESS


def _run_on_ray(options: argparse.Namespace) -> Tuple[str, int]:
    """_run_here() on a Ray cluster."""
    from . import on_ray
    batch_options = _batch_options(options, 0, options.memory or 0)
    signal.signal(signal.SIGTERM, _interrupt)

    def progress(done: int, total: int) -> None:
        print(f"{done} of {total} files", file=sys.stderr, flush=True)

    requirements.check(("Running on Ray", name) for name in requirements.RAY)
    paths = on_ray.find_files(options.inputs, batch_options)
    needs = requirements.check_command(options, paths)
    with contextlib.redirect_stdout(sys.stderr):  # Ray prints when a node is lost
        counts = on_ray.run(options.ray, paths, options.output, batch_options, needs, progress)
    failed = {name: number for name, number in counts.items() if name}
    report = json.dumps({"total": sum(counts.values()), "failed": failed}) if options.json else \
        f"{sum(counts.values())} files, {sum(failed.values())} failed: {failed}"
    return report, FAILED if failed else SUCCESS


def _batch_options(options: argparse.Namespace, jobs: int, memory: int) -> BatchOptions:
    return BatchOptions(settings(options), jobs, memory, options.cpu_limit, frozenset(options.retry), options.shard,
                        options.threads or 1)


def describe(counts: Counts) -> str:
    """The summary of a run for users."""
    failed = sum(counts.failed.values())
    lines = [f"{counts.total} files in {_duration(counts.seconds)}: {counts.built} processed, {counts.existing} processed "
             f"before, {counts.duplicates} duplicates; {failed} failed"]
    lines += [f"  {number:6} {name}" for name, number in sorted(counts.failed.items())]
    if counts.dropped:
        kinds = ", ".join(f"{kind} of {number} files" for kind, number in sorted(counts.dropped.items()))
        lines.append(f"  Not in the output: {kinds}")
    if counts.changed:
        lines.append(f"  {counts.changed} changed while they were read: run the command again")
    return "\n".join(lines)


class _Progress:
    """Shows progress: on a terminal in one line that is overwritten, otherwise in a new line every PROGRESS_SECONDS."""

    def __init__(self) -> None:
        self._line, self._next = "", float(PROGRESS_SECONDS)

    def __call__(self, counts: Counts) -> None:
        done = counts.existing + counts.built + counts.duplicates + counts.changed
        left = "" if counts.seconds_left is None else f", about {_duration(counts.seconds_left)} left"
        line = f"{done} of {counts.total} files, {sum(counts.failed.values())} failed, {_duration(counts.seconds)}{left}"
        if sys.stderr.isatty():
            if line != self._line:
                print("\r" + line.ljust(len(self._line)), end="", file=sys.stderr, flush=True)
                self._line = line
        elif counts.seconds > self._next:
            print(line, file=sys.stderr, flush=True)
            self._next = counts.seconds + PROGRESS_SECONDS

    def clear(self) -> None:
        """Erases the line on a terminal."""
        if self._line:
            print("\r" + " " * len(self._line), end="\r", file=sys.stderr, flush=True)


def _interrupt(*_: object) -> None:
    raise KeyboardInterrupt


def _fail(sentence: str, code: int) -> int:
    print(f"partwheel batch: {sentence}", file=sys.stderr)
    return code


def _duration(seconds: float) -> str:
    seconds = int(seconds + 0.5)
    if seconds < 60:
        return f"{seconds} s"
    if seconds < 5400:
        return f"{seconds // 60} min"
    return f"{seconds // 3600} h {seconds % 3600 // 60} min"
