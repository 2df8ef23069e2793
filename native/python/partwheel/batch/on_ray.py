# SPDX-License-Identifier: GPL-3.0-or-later
"""partwheel batch on a Ray cluster, with inputs and results in any file system of fsspec (a shared folder, s3://).

The files are divided into tasks of about a hundred models. A task copies each file to its node, builds it there and
uploads the result, model.json last: a model with a complete model.json is finished. Ray restarts a task when its node
dies; the task then skips finished models, and so does a driver that is restarted. Results, keys and reports are those
of a run on one machine.
"""

from __future__ import annotations

import hashlib
import json
import secrets
import tempfile
import time
from pathlib import Path, PurePosixPath
from typing import Any, Callable, Dict, Iterable, List, Optional, Sequence, Tuple

from .inputs import SUFFIXES, Input, shard_files, tool_versions
from .run import BatchOptions, available_cores, default_memory
from .slot import Slot
from .store import REPORT, encode_report
from ..requirements import RAY, Need, check, load_module

MODELS_PER_TASK = 100  # at most
TASKS_PER_CORE = 4  # at least, so that no core is idle for long at the end
POLL_SECONDS = 1  # between two progress reports
MAX_RETRIES = -1  # of a task whose node died: unlimited, since each attempt resumes the last one


def find_files(names: Iterable[str], options: BatchOptions) -> List[str]:
    """The paths of the shard's files: the named files, and the mesh files in the named folders, recursively. Raises
    RequirementError."""
    return shard_files(_expand_inputs(load_module("fsspec", "Running on Ray"), names), *options.shard)


def run(address: str, paths: List[str], output: str, options: BatchOptions, needs: Sequence[Need] = (),
        progress: Callable[[int, int], None] = lambda done, total: None) -> Dict[Optional[str], int]:
    """Builds files, see find_files(), on a cluster; returns {error name or None: number of files}.

    address : of the cluster; "auto"; or "local" for a cluster of this machine that ends with the run
    output : the folder of results, as a path of fsspec
    options : jobs is ignored; memory is that of each model, 0: its core's share of the node's free memory
    needs : see requirements.check_command(); checked on each node
    progress : called with the number of finished files and of all files

    Raises RequirementError, OSError, and errors of Ray."""
    ray, fsspec = (load_module(name, "Running on Ray") for name in RAY)
    owns_ray = not ray.is_initialized()
    if owns_ray:
        ray.init(None if address == "local" else address, log_to_driver=False)
    try:
        # Ray retries the task of a killed worker, not one that raised an exception: that ends the run.
        cluster_cores = int(ray.cluster_resources().get("CPU", 0)) or 1
        size = max(1, min(MODELS_PER_TASK, len(paths) // (TASKS_PER_CORE * cluster_cores)))
        groups = [paths[start:start + size] for start in range(0, len(paths), size)]
        task = ray.remote(num_cpus=1, max_retries=MAX_RETRIES)(process_files)
        pending = {task.remote(group, output, options, needs): len(group) for group in groups}
        total, done = len(paths), 0
        counts: Dict[Optional[str], int] = {}
        while pending:
            ready, _ = ray.wait(list(pending), timeout=POLL_SECONDS)
            for future in ready:
                for name, number in ray.get(future):
                    counts[name] = counts.get(name, 0) + number
                done += pending.pop(future)
            progress(done, total)
    finally:
        if owns_ray:
            ray.shutdown()
    return counts


def _expand_inputs(fsspec: Any, names: Iterable[str]) -> List[str]:
    """The named files, and the mesh files in the named folders, recursively, without duplicates."""
    paths: Dict[str, None] = {}
    for name in names:
        files, path = fsspec.core.url_to_fs(name)
        if files.isdir(path):
            paths.update((files.unstrip_protocol(file), None) for file in sorted(files.find(path))
                         if PurePosixPath(file).suffix.lower() in SUFFIXES)
        else:
            paths[name] = None
    return list(paths)


# ---- In a task, on any node


def process_files(paths: List[str], output: str, options: BatchOptions,
                  needs: Sequence[Need] = ()) -> List[Tuple[Optional[str], int]]:
    """Builds files, see run(); returns [(error name or None, number of files)]. Raises RequirementError if the node lacks a
    package."""
    check(needs)
    import fsspec

    folder = _ResultFolder(fsspec, output, paths)
    options = options._replace(memory=options.memory or default_memory() // available_cores())
    counts: Dict[Optional[str], int] = {}
    slot, versions = Slot(), tool_versions(options.settings)
    try:
        for path in paths:
            with tempfile.TemporaryDirectory(prefix="partwheel-") as temporary:
                name = _process(fsspec, folder, slot, path, options, versions, Path(temporary))
            counts[name] = counts.get(name, 0) + 1
    finally:
        slot.close()
    return list(counts.items())


def _process(fsspec: Any, folder: _ResultFolder, slot: Slot, path: str, options: BatchOptions, versions: Dict[str, str],
             temporary: Path) -> Optional[str]:
    """Builds a file unless its result exists; returns the name of its error or None."""
    local = temporary / "in" / PurePosixPath(path).name
    local.parent.mkdir()
    download_error = None
    try:
        _download(fsspec, path, local)
    except OSError as error:  # includes fsspec's errors
        download_error = f"{error.strerror or error}: {path}"
    source = Input(str(local), options.settings, versions)
    if download_error:
        text = json.dumps(["unreadable", path, download_error, options.settings, source.versions], sort_keys=True)
        source.key, source.error = hashlib.sha256(text.encode()).hexdigest(), download_error
    folder.add_input(path, source.key)
    old = folder.report(source.key)
    if old and not options.should_retry(old):
        return old["error"] and old["error"]["name"]
    results = temporary / "out"
    results.mkdir()
    answer: Dict[str, Any] = {"error": {"name": "file", "message": source.error}} if source.error else slot.build(
        options.task(source, results, options.memory))
    has_preview = answer.pop("has_preview", True)
    report = {**source.report(), **answer}
    folder.publish(results if has_preview else None, source.key, report)
    return report["error"] and report["error"]["name"]


def _download(fsspec: Any, path: str, local: Path) -> None:
    """Copies the file; of a glTF also the .bin files of its folder, which may be its buffers."""
    files, remote = fsspec.core.url_to_fs(path)
    files.get_file(remote, str(local))
    if local.suffix.lower() == ".gltf":
        for name in files.ls(files._parent(remote), detail=False):
            if PurePosixPath(name).suffix.lower() == ".bin":
                files.get_file(name, str(local.parent / PurePosixPath(name).name))


class _ResultFolder:
    """The folder of results, laid out as by store.Store, in a file system without rename: each task writes a file of
    its own in inputs/ and done/."""

    def __init__(self, fsspec: Any, output: str, paths: List[str]) -> None:
        self._files, self._root = fsspec.core.url_to_fs(output)
        self._name = "ray-" + hashlib.sha256("\n".join(paths).encode()).hexdigest()[:16]
        self._attempt = f"{self._name}-{int(time.time())}-{secrets.token_hex(4)}"
        self._inputs: List[Dict[str, str]] = []
        self._done: List[Dict[str, str]] = []

    def _path(self, *names: str) -> str:
        return "/".join([self._root.rstrip("/"), *names])

    def report(self, key: str) -> Optional[Dict[str, Any]]:
        """The content of model.json; None if there is no result, or its files don't have the sizes given there."""
        folder = self._path("models", key[:2], key)
        try:
            report = json.loads(self._files.cat_file(f"{folder}/{REPORT}"))
            entries = self._files.ls(folder, detail=True, refresh=True)
            sizes = {PurePosixPath(entry["name"]).name: entry["size"] for entry in entries}
        except (FileNotFoundError, ValueError):  # missing or incomplete
            return None
        return report if report["files"].items() <= sizes.items() else None

    def publish(self, results: Optional[Path], key: str, report: Dict[str, Any]) -> None:
        """Uploads the files of a local folder, then the report."""
        paths = sorted(results.iterdir()) if results else []
        report["files"] = {path.name: path.stat().st_size for path in paths}
        folder = self._path("models", key[:2], key)
        self._files.makedirs(folder, exist_ok=True)
        for path in paths:
            self._files.put_file(str(path), f"{folder}/{path.name}")
        self._files.pipe_file(f"{folder}/{REPORT}", encode_report(report))
        self._done.append({"key": key})
        self._write_lines("done", self._attempt, self._done)

    def add_input(self, path: str, key: str) -> None:
        """Records the key of a file."""
        self._inputs.append({"path": path, "key": key})
        self._write_lines("inputs", self._name, self._inputs)

    def _write_lines(self, kind: str, name: str, values: Iterable[Dict[str, str]]) -> None:
        """Writes the whole file: object stores can't append."""
        self._files.makedirs(self._path(kind), exist_ok=True)
        lines = "".join(json.dumps(value) + "\n" for value in values)
        self._files.pipe_file(self._path(kind, f"{name}.jsonl"), lines.encode())
