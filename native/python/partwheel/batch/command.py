# SPDX-License-Identifier: GPL-3.0-or-later
"""The command lines of partwheel batch and partwheel report: options, progress, Ctrl-C, last words, exit codes."""

import argparse
import json
import os
import signal
import sys
import threading
from pathlib import Path

from . import inputs
from .model import OUTPUTS
from .run import Options, Run, cores, memory
from .. import requirements
from ..library import Error

DONE, FAILED, USAGE, INTERRUPTED = 0, 1, 2, 130
LINES_SECONDS = 30  # between two lines of progress where no terminal shows them


def add_to(commands, add_build_options):
    """The commands batch and report, for argparse."""
    batch = commands.add_parser("batch", help="build many models into a folder of results that can be gone on with")
    batch.add_argument("inputs", nargs="+", metavar="IN", help="mesh files, .blend files, folders of them, @FILE: a list")
    batch.add_argument("-o", "--output", metavar="OUT", required=True, help="the folder of results")
    batch.add_argument("--make", type=outputs, default="hierarchy,cut", metavar="O,...",
                       help=f"what is made of each model: {', '.join(OUTPUTS)} (default: hierarchy,cut)")
    batch.add_argument("--parts", type=count, default=0, metavar="N", help="of the cut (default: as people would take)")
    batch.add_argument("--hulls", type=count, default=16, metavar="N", help="convex hulls of colliders (default: 16)")
    batch.add_argument("--max-vertices", type=int, default=0, metavar="N",
                       help="of such a hull, 8 or more (default: any number)")
    batch.add_argument("--preview-size", type=count, default=192, metavar="PIXELS", help="of previews (default: 192)")
    batch.add_argument("--jobs", type=count, default=cores(), metavar="N", help="models at a time (default: all cores)")
    batch.add_argument("--memory", type=size, metavar="SIZE",
                       help="for all models at a time, as 6G; one that needs more than all of it fails (default: 80 %% "
                            "of what is available; kept on Linux only)")
    batch.add_argument("--cpu-limit", type=float, metavar="SECONDS",
                       help="of processor time for reading and for building a model (default: by its size, generous)")
    batch.add_argument("--retry", action="append", default=[], metavar="NAME",
                       help="try models again that failed by this name, as memory; all: whatever it was")
    batch.add_argument("--shard", type=shard, default=(1, 1), metavar="I/N",
                       help="do only the I-th of N parts of the files, 1 <= I <= N; other machines do the others")
    batch.add_argument("--ray", metavar="ADDRESS",
                       help="on a Ray cluster: its address, auto, or local; IN and OUT are paths that fsspec knows and "
                            "all nodes see, --memory is each model's (needs pip install partwheel[ray])")
    batch.add_argument("--json", action="store_true", help="print the totals as JSON on one line")
    add_build_options(batch)
    report = commands.add_parser("report", help="one HTML page of a folder that batch has filled")
    report.add_argument("folder", type=Path, metavar="OUT", help="the folder; report.html is written into it")


def write_report(options):
    """Exit code: 0 written, 2 the folder can't be read or written."""
    from . import report
    try:
        path, models = report.write(options.folder)
    except OSError as error:
        return _refused(f"{error.strerror}: {error.filename}", USAGE)
    print(f"{path}: {models} models")
    return DONE


def settings(options):
    """What decides about the results, as JSON: a part of each model's key."""
    made = {"outputs": options.make,
            "build": {"quality": options.quality, "rungs": options.rungs, "open_surfaces": options.open_surfaces,
                      "mode": options.mode, "exactly": options.exactly}}
    made["parts"] = options.parts if set(options.make) & {"cut", "objects", "preview"} else 0
    made["hulls"], made["max_vertices"] = (options.hulls, options.max_vertices) if "colliders" in options.make else (0, 0)
    made["preview"] = options.preview_size if "preview" in options.make else 0
    return made


def run(options):
    """Exit code: 0 a result for each model, 1 some failed or the run could not begin, 2 wrong usage, 130 Ctrl-C."""
    if options.ray:
        return _run_on_ray(options)
    try:
        paths = inputs.of_shard(inputs.found(options.inputs), *options.shard)
        requirements.check_command(options, paths)
    except OSError as error:
        return _refused(f"{error.strerror}: {error.filename}", USAGE)
    except Error as error:
        return _refused(str(error), FAILED)
    limits = Options(settings(options), options.jobs, memory() if options.memory is None else options.memory,
                     options.cpu_limit, frozenset(options.retry), options.shard, options.threads or 1)
    show = _Progress()
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, _interrupt)  # as schedulers end a job
        if os.name == "posix":
            signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background ignores it
    work = None
    try:
        work = Run(options.output, paths, limits)
        counts = work.go(show)
    except KeyboardInterrupt:
        show.end()
        return _refused("Stopped. What was done is done; the same command goes on with the rest.", INTERRUPTED)
    except OSError as error:
        show.end()
        return _refused(f"{error.strerror or error}: {error.filename or options.output}", USAGE)
    except Error as error:
        show.end()
        return _refused(str(error), FAILED)
    show.end()
    print(json.dumps(counts._asdict()) if options.json else describe(counts))
    return FAILED if counts.failed or counts.skipped else DONE


def _run_on_ray(options):
    from . import on_ray
    limits = Options(settings(options), 0, options.memory or 0, options.cpu_limit, frozenset(options.retry), options.shard,
                     options.threads or 1)
    signal.signal(signal.SIGTERM, _interrupt)

    def progress(done, total):
        print(f"{done} of {total} files", file=sys.stderr, flush=True)

    try:
        requirements.check_ray()
        paths = on_ray.find_files(options.inputs, limits)
        needs = requirements.check_command(options, paths)
        counts = on_ray.run(options.ray, paths, options.output, limits, needs, progress)
    except KeyboardInterrupt:
        return _refused("Stopped. What was done is done; the same command goes on with the rest.", INTERRUPTED)
    except OSError as error:
        return _refused(f"{error.strerror or error}: {error.filename or options.output}", USAGE)
    except Error as error:
        return _refused(str(error), FAILED)
    failed = {name: number for name, number in counts.items() if name}
    print(json.dumps({"total": sum(counts.values()), "failed": failed}) if options.json else
          f"{sum(counts.values())} files, {sum(failed.values())} failed: {failed}")
    return FAILED if failed else DONE


def describe(counts):
    """Counts in words."""
    failed = sum(counts.failed.values())
    lines = [f"{counts.total} files in {_duration(counts.seconds)}: {counts.made} made now, {counts.old} were there, "
             f"{counts.same} the same as another, {failed} failed"]
    lines += [f"  {number:6} {name}" for name, number in sorted(counts.failed.items())]
    if counts.dropped:
        kinds = ", ".join(f"{kind} of {number} files" for kind, number in sorted(counts.dropped.items()))
        lines.append(f"  Not in the output: {kinds}")
    if counts.skipped:
        lines.append(f"  {counts.skipped} changed while they were read: run it again")
    return "\n".join(lines)


class _Progress:
    """A line that is written over on a terminal, or a new one each half minute."""

    def __init__(self):
        self._shown, self._next = "", LINES_SECONDS

    def __call__(self, counts):
        done = counts.old + counts.made + counts.same + counts.skipped
        left = "" if counts.left is None else f", about {_duration(counts.left)} left"
        line = f"{done} of {counts.total} files, {sum(counts.failed.values())} failed, {_duration(counts.seconds)}{left}"
        if sys.stderr.isatty():
            if line != self._shown:
                print("\r" + line.ljust(len(self._shown)), end="", file=sys.stderr, flush=True)
                self._shown = line
        elif counts.seconds > self._next:
            print(line, file=sys.stderr, flush=True)
            self._next = counts.seconds + LINES_SECONDS

    def end(self):
        if self._shown:
            print("\r" + " " * len(self._shown), end="\r", file=sys.stderr, flush=True)


def _interrupt(*_):
    raise KeyboardInterrupt


def _refused(sentence, code):
    print(f"partwheel batch: {sentence}", file=sys.stderr)
    return code


def _duration(seconds):
    seconds = int(seconds + 0.5)
    if seconds < 60:
        return f"{seconds} s"
    if seconds < 5400:
        return f"{seconds // 60} min"
    return f"{seconds // 3600} h {seconds % 3600 // 60} min"


def outputs(text):
    """For argparse: the outputs named, in one order."""
    names = set(text.split(","))
    if not names <= set(OUTPUTS):
        raise argparse.ArgumentTypeError(f"what can be made is {', '.join(OUTPUTS)}")
    return [name for name in OUTPUTS if name in names]


def count(text):
    """For argparse: a whole number from 1."""
    value = int(text)
    if value < 1:
        raise ValueError(f"{text} is less than 1")
    return value


def size(text):
    """For argparse: bytes; "6G" -> 6 * 2**30."""
    units = {"K": 2**10, "M": 2**20, "G": 2**30, "T": 2**40}
    unit = units.get(text[-1:].upper())
    return int(float(text[:-1]) * unit) if unit else int(text)


def shard(text):
    """For argparse: "2/8" -> (2, 8)."""
    index, _, number = text.partition("/")
    index, number = int(index), int(number)
    if not 1 <= index <= number:
        raise argparse.ArgumentTypeError("a shard is I/N with 1 <= I <= N, as 2/8")
    return index, number
