"""Machine code on disk: found again, never taken for another, made again where damaged."""

import importlib.util
import itertools
import os
import runpy
import sys
import tempfile
import weakref

import numpy as np
import pytest

from lcpstep.callbacks import compiling
from lcpstep.pointers import callback_at
from tests.marks import compiled_only

pytestmark = compiled_only
FUNCTIONS = """
def double(t, q, v, p, out):
    out[:] = 2.0 * q[0]

def triple(t, q, v, p, out):
    out[:] = 3.0 * q[0]
"""
NUMBERS = itertools.count()


@pytest.fixture
def load(tmp_path, monkeypatch):
    """A function that imports the functions of a file anew, as the next process would."""
    import numba

    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "user"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "user"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    (tmp_path / "temporary").mkdir()
    name, file = f"functions_{next(NUMBERS)}", tmp_path / "source" / "functions.py"
    file.parent.mkdir()
    file.write_text(FUNCTIONS)

    def imported():
        spec = importlib.util.spec_from_file_location(name, file)
        module = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, name, module)
        spec.loader.exec_module(module)
        return module

    return imported


def entries(folder):
    return sorted(folder.rglob("*.kernel"))


def from_disk(f, ndim=1):
    """Whether machine code of the function was found; it must be right."""
    from lcpstep.callbacks.machine_code import OnDisk

    found, load = [], OnDisk.load_overload

    def watched(self, *arguments):
        found.append(load(self, *arguments))
        return found[-1]

    compiling.MADE.clear()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(OnDisk, "load_overload", watched)
        compiled = callback_at(compiling.address(f, ndim))
    q, out, expected = np.array([1.5]), np.zeros((1,) * ndim), np.zeros((1,) * ndim)
    compiled(0.5, q, q, np.zeros(0), out, np.array([1, 1, 0, 1, ndim - 1]))
    f(0.5, q, q, np.zeros(0), expected)
    assert np.array_equal(out, expected)
    return found[0] is not None


def said(caplog, what):
    return sum(what in record.getMessage() for record in caplog.records)


def test_machine_code_lies_beside_its_source_and_is_found_again(load, tmp_path):
    assert [from_disk(load().double) for _ in range(3)] == [False, True, True]
    assert len(entries(tmp_path / "source" / "__pycache__")) == len(entries(tmp_path)) == 1


def test_machine_code_of_a_file_that_was_run_is_found_again_and_nothing_is_imported(
    load, tmp_path, monkeypatch
):
    """A file that runpy runs is no module; another module of its name is nothing that may be run."""
    from numba.core.environment import Environment

    load()  # sets the folders
    other = tmp_path / "elsewhere" / "mine.py"
    other.parent.mkdir()
    other.write_text("raise SystemExit('imported')")
    monkeypatch.syspath_prepend(other.parent)
    found = []
    for run_name in (None, None, "mine", "mine"):
        monkeypatch.setattr(Environment, "_memo", weakref.WeakValueDictionary())  # as in the next process
        module = runpy.run_path(str(tmp_path / "source" / "functions.py"), run_name=run_name)
        found.append(from_disk(module["double"]))
    assert found[1::2] == [True, True]


def test_other_types_and_other_tools_have_their_own(load, tmp_path, monkeypatch):
    from lcpstep.callbacks import machine_code

    assert not from_disk(load().double)
    assert not from_disk(load().double, ndim=2)
    assert from_disk(load().double, ndim=2)
    monkeypatch.setattr(machine_code, "toolchain", lambda: "another version of numba")
    assert not from_disk(load().double)
    assert len(entries(tmp_path)) == 3


@pytest.mark.parametrize(
    "damage",
    [
        lambda x: b"",
        lambda x: x[: len(x) // 2],
        lambda x: np.random.default_rng(1).bytes(len(x)),
        lambda x: x[:-1],
    ],
    ids=["empty", "half", "noise", "one byte less"],
)
def test_a_damaged_entry_is_said_and_made_again(load, tmp_path, caplog, damage):
    from_disk(load().double)
    (entry,) = entries(tmp_path)
    entry.write_bytes(damage(entry.read_bytes()))
    assert not from_disk(load().double)
    assert said(caplog, f"{entry} is damaged") == 1
    assert from_disk(load().double)
    assert said(caplog, "is damaged") == 1


def test_no_flipped_bit_passes(load, tmp_path):
    from lcpstep.callbacks.machine_code import own_number, read

    from_disk(load().double)
    (entry,) = entries(tmp_path)
    content = entry.read_bytes()
    assert read(entry, {own_number()}) is not None
    for k in range(0, 8 * len(content), 8 * len(content) // 200):
        flipped = bytearray(content)
        flipped[k // 8] ^= 1 << (k % 8)
        entry.write_bytes(flipped)
        assert read(entry, {own_number()}) is None


def close(tmp_path):
    """Leave no folder to write to beside the source or in the user's cache, for the administrator either."""
    (tmp_path / "source" / "__pycache__").write_text("no folder")
    (tmp_path / "user").write_text("no folder")


@pytest.fixture
def silent(monkeypatch):
    """As if nothing had been said before in this process."""
    from lcpstep.callbacks import machine_code

    monkeypatch.setattr(machine_code, "TOLD", [])


@pytest.mark.skipif(os.name == "nt", reason="folders for temporary files are the user's own there")
def test_a_read_only_package_keeps_its_machine_code_in_a_private_folder(load, tmp_path, caplog, silent):
    sys.dont_write_bytecode, before = True, sys.dont_write_bytecode
    try:
        close(tmp_path)
        assert [from_disk(load().double), from_disk(load().triple)] == [False, False]
        assert [from_disk(load().double), from_disk(load().triple)] == [True, True]
    finally:
        sys.dont_write_bytecode = before
    private = tmp_path / "temporary" / f"lcpstep-{os.getuid()}"
    assert private.stat().st_mode & 0o777 == 0o700
    assert len(entries(private)) == 2
    assert said(caplog, "cannot be kept where it belongs") == said(caplog, f"{private} takes it") == 1


@pytest.mark.skipif(os.name == "nt", reason="folders for temporary files are the user's own there")
@pytest.mark.parametrize("why", ["open to others", "a link", "missing"])
def test_where_no_folder_takes_it_each_process_compiles(load, tmp_path, caplog, silent, monkeypatch, why):
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    close(tmp_path)
    private = tmp_path / "temporary" / f"lcpstep-{os.getuid()}"
    if why == "open to others":
        private.mkdir(mode=0o777)
        private.chmod(0o777)
    elif why == "a link":
        (tmp_path / "elsewhere").mkdir(mode=0o700)
        private.symlink_to(tmp_path / "elsewhere")
    else:
        monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "nowhere"))
    assert [from_disk(load().double), from_disk(load().triple)] == [False, False]
    assert not from_disk(load().double)
    assert said(caplog, "each process compiles anew") == said(caplog, "cannot be kept") == 1
    assert entries(tmp_path) == []


@pytest.mark.skipif(
    not hasattr(os, "getuid") or os.getuid() != 0, reason="only the administrator gives files away"
)
def test_machine_code_of_another_user_is_not_run(load, tmp_path):
    from_disk(load().double)
    (entry,) = entries(tmp_path)
    os.chown(entry, 12345, -1)
    assert not from_disk(load().double)
    os.chown(entry, 12345, -1)
    os.chown(tmp_path / "source" / "functions.py", 12345, -1)  # whose source is run, may have compiled it
    assert from_disk(load().double)


def test_a_disk_that_is_full_stops_no_run(load, tmp_path, caplog, silent):
    resource = pytest.importorskip("resource")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, limits[1]))
    try:
        assert not from_disk(load().double)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert entries(tmp_path) == []
    assert said(caplog, "each process compiles anew") == 1
    assert [from_disk(load().double) for _ in range(2)] == [False, True]


READING = """
import os
from collections import namedtuple
from enum import Enum, IntEnum
from types import ModuleType

NUMBER = float(os.environ["NUMBER"])
settings = ModuleType("settings")
settings.MASS = NUMBER

class Box(IntEnum):
    SIDE = int(NUMBER)

class Wall(Enum):
    SIDE = NUMBER

Pair = namedtuple("Pair", "a b" if NUMBER == 2.0 else "b a")
PAIR = Pair(2.0, 3.0)

def double(t, q, v, p, out):
    {body}
"""


@pytest.mark.parametrize(
    "body",
    [
        "out[0] = settings.MASS", "out[0] = Box.SIDE.value", "f = lambda z: NUMBER * z\n    out[0] = f(1.0)",
        "out[0] = Wall.SIDE.value", "out[0] = PAIR.a", "out[0] = Pair(2.0, 3.0).a",
    ],
    ids=[
        "attribute of a module", "member of an enumeration", "read by a function inside",
        "member that is no whole number", "named tuple", "class of named tuples",
    ],
)  # fmt: skip
def test_what_a_function_reads_in_other_places_is_noticed(load, tmp_path, monkeypatch, body):
    (tmp_path / "source" / "functions.py").write_text(READING.replace("{body}", body))
    hits = []
    for number in (2.0, 3.0, 2.0):
        monkeypatch.setenv("NUMBER", str(number))
        hits.append(from_disk(load().double))
    assert hits == [False, False, True]
