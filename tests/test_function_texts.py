"""What a saved run says of its functions: their text and checksum are those of the functions that ran."""

import os
import subprocess
import sys
from dataclasses import dataclass
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader

import numpy as np
import pytest

from lagrangian import Scene, System
from lcpstep.analysis.bifurcation import bifurcation
from lcpstep.callbacks import functions
from lcpstep.described import checksum
from lcpstep.errors import SweepStopped

STIFFNESS = 5.0


def force(t, q, v, p, out):
    out[0] = -STIFFNESS * q[0]


def test_a_function_is_told_by_what_it_reads_now(monkeypatch):
    before = functions.checksum(force)
    monkeypatch.setitem(globals(), "STIFFNESS", 7.0)
    assert functions.checksum(force) != before


@dataclass
class Spring:
    k: float = 4.0


class Pull:
    """A force with a stiffness of its own, that counts how often it was asked."""

    def __init__(self, k):
        self.k, self.asked = k, 0

    def __call__(self, t, q, v, p, out):
        self.asked += 1
        out[0] = -self.k * q[0]

    def pull(self, t, q, v, p, out):
        out[0] = -self.k * q[0]


class Counting(Pull):
    """The same, by a method of its own."""

    def __call__(self, t, q, v, p, out):
        self.count()
        out[0] = -self.k * q[0]

    def count(self):
        self.asked += 1


class Slotted:
    """A force whose attributes have slots."""

    __slots__ = ("__weakref__", "k")

    def __init__(self, k):
        self.k = k

    def __call__(self, t, q, v, p, out):
        out[0] = -self.k * q[0]


TABLE, NESTED, SPRING, CALLS, COUNT = {"k": [4.0, 5.0]}, ([1.0], {"k": 4.0}), Spring(), [], {"n": 0}


def tabled(t, q, v, p, out):
    out[0] = -TABLE["k"][0] * q[0]


def nested(t, q, v, p, out):
    out[0] = -NESTED[1]["k"] * q[0]


def sprung(t, q, v, p, out):
    CALLS.append(t)
    COUNT["n"] += 1
    out[0] = -SPRING.k * q[0]


FORCES = (tabled, nested, sprung)


def scene_of(force):
    def mass(t, q, v, p, out):
        out[0, 0] = 1.0

    return Scene(System(1, mass=mass, force=force), q0=1.0, v0=0.0, t_span=(0.0, 1.0), period=1.0)


def test_lists_dictionaries_and_objects_are_read_with_all_they_hold(monkeypatch):
    before = [functions.checksum(f) for f in FORCES]
    monkeypatch.setitem(TABLE, "k", [9.0, 5.0])
    monkeypatch.setitem(NESTED[1], "k", 9.0)
    monkeypatch.setattr(SPRING, "k", 9.0)
    assert all(functions.checksum(f) != old for f, old in zip(FORCES, before, strict=True))


@pytest.mark.parametrize("pull", [Pull(4.0), Counting(4.0)], ids=["at once", "by a method"])
def test_what_a_function_counts_makes_no_other_function_of_it(pull):
    before = functions.checksum(sprung), checksum(scene_of(pull))
    sprung(0.0, [1.0], [0.0], [], [0.0])
    pull(0.0, [1.0], [0.0], [], [0.0])
    assert (functions.checksum(sprung), checksum(scene_of(pull))) == before


@pytest.mark.parametrize("kind", [Pull, Counting, Slotted])
def test_objects_that_are_called_are_told_by_their_attributes(kind):
    assert checksum(scene_of(kind(4.0))) == checksum(scene_of(kind(4.0)))
    assert checksum(scene_of(kind(4.0))) != checksum(scene_of(kind(5.0)))


def test_methods_are_told_by_the_attributes_of_their_object():
    assert checksum(scene_of(Pull(4.0).pull)) == checksum(scene_of(Pull(4.0).pull))
    assert checksum(scene_of(Pull(4.0).pull)) != checksum(scene_of(Pull(5.0).pull))


def test_checksums_are_the_same_in_another_process():
    code = "from lcpstep.callbacks import functions; from tests import test_function_texts as m; "
    code += "print(*map(functions.checksum, m.FORCES), m.checksum(m.scene_of(m.Pull(4.0))))"
    mine = [*map(functions.checksum, FORCES), checksum(scene_of(Pull(4.0)))]
    told = subprocess.run(
        [sys.executable, "-c", code], env=os.environ | {"PYTHONHASHSEED": "7"}, capture_output=True, text=True,
        check=True,
    )  # fmt: skip
    assert told.stdout.split() == mine


def test_parts_of_a_diagram_are_of_what_makes_its_scenes(tmp_path):
    bend = {"in the middle": 0.0}

    def make(k):
        inner = bend["in the middle"] if 1.0 < k < 2.0 else 0.0
        return scene_of(Pull(k + inner))

    def asked():
        return bifurcation(make, "k", [1.0, 1.5, 2.0], x0=[1.0, 0.0], drop=1, keep=2, out=tmp_path / "parts")

    first = asked()
    assert np.array_equal(asked().q, first.q)
    bend["in the middle"] = 0.4
    with pytest.raises(SweepStopped, match="another sweep"):
        asked()


def test_text_of_a_file_that_was_edited_meanwhile_is_not_taken_for_the_function_that_runs(tmp_path):
    file = tmp_path / "edited.py"
    for edited in ("def f(x):\n    return 3.0 * x\n", "f = (\n"):
        file.write_text("def f(x):\n    return 2.0 * x\n")
        module = module_from_spec(spec_from_loader("edited", SourceFileLoader("edited", str(file))))
        module.__loader__.exec_module(module)
        file.write_text(edited)
        functions.source_of.cache_clear()
        assert functions.described(module.f)["source"] == ""
