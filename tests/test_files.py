"""Files appear complete or not at all: without space, folder or time the old one stays."""

import argparse
import errno
import json
import os
from contextlib import contextmanager
from types import SimpleNamespace

import numpy as np
import pytest

from lagrangian import scenes
from lcpstep import Moreau
from lcpstep.accuracy.study import study
from lcpstep.accuracy.work_precision import Study
from lcpstep.cli import main, orbit
from lcpstep.cli.common import DONE, FAILED
from lcpstep.dataset import labelled, save
from lcpstep.errors import LcpStepError, NotWritten
from lcpstep.files import replacing
from lcpstep.sweep import Store

resource = pytest.importorskip("resource")
pytest.importorskip(
    "matplotlib.backends.backend_pdf"
)  # loaded without space, its machine code stays cut off on disk
SPACE = 20_000  # bytes that a file may have, in place of a disk that is full
NUMBERS = np.random.default_rng(1).random(10 * SPACE)


@contextmanager
def little_space():
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (SPACE, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


def refused(file, write):
    """Whether writing fails with the file's name, leaves its content and nothing beside it."""
    file.write_bytes(b"old")
    with little_space(), pytest.raises(NotWritten, match=f"{file.name} could not be written") as caught:
        write(file)
    assert isinstance(caught.value, LcpStepError)
    assert isinstance(caught.value, OSError)
    return file.read_bytes() == b"old" and list(file.parent.iterdir()) == [file]


def text(file):
    with replacing(file) as draft:
        draft.write_text("x" * 2 * SPACE)


def dataset(file):
    save(labelled({"q": (("n",), NUMBERS)}, {}, {}), file, overwrite=True)


def picture(file):
    from matplotlib.figure import Figure

    from lcpstep.cli.common import save_figure

    figure = Figure()
    figure.gca().imshow(NUMBERS.reshape(400, -1))
    save_figure(figure, file)


@pytest.mark.parametrize(
    ("name", "write"), [("a.txt", text), ("a.nc", dataset), ("a.png", picture), ("a.pdf", picture)]
)
def test_the_old_file_stays_where_there_is_no_space(tmp_path, name, write):
    assert refused(tmp_path / name, write)


def test_a_part_without_space_is_named_and_those_before_are_kept(tmp_path):
    store = Store(tmp_path / "s", {"a": 1})
    store.save(0, 0, {"x": NUMBERS[:10]}, None)
    with (
        little_space(),
        pytest.raises(NotWritten, match=r"part-00000-00001\.npz could not be written") as caught,
    ):
        store.save(0, 1, {"x": NUMBERS}, None)
    assert caught.value.code == errno.EFBIG
    assert np.array_equal(store.load(0, 0)[0]["x"], NUMBERS[:10])
    assert store.load(0, 1) is None
    assert len(list((tmp_path / "s").iterdir())) == 2


def long_branch(folder):
    with orbit._points_bar(argparse.Namespace(out=folder, range=(0.0, 1.0)), "rpm") as progress:
        for k in range(SPACE):
            progress(k / SPACE, NUMBERS[:1], NUMBERS[:2])


def test_a_branch_without_space_is_named(tmp_path):
    with little_space(), pytest.raises(NotWritten, match=r"branch\.csv could not be written") as caught:
        long_branch(tmp_path)
    assert caught.value.code == errno.EFBIG
    assert (tmp_path / "parts" / "branch.csv").stat().st_size > 0


@pytest.mark.parametrize(
    ("error", "free", "said"),
    [
        (PermissionError(errno.EACCES, "Permission denied"), 0, "No space left on device$"),
        (RuntimeError("NetCDF: HDF error"), 0, "No space left on device$"),
        (
            PermissionError(errno.EACCES, "Permission denied"),
            10**9,
            "Permission denied; choose another place$",
        ),
        (RuntimeError("NetCDF: HDF error"), 10**9, "the NetCDF library says NetCDF: HDF error$"),
    ],
)
def test_a_full_disk_is_told_whatever_the_library_takes_it_for(tmp_path, monkeypatch, error, free, said):
    data = labelled({"q": (("n",), NUMBERS)}, {}, {})

    def fails(*_, **__):
        raise error

    monkeypatch.setattr(type(data), "to_netcdf", fails)
    monkeypatch.setattr("lcpstep.dataset.shutil.disk_usage", lambda folder: SimpleNamespace(free=free))
    with pytest.raises(NotWritten, match=rf"a\.nc could not be written: {said}"):
        save(data, tmp_path / "a.nc")


def test_a_study_keeps_its_last_whole_state(tmp_path):
    file = tmp_path / "study.json"
    found = study(scenes.bouncing_ball(t_end=0.3), Moreau(), h=[1e-2], spread=(1.0,), repeats=1, save=file)
    before = file.read_bytes()
    found.notes.append("x" * 2 * SPACE)
    for name in (file, tmp_path / "study.csv"):
        with little_space(), pytest.raises(NotWritten, match=name.name):
            found.save(name)
    assert file.read_bytes() == before
    assert Study.load(file).finished
    assert list(tmp_path.iterdir()) == [file]


def test_the_command_names_the_file_and_fails(capsys, tmp_path):
    out = tmp_path / "ball.npz"
    arguments = ["simulate", "bouncing-ball", "--h", "1e-3", "--t-end", "3", "--out", str(out)]
    with little_space():
        assert main(arguments) == FAILED
    assert f"lcpstep: {out} could not be written: File too large" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
    assert main(arguments) == DONE
    assert json.loads(str(np.load(out)["summary"]))["status"] == "DONE"


def test_an_interrupt_leaves_the_old_file_and_nothing_else(tmp_path):
    file = tmp_path / "a.txt"
    file.write_text("old")
    with pytest.raises(KeyboardInterrupt), replacing(file) as draft:  # noqa: PT012
        draft.write_text("ne")
        raise KeyboardInterrupt
    assert [(x.name, x.read_text()) for x in tmp_path.iterdir()] == [("a.txt", "old")]


def test_links_and_permissions_stay(tmp_path):
    file, link = tmp_path / "a.txt", tmp_path / "link.txt"
    with replacing(file) as draft:
        draft.write_text("old")
    mask = os.umask(0)
    os.umask(mask)
    assert file.stat().st_mode & 0o777 == 0o666 & ~mask
    file.chmod(0o640)
    link.symlink_to(file)
    with replacing(link) as draft:
        draft.write_text("new")
    assert link.is_symlink()
    assert file.read_text() == "new"
    assert file.stat().st_mode & 0o777 == 0o640


def test_what_is_no_file_is_written_to_as_it_is(tmp_path):
    with replacing("/dev/null") as draft:
        draft.write_text("gone")
    assert not os.path.isfile("/dev/null")
    with pytest.raises(NotWritten, match="/dev/full could not be written"), replacing("/dev/full") as draft:
        draft.write_text("nowhere")


def test_folders_that_are_missing_are_made_and_what_is_none_is_named(tmp_path):
    with replacing(tmp_path / "new" / "one" / "a.txt") as draft:
        draft.write_text("here")
    inside = tmp_path / "new" / "one" / "a.txt" / "b.txt"
    with (
        pytest.raises(NotWritten, match=r"b\.txt could not be written: Not a dir"),
        replacing(inside) as draft,
    ):
        draft.write_text("nowhere")
    assert (tmp_path / "new" / "one" / "a.txt").read_text() == "here"
