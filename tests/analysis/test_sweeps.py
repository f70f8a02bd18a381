"""Sweeps: every finished part is kept, a killed run goes on to the same result, any executor will do."""

import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial

import numpy as np
import pytest

from lagrangian.scenes import cam_follower
from lcpstep import Moreau
from lcpstep.analysis.bifurcation import bifurcation
from lcpstep.dataset import save
from lcpstep.errors import NotWritten, SweepStopped
from lcpstep.sweep import MANIFEST, sweep
from tests.marks import slow
from tests.processes import ROOT

STUDY = {"drop": 60, "keep": 5, "most": 4}
SPEEDS = np.linspace(357.0, 362.0, 40)


def squares(part, handed):
    total = 0.0 if handed is None else float(handed["total"])
    numbers = np.array(part, dtype=float)
    return {"squares": numbers**2 + total}, {"total": np.array(total + numbers.sum())}


def stubborn(part, handed):
    if part == [3]:
        raise ValueError("three")
    return squares(part, handed)


def deadly(marker, part, handed):
    """Kills its own process, the first time it meets the fourth part."""
    if part == [3] and not os.path.exists(marker):
        open(marker, "w").close()
        os.kill(os.getpid(), signal.SIGKILL)
    return squares(part, handed)


def test_parts_of_a_chain_follow_one_another_and_chains_do_not_depend_on_each_other():
    (first, second) = sweep(squares, [[[1], [2], [3]], [[10, 20]]], {"a": 1}, jobs=2)
    assert [part["squares"].tolist() for part in first] == [[1.0], [5.0], [12.0]]
    assert second[0]["squares"].tolist() == [100.0, 400.0]


def test_what_was_finished_is_not_done_again(tmp_path):
    chains = [[[k]] for k in range(5)]
    with pytest.raises(ValueError, match="three"):
        sweep(stubborn, chains, {}, out=tmp_path / "s", jobs=1)
    parts = {file.name: file.stat().st_mtime_ns for file in (tmp_path / "s").glob("part-*.npz")}
    assert set(parts) >= {f"part-{k:05d}-00000.npz" for k in range(3)}
    done = sweep(squares, chains, {}, out=tmp_path / "s")
    assert [chain[0]["squares"].tolist() for chain in done] == [[0.0], [1.0], [4.0], [9.0], [16.0]]
    assert all((tmp_path / "s" / name).stat().st_mtime_ns == stamp for name, stamp in parts.items())
    assert not list((tmp_path / "s").glob("*.partial"))


class Diverged(RuntimeError):
    pass


def diverging(part, handed):
    if part == [3]:
        raise Diverged("beyond the table")
    return squares(part, handed)


@pytest.mark.parametrize("pool", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_an_error_of_the_work_of_whatever_kind_is_raised_as_it_is(tmp_path, pool):
    with pool(1) as executor, pytest.raises(Diverged, match="beyond the table"):
        sweep(diverging, [[[k]] for k in range(5)], {}, out=tmp_path / "s", executor=executor)
    assert len(list((tmp_path / "s").glob("part-*.npz"))) >= 3


def test_a_folder_that_is_gone_is_no_failure_of_the_executor(tmp_path):
    def vanish(done, total):
        (tmp_path / "s" / MANIFEST).unlink()
        (tmp_path / "s").rmdir()
        (tmp_path / "s").write_text("a file in its place")

    with pytest.raises(NotWritten, match="part-00000-00000"):
        sweep(squares, [[[1]]], {}, out=tmp_path / "s", progress=vanish)
    with pytest.raises(TypeError, match="executor: expected a"):
        sweep(squares, [[[1]]], {}, executor=2)


def test_a_folder_of_another_sweep_is_refused(tmp_path):
    sweep(squares, [[[1]]], {"seed": 1}, out=tmp_path / "s")
    with pytest.raises(SweepStopped, match="another sweep"):
        sweep(squares, [[[1]]], {"seed": 2}, out=tmp_path / "s")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "letter.txt").write_text("dear")
    with pytest.raises(FileExistsError, match="no folder of this sweep"):
        sweep(squares, [[[1]]], {}, out=tmp_path / "full")


def test_an_executor_whose_worker_is_killed_leaves_finished_parts_and_the_next_call_goes_on(tmp_path):
    chains = [[[k] for k in range(6)]]
    work = partial(deadly, str(tmp_path / "died"))
    with (
        ProcessPoolExecutor(max_workers=1) as pool,
        pytest.raises(SweepStopped, match="3 of 6 parts are kept"),
    ):
        sweep(work, chains, {}, out=tmp_path / "s", executor=pool)
    with ProcessPoolExecutor(max_workers=1) as pool:
        resumed = sweep(work, chains, {}, out=tmp_path / "s", executor=pool)
    whole = sweep(squares, chains, {})
    assert all(np.array_equal(a["squares"], b["squares"]) for a, b in zip(resumed[0], whole[0], strict=True))


@pytest.mark.slow
def test_a_cluster_of_processes_retries_what_a_killed_worker_was_doing(tmp_path):
    distributed = pytest.importorskip("distributed")
    settings = {"distributed.scheduler.allowed-failures": 5}
    import dask

    with (
        dask.config.set(settings),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        work = partial(deadly, str(tmp_path / "died"))
        chains = [[[k]] for k in range(6)]
        done = sweep(work, chains, {}, out=tmp_path / "s", executor=client.get_executor())
        assert (tmp_path / "died").exists()
        assert [chain[0]["squares"].tolist() for chain in done] == [[float(k * k)] for k in range(6)]
        # A diagram on the cluster is the diagram of this process
        there = bifurcation(cam_follower, "rpm", SPEEDS[:16], executor=client.get_executor(), **STUDY)
    assert there.identical(bifurcation(cam_follower, "rpm", SPEEDS[:16], **STUDY))


@pytest.mark.parametrize(
    "start", slow(["fixed", "forward", "backward", "random"], longest=["fixed", "backward"])
)
def test_the_number_of_threads_changes_nothing(start):
    box = [[0.0, -5.0], [1.0, 5.0]] if start == "random" else None
    runs = [
        bifurcation(cam_follower, "rpm", SPEEDS, start=start, box=box, runs=2, seed=4, jobs=jobs, **STUDY)
        for jobs in (1, 2)
    ]
    assert runs[0].identical(runs[1])


KILLED = """
import sys, numpy as np
from functools import partial
from lagrangian.scenes import cam_follower
from lcpstep.analysis.bifurcation import bifurcation
def progress(done, total):
    print(done, total, flush=True)
make = partial(cam_follower, restitution=0.8)
bifurcation(make, "rpm", np.linspace(357.0, 362.0, 40), start="forward", drop=4000, keep=5, most=4,
            out=sys.argv[1], progress=progress, jobs=1)
"""


@pytest.mark.slow
def test_a_diagram_killed_in_the_middle_goes_on_to_the_same_bits(tmp_path):
    out = tmp_path / "parts"
    run = subprocess.Popen(
        [sys.executable, "-c", KILLED, str(out)], cwd=ROOT, stdout=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    for line in run.stdout:
        if int(line.split()[0]) >= 2:
            break
    run.send_signal(signal.SIGKILL)
    assert run.wait() == -signal.SIGKILL
    finished = len(list(out.glob("part-*.npz")))
    assert 2 <= finished < 5
    study = {"start": "forward", "drop": 4000, "keep": 5, "most": 4}
    make = partial(cam_follower, restitution=0.8)
    resumed = bifurcation(make, "rpm", SPEEDS, out=out, **study)
    assert resumed.identical(bifurcation(make, "rpm", SPEEDS, **study))


def test_a_saved_diagram_carries_units_seed_and_all_parameters(tmp_path):
    xarray = pytest.importorskip("xarray")
    data = bifurcation(
        partial(cam_follower, restitution=0.7), "rpm", SPEEDS[:4], start="random", runs=2, seed=9,
        box=[[0.0, -5.0], [1.0, 5.0]], method=Moreau(h=1e-3), drop=5, keep=2,
    )  # fmt: skip
    file = save(data, tmp_path / "diagram.nc")
    with xarray.open_dataset(file) as read:
        assert read.identical(data)
        assert read.attrs["seed"] == 9
        assert json.loads(read.attrs["parameters"])["restitution"] == 0.7
        assert "h=0.001" in read.attrs["method"]
        units = {name: read[name].attrs["units"] for name in ("rpm", "q", "v", "impact_before")}
    assert units == {"rpm": "1/min", "q": "m", "v": "m/s", "impact_before": "m/s"}
    with pytest.raises(FileExistsError, match="exists already"):
        save(data, file)
    save(data, file, overwrite=True)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"values": []}, "values: expected increasing values"),
        ({"values": [2.0, 1.0]}, "values: expected increasing values"),
        ({"keep": 0}, "keep: expected a positive integer"),
        ({"drop": -1}, "drop"),
        ({"start": "sideways"}, "start: expected one of fixed"),
        ({"start": "random"}, "box: random starts need"),
        ({"start": "random", "box": [[1.0, 0.0], [0.0, 1.0]]}, "box: expected lowest and highest"),
        ({"jobs": 0}, "jobs: expected a positive integer"),
        ({"phase": 2.0}, "phase"),
    ],
)
def test_wrong_diagrams_are_refused(change, said):
    arguments = {"values": [358.0, 359.0], **STUDY} | change
    with pytest.raises(ValueError, match=said):
        bifurcation(cam_follower, "rpm", arguments.pop("values"), **arguments)


def test_a_pool_that_is_given_is_left_running():
    with ThreadPoolExecutor(1) as pool:
        sweep(squares, [[[1]]], {}, executor=pool)
        assert pool.submit(time.monotonic).result() > 0.0
    assert MANIFEST
