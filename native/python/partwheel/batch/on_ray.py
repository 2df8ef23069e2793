# SPDX-License-Identifier: GPL-3.0-or-later
"""partwheel batch on a Ray cluster: inputs and results on any path of fsspec (a folder all nodes see, s3://).

Tasks of about a hundred models. A task brings each file to its node, makes the result there and puts it in its place,
model.json last: what has a whole model.json is done. Ray begins a task again when its node dies; it then skips what is
done, and so does a driver that is started again. Results, keys and reports are those of a run on one machine.
"""

import hashlib
import json
import secrets
import tempfile
import time
from pathlib import Path, PurePosixPath

from .inputs import SUFFIXES, Input, of_shard, versions
from .run import cores, memory
from .slot import Slot
from .store import REPORT, written
from ..requirements import RAY, check, load_module

MODELS_A_TASK, TASKS_A_CORE = 100, 4  # at most; at least, so that no core waits long for the last
WAIT_SECONDS = 1  # between two looks at what is done
RETRIES = -1  # of a task whose node died: for ever, for each begins where the last one was


def find_files(names, options):
    """The paths of a shard's files, sorted: those that are named, and of folders all below that end as models do.

    Raises RequirementError without fsspec."""
    return of_shard(_found(load_module("fsspec", "Running on Ray"), names), *options.shard)


def run(address, paths, output, options, needs=(), progress=lambda done, total: None):
    """Does all files; {failure name or None: how many}. address: of the cluster, "auto", or "local" for one of this
    machine that ends with the run. paths: of find_files(); output: a folder, as fsspec writes it. options: run.Options,
    of which jobs does not count; memory: for each model, 0: its core's share of what its node has free. needs: as
    requirements.check_command() returns them, checked on each node. Raises RequirementError where a package is missing,
    OSError, what Ray raises."""
    ray, fsspec = (load_module(name, "Running on Ray") for name in RAY)
    began = not ray.is_initialized()
    if began:
        ray.init(None if address == "local" else address, log_to_driver=False)
    try:
        # A killed worker's task begins anew; an error of ours ends the run.
        nodes_cores = int(ray.cluster_resources().get("CPU", 0)) or 1
        size = max(1, min(MODELS_A_TASK, len(paths) // (TASKS_A_CORE * nodes_cores)))
        groups = [paths[start:start + size] for start in range(0, len(paths), size)]
        task = ray.remote(num_cpus=1, max_retries=RETRIES)(work)
        waiting = {task.remote(group, output, options, needs): len(group) for group in groups}
        total, done, counts = len(paths), 0, {}
        while waiting:
            ready, _ = ray.wait(list(waiting), timeout=WAIT_SECONDS)
            for each in ready:
                for name, number in ray.get(each):
                    counts[name] = counts.get(name, 0) + number
                done += waiting.pop(each)
            progress(done, total)
    finally:
        if began:
            ray.shutdown()
    return counts


def _found(fsspec, names):
    """The files, sorted: those that are named, and of folders all below that end as models do."""
    found = {}
    for name in names:
        files, path = fsspec.core.url_to_fs(name)
        below = files.find(path) if files.isdir(path) else None
        if below is None:
            found[name] = None
        else:
            found.update((files.unstrip_protocol(each), None) for each in sorted(below)
                         if PurePosixPath(each).suffix.lower() in SUFFIXES)
    return list(found)


# ---- In a task, on any node


def work(paths, output, options, needs=()):
    """Does these files; [(failure name or None, how many)]. Raises RequirementError for a node without the needs."""
    check(needs)
    import fsspec

    folder = _Folder(fsspec, output, paths)
    options = options._replace(memory=options.memory or memory() // cores())
    found, slot, known = {}, Slot(), versions(options.settings)
    try:
        for path in paths:
            with tempfile.TemporaryDirectory(prefix="partwheel-") as room:
                name = _one(fsspec, folder, slot, path, options, known, Path(room))
            found[name] = found.get(name, 0) + 1
    finally:
        slot.close()
    return list(found.items())


def _one(fsspec, folder, slot, path, options, known, room):
    """Its failure's name, or None."""
    local = room / "in" / PurePosixPath(path).name
    local.parent.mkdir()
    trouble = None
    try:
        _bring(fsspec, path, local)
    except OSError as error:  # fsspec's own are OSErrors too
        trouble = f"{error.strerror or error}: {path}"
    source = Input(str(local), options.settings, known)
    if trouble:
        told = json.dumps(["unreadable", path, trouble, options.settings, source.versions], sort_keys=True)
        source.key, source.error = hashlib.sha256(told.encode()).hexdigest(), trouble
    folder.note(path, source.key)
    old = folder.report(source.key)
    if old and not options.to_retry(old):
        return old["error"] and old["error"]["name"]
    made = room / "out"
    made.mkdir()
    answer = {"error": {"name": "file", "message": source.error}} if source.error else slot.make(
        options.task(source, made, options.memory))
    pictured = answer.pop("pictured", True)
    report = {**source.report(), **answer}
    folder.publish(made if pictured else None, source.key, report)
    return report["error"] and report["error"]["name"]


def _bring(fsspec, path, local):
    """The file, and of a glTF what lies beside it in its folder and may be its buffers."""
    files, remote = fsspec.core.url_to_fs(path)
    files.get_file(remote, str(local))
    if local.suffix.lower() == ".gltf":
        for each in files.ls(files._parent(remote), detail=False):
            if PurePosixPath(each).suffix.lower() == ".bin":
                files.get_file(each, str(local.parent / PurePosixPath(each).name))


class _Folder:
    """The folder of results, as store.Store lays it out, where nothing can be renamed. One file of each kind a task."""

    def __init__(self, fsspec, output, paths):
        self._files, self._root = fsspec.core.url_to_fs(output)
        self._name = "ray-" + hashlib.sha256("\n".join(paths).encode()).hexdigest()[:16]
        self._attempt = f"{self._name}-{int(time.time())}-{secrets.token_hex(4)}"
        self._inputs, self._done = [], []

    def _at(self, *names):
        return "/".join([self._root.rstrip("/"), *names])

    def report(self, key):
        place = self._at("models", key[:2], key)
        try:
            report = json.loads(self._files.cat_file(f"{place}/{REPORT}"))
            there = self._files.ls(place, detail=True, refresh=True)
            sizes = {PurePosixPath(each["name"]).name: each["size"] for each in there}
        except (FileNotFoundError, ValueError):  # none, or torn
            return None
        return report if report["files"].items() <= sizes.items() else None

    def publish(self, made, key, report):
        files = sorted(made.iterdir()) if made else []
        report["files"] = {path.name: path.stat().st_size for path in files}
        place = self._at("models", key[:2], key)
        self._files.makedirs(place, exist_ok=True)
        for path in files:
            self._files.put_file(str(path), f"{place}/{path.name}")
        self._files.pipe_file(f"{place}/{REPORT}", written(report))
        self._done.append({"key": key})
        self._lines("done", self._attempt, self._done)

    def note(self, path, key):
        self._inputs.append({"path": path, "key": key})
        self._lines("inputs", self._name, self._inputs)

    def _lines(self, kind, name, values):
        """Written whole: in a store of objects nothing can be appended."""
        self._files.makedirs(self._at(kind), exist_ok=True)
        lines = "".join(json.dumps(each) + "\n" for each in values)
        self._files.pipe_file(self._at(kind, f"{name}.jsonl"), lines.encode())
