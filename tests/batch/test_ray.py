# SPDX-License-Identifier: GPL-3.0-or-later
"""partwheel batch --ray on a cluster of this machine: nodes killed in mid-run, the driver killed and started again."""

import json
import subprocess

import pytest
from conftest import PACKAGES, box, command, environment, results, run
from test_command import count_done, until

ray_cluster = pytest.importorskip("ray.cluster_utils", reason="Ray is not installed: `scripts/test batch` installs it")


@pytest.fixture
def cluster(monkeypatch):
    """A head that does no work, and four nodes of one core."""
    monkeypatch.setenv("PYTHONPATH", PACKAGES)  # for the workers
    monkeypatch.setenv("RAY_memory_monitor_refresh_ms", "0")  # others may fill the machine's memory
    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")
    cluster = ray_cluster.Cluster(initialize_head=True, head_node_args={"num_cpus": 0, "include_dashboard": False})
    cluster.nodes = [cluster.add_node(num_cpus=1) for _ in range(4)]
    yield cluster
    cluster.shutdown()


def test_nothing_is_lost_or_done_twice_when_nodes_and_the_driver_are_killed(cluster, boxes, tmp_path):
    for number in range(12, 32):
        box(boxes / f"box{number:02}.off", [1, 1 + number, 2])
    (boxes / "torn.off").write_text("OFF")
    out = tmp_path / "out"
    arguments = [*command(boxes, "-o", f"file://{out}", "--make", "hierarchy,cut", "--ray", cluster.address), "--json"]

    def start():
        return subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment())

    def wait_for(driver, number):
        until(lambda: count_done(out) >= number or driver.poll() is not None)
        assert driver.poll() is None, driver.communicate()

    driver = start()
    for node, number in zip(cluster.nodes[:2], (4, 9)):
        wait_for(driver, number)
        cluster.remove_node(node, allow_graceful=False)
    wait_for(driver, 14)
    driver.kill()
    driver.communicate()
    before = count_done(out)
    assert before < 33
    driver = start()
    words, errors = driver.communicate()
    assert driver.returncode == 1, errors
    assert json.loads(words) == {"total": 33, "failed": {"mesh file": 1}}

    keys = [json.loads(line)["key"] for path in (out / "done").iterdir() for line in path.read_text().splitlines()]
    assert len(keys) == len(set(keys)) >= 31  # a task killed between a result and its line tells less
    run(boxes, "-o", tmp_path / "one", "--make", "hierarchy,cut", code=1)
    assert results(out) == results(tmp_path / "one")
