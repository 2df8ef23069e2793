# SPDX-License-Identifier: GPL-3.0-or-later
"""The run with slots that only pretend: memory, retries, counting, stopping, two runs; and what keys depend on."""

import contextlib
import json
import threading

import pytest

from partwheel.batch import lock
from partwheel.batch.inputs import Input, shard_files
from partwheel.batch.run import BatchOptions, BatchRun

SETTINGS = {"outputs": ["hierarchy"]}
MEGABYTE = 2**20


class Fake:
    """A slot that does what the test says: build(task) -> answer."""

    def __init__(self, does):
        self._does = does

    def build(self, task):
        return self._does(task)

    def enforce_deadline(self):
        pass

    def kill(self):
        pass

    close = kill


def go(folder, paths, does=lambda task: {}, *, jobs=2, memory=2048 * MEGABYTE, **options):
    work = BatchRun(folder, [str(path) for path in paths], BatchOptions(SETTINGS, jobs, memory, **options), lambda: Fake(does))
    return work, work.run()


def published_keys(work):
    """The key of each result, as often as it was published."""
    return [json.loads(line)["key"] for path in work.store.folder.glob("done/*") for line in path.read_text().splitlines()]


@pytest.fixture
def files(tmp_path):
    folder = tmp_path / "in"
    folder.mkdir()
    for number in range(20):
        (folder / f"{number:02}.off").write_text(str(number))
    return sorted(folder.iterdir())


def test_a_second_run_finds_all_results(tmp_path, files):
    reported = []
    work, counts = go(tmp_path / "out", files, lambda task: reported.append(task["path"]) or {})
    assert (counts.total, counts.built, counts.existing, counts.failed, counts.fraction) == (20, 20, 0, {}, 1)
    assert sorted(reported) == [str(path) for path in files]
    work, counts = go(tmp_path / "out", files, lambda task: reported.append(task["path"]) or {})
    assert (counts.built, counts.existing, len(reported)) == (0, 20, 20)
    assert sorted(published_keys(work)) == sorted(work.store.inputs().values())


def test_concurrent_models_share_the_memory_limit(tmp_path, files):
    for path in files[::3]:
        path.write_bytes(path.name.encode() + bytes(5 * MEGABYTE))  # needs more than its share, not more than all
    lock_, used_memory, largest, smallest = threading.Lock(), [], [], []

    def does(task):
        with lock_:
            used_memory.append(task["memory"])
            largest.append(sum(used_memory))
            smallest.append(task["memory"] / (512 * MEGABYTE + 120 * task["size"]))
        threading.Event().wait(0.005)  # others may come in
        with lock_:
            used_memory.remove(task["memory"])
        return {}

    go(tmp_path / "out", files, does, jobs=4, memory=2400 * MEGABYTE)
    assert max(largest) <= 2400 * MEGABYTE and max(largest) > 1200 * MEGABYTE and min(smallest) >= 1


def test_a_model_out_of_memory_is_retried_alone(tmp_path, files):
    granted = []

    def does(task):
        if task["path"] == str(files[5]):
            granted.append(task["memory"])
            return {} if task["memory"] == 2048 * MEGABYTE else {"error": {"name": "memory", "message": "too little"}}
        return {}

    _, counts = go(tmp_path / "out", files, does)
    assert granted == [1024 * MEGABYTE, 2048 * MEGABYTE] and counts.failed == {} and counts.built == 20


def test_failures_are_results_and_are_retried_on_request(tmp_path, files):
    bad = {str(files[1]): "crash", str(files[2]): "memory", str(files[3]): "memory"}

    def does(task):
        name = bad.get(task["path"])
        return {"error": {"name": name, "message": "so"}} if name else {}

    work, counts = go(tmp_path / "out", files, does)
    assert counts.failed == {"crash": 1, "memory": 2} and counts.built == 20
    assert go(tmp_path / "out", files)[1].built == 0
    bad = {}
    counts = go(tmp_path / "out", files, does, retry=frozenset({"memory"}))[1]
    assert counts.built == 2 and counts.failed == {"crash": 1}
    counts = go(tmp_path / "out", files, does, retry=frozenset({"all"}))[1]
    assert counts.built == 1 and counts.failed == {}
    keys = work.store.inputs()
    assert sorted(published_keys(work)) == sorted([*keys.values(), *(keys[str(path)] for path in files[1:4])])


def test_each_file_is_in_one_shard_and_keeps_it():
    paths = [f"{number}.off" for number in range(20)]
    shards = [shard_files(paths, index, 3) for index in (1, 2, 3)]
    assert sorted(sum(shards, [])) == sorted(paths) and all(shards)
    for index, shard in enumerate(shards, 1):
        assert [path for path in shard_files(["new.off", *paths], index, 3) if path != "new.off"] == shard


def test_a_file_that_changes_meanwhile_is_no_result(tmp_path, files):
    def does(task):
        if task["path"] == str(files[0]):
            files[0].write_text("another")
        return {}

    work, counts = go(tmp_path / "out", files, does)
    assert (counts.built, counts.changed) == (19, 1)
    assert go(tmp_path / "out", files)[1].built == 1


def test_a_second_run_on_the_same_folder_is_refused(tmp_path, files):
    inside, leave = threading.Event(), threading.Event()

    def waits(task):
        inside.set()
        leave.wait()
        return {}

    first = BatchRun(tmp_path / "out", list(map(str, files)), BatchOptions(SETTINGS, 2, 0), lambda: Fake(waits))
    thread = threading.Thread(target=first.run)
    thread.start()
    inside.wait()
    try:
        for shard in ((1, 1), (1, 2)):  # the same part of the files; another division of them
            with pytest.raises(lock.FolderInUseError):
                go(tmp_path / "out", files, shard=shard)
    finally:
        leave.set()
        thread.join()
    assert go(tmp_path / "out", files)[1].existing == 20


def test_a_stopped_run_leaves_no_partial_result(tmp_path, files):
    class Stop(Exception):
        pass

    begun = threading.Event()

    def does(task):
        if task["path"] == str(files[8]):
            begun.set()
        return {}

    def progress(counts):
        if begun.is_set():
            raise Stop

    work = BatchRun(tmp_path / "out", list(map(str, files)), BatchOptions(SETTINGS, 1, 0), lambda: Fake(does))
    with contextlib.suppress(Stop):  # it may have been done before the stop
        work.run(progress)
    assert not (tmp_path / "out" / "unfinished" / "1-of-1").exists()
    published = published_keys(work)
    assert len(published) == len(set(published)) >= 8
    assert go(tmp_path / "out", files)[1].built == 20 - len(published)
    assert len(set(published_keys(work))) == len(published_keys(work)) == 20


def test_the_key_depends_on_content_options_and_versions(tmp_path):
    def key(path, settings=SETTINGS, versions={"library": "1"}):
        return Input(str(path), settings, versions).key

    one = tmp_path / "one.off"
    one.write_text("OFF")
    same = tmp_path / "same.off"
    same.write_text("OFF")
    other = tmp_path / "one.obj"
    other.write_text("OFF")
    assert key(one) == key(same)
    keys = [key(one), key(other), key(one, {"outputs": []}), key(one, versions={"library": "2"}), key(tmp_path / "none.off")]
    one.write_text("OFF ")
    assert len({*keys, key(one)}) == 6


def test_the_key_of_a_gltf_depends_on_its_buffers(tmp_path):
    path, buffer_path = tmp_path / "one.gltf", tmp_path / "a b.bin"
    path.write_text('{"buffers": [{"uri": "a%20b.bin"}, {"uri": "data:;base64,AAAA"}, {"uri": "none.bin"}]}')
    buffer_path.write_bytes(b"1")
    before = Input(str(path), SETTINGS, {}).key
    buffer_path.write_bytes(b"2")
    assert Input(str(path), SETTINGS, {}).key != before
