# SPDX-License-Identifier: GPL-3.0-or-later
"""Models from S3 and results to S3, a store of objects that has no renaming: against moto's server on this machine."""

import json

import pytest
from conftest import run

MISSING = "moto and s3fs are not installed: `scripts/test batch` installs it"
moto_server = pytest.importorskip("moto.server", reason=MISSING)
pytest.importorskip("s3fs", reason=MISSING)


@pytest.fixture
def s3(monkeypatch):
    import s3fs

    server = moto_server.ThreadedMotoServer(ip_address="127.0.0.1", port=0)
    server.start()
    host, port = server.get_host_and_port()
    for name, value in {"AWS_ACCESS_KEY_ID": "any", "AWS_SECRET_ACCESS_KEY": "any", "AWS_DEFAULT_REGION": "us-east-1",
                        "AWS_ENDPOINT_URL": f"http://{host}:{port}"}.items():
        monkeypatch.setenv(name, value)
    files = s3fs.S3FileSystem(skip_instance_cache=True)
    files.mkdir("bucket")
    yield files
    server.stop()


def test_a_task_reads_and_writes_objects_and_skips_existing_results(s3, boxes, tmp_path):
    from partwheel.batch import on_ray
    from partwheel.batch.run import BatchOptions

    import fsspec

    settings = {"outputs": ["hierarchy", "cut"], "parts": 0, "hulls": 0, "max_vertices": 0, "preview": 0,
                "build": {"quality": 0.0, "fill_methods": 15, "open_surfaces": True, "mode": "learned", "full_resolution": False,
                          "keep_inner_walls": False}}
    for path in sorted(boxes.iterdir())[:3]:
        s3.put_file(str(path), f"bucket/models/{path.name}")
    s3.pipe_file("bucket/models/torn.off", b"OFF")
    paths = on_ray._expand_inputs(fsspec, ["s3://bucket/models"])
    assert len(paths) == 4 and all(path.startswith("s3://") for path in paths)
    options = BatchOptions(settings, 0, 2**30)
    for _ in range(2):
        assert dict(on_ray.process_files([*paths, "s3://bucket/models/none.off"], "s3://bucket/out", options)) == {
            None: 3, "mesh file": 1, "file": 1}
    s3.invalidate_cache()
    lines = [line for name in s3.ls("bucket/out/done", detail=False) for line in s3.cat_file(name).splitlines()]
    assert len(lines) == 5 == len(set(lines))

    # What lost a file is made again, and the results are those of a run on one machine.
    torn = s3.glob("bucket/out/models/*/*/hierarchy.partwheel")[0]
    whole = s3.cat_file(torn)
    s3.pipe_file(torn, whole[:10])
    on_ray.process_files(paths, "s3://bucket/out", options)
    assert s3.cat_file(torn) == whole
    run(boxes, "-o", tmp_path / "out", "--make", "hierarchy,cut")
    for name in s3.glob("bucket/out/models/*/*/cut.json"):
        place = tmp_path / name[len("bucket/"):]
        assert json.loads(place.read_bytes()) == json.loads(s3.cat_file(name))
