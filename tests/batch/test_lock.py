# SPDX-License-Identifier: GPL-3.0-or-later
"""The lock: one owner at a time, whoever is killed; the folder of results: torn lines, damaged results, twins."""

import json
import os
import subprocess
import sys
import threading

import pytest
from conftest import environment

from partwheel.batch import lock
from partwheel.batch.store import Store

HOLD = "import sys; from partwheel.batch.lock import Lock\nwith Lock(sys.argv[1], 'one'): print('held', flush=True); input()"


def holder(folder):
    process = subprocess.Popen([sys.executable, "-c", HOLD, str(folder)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               env=environment())
    assert process.stdout.readline() == b"held\n"
    return process


def test_only_a_live_owner_keeps_the_lock(tmp_path):
    process = holder(tmp_path)
    with pytest.raises(lock.FolderInUseError, match=str(process.pid)), lock.Lock(tmp_path, "one"):
        pass
    process.kill()
    process.communicate()
    with lock.Lock(tmp_path, "one"):
        assert lock.held_locks(tmp_path) == {"one"}
    assert lock.held_locks(tmp_path) == set()


def test_one_of_many_processes_takes_a_lock_over(tmp_path):
    """Each holder counts itself while it holds: two at once would be seen."""
    for _ in range(10):
        process = holder(tmp_path)
        process.kill()
        process.communicate()
        start, inside, max_inside, got = threading.Barrier(8), [], [], []

        def take():
            start.wait()
            try:
                with lock.Lock(tmp_path, "one"):
                    inside.append(1)
                    max_inside.append(len(inside))
                    got.append(1)
                    inside.pop()
            except lock.FolderInUseError:
                pass

        threads = [threading.Thread(target=take) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert got and max(max_inside) == 1


def test_a_remote_owner_without_heartbeat_loses_the_lock(tmp_path):
    with lock.Lock(tmp_path, "one"):
        path, = tmp_path.glob("one.*")
        owner = path.read_text()
    path.write_text(json.dumps({**json.loads(owner), "machine": "another"}))
    with pytest.raises(lock.FolderInUseError), lock.Lock(tmp_path, "one"):
        pass
    before = path.stat().st_mtime - lock.STALE_SECONDS - 1
    os.utime(path, (before, before))
    with lock.Lock(tmp_path, "one"):
        pass


# ---- The folder


KEY = "ab" * 32


@pytest.fixture
def store(tmp_path):
    store = Store(tmp_path)
    store.begin()
    return store


def publish(store, text="some"):
    second_folder = store.create_folder(KEY)
    (second_folder / "file").write_text(text)
    return store.publish(second_folder, KEY, {"error": None})


def test_an_incomplete_result_is_built_again(store):
    assert store.report(KEY) is None and publish(store) and store.report(KEY)["files"] == {"file": 4}
    (store.result_folder(KEY) / "file").write_text("so")
    assert store.report(KEY) is None
    assert publish(store) and store.report(KEY)
    (store.result_folder(KEY) / "model.json").write_text("{")
    assert store.report(KEY) is None


def test_a_truncated_line_affects_no_other_line(store, tmp_path):
    store.add_input("one", KEY)
    with open(tmp_path / "inputs" / "1-of-1.jsonl", "ab") as file:
        file.write(b'{"path": "tw')
    reopened = Store(tmp_path)
    reopened.begin()
    reopened.add_input("two", KEY)
    reopened.add_input("one", KEY)
    assert reopened.inputs() == {"one": KEY, "two": KEY}
    assert len((tmp_path / "inputs" / "1-of-1.jsonl").read_text().splitlines()) == 3


def test_unfinished_results_are_removed(store, tmp_path):
    left = store.create_folder(KEY)
    (left / "file").write_text("half")
    Store(tmp_path).begin()
    assert not left.exists()
