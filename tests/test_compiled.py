"""Kernels are compiled once: one signature for all scenes, kept on disk for the next process."""

import math
from typing import NamedTuple

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, simulate
from lcpstep.compiled import by_address, compiled, jit_disabled
from lcpstep.events.flight.loop import run as run_flights
from lcpstep.events.single.loop import run as run_single
from tests.models import ball_on_table, bowl_scene, pendulum
from tests.processes import python

pytestmark = pytest.mark.skipif(jit_disabled(), reason="nothing is compiled")


def free(t, q, v, p, out):
    out[0] = -p[0]


def swing(t, q, v, p, out):
    out[0], out[1], out[2] = math.sin(p[0] * t), -p[1] * q[1], p[2]


def varied():
    """Linear scenes with other sizes, callbacks, parameters and numbers of contacts."""
    yield ball_on_table(0.01, 40.0, 0.3, 0.02, 0.0, 0.05)
    yield Scene(
        system=LinearSystem(M=1.0, force=free), q0=1.0, v0=0.0, t_span=(0.0, 0.05), parameters={"g": 9.81}
    )
    yield Scene(
        system=LinearSystem(M=np.eye(3), K=np.eye(3), force=swing), q0=np.zeros(3), v0=np.zeros(3), p=[1.0, 2.0, 3.0],
        t_span=(0.0, 0.05), contacts=LinearContacts(G=np.eye(3), restitution=[0.1, 0.5, 0.9]),
    )  # fmt: skip
    yield bowl_scene([0.5, 0.0], [0.0, 0.0], 0.05)


def general():
    """General systems, the same way."""
    yield pendulum(1.0, 0.5, 0.05)
    yield pendulum(0.3, 0.0, 0.05, jacobians=False)
    yield Scene(system=System(3, np.eye(3), swing), q0=np.zeros(3), v0=np.zeros(3), p=[1.0, 2.0, 3.0],
                t_span=(0.0, 0.05))  # fmt: skip
    curved = bowl_scene([0.5, 0.0], [0.0, 0.0], 0.05, bias=False).contacts
    yield Scene(
        system=System(2, np.eye(2), two_forces), contacts=Contacts(1, curved.gap, curved.jacobian), q0=[0.1, 0.1],
        v0=[0.0, 0.0], t_span=(0.0, 0.05),
    )  # fmt: skip


def two_forces(t, q, v, p, out):
    out[0], out[1] = -v[0], -9.81


@pytest.mark.parametrize("keep", [1, 7, [0.01, 0.02], "impacts"])
def test_the_event_driven_kernels_have_one_signature_for_all_scenes(keep):
    for scene in [*varied(), *general()]:
        if scene.n_c <= 1:
            simulate(scene, EventDriven(1e-8, 1e-8), keep=keep)
    for kernel in (run_flights, run_single):
        assert len(compiled(kernel).signatures) == 1


AHEAD_OF_TIME = """
import sys
from lagrangian import scenes
from lcpstep import Moreau, simulate
for scene in (scenes.bouncing_ball(t_end=0.1), scenes.coulomb_oscillator(t_end=0.1)):
    for keep in (1, 7, [0.01, 0.02], "impacts"):
        simulate(scene, Moreau(1e-3), keep=keep)
print("numba" in sys.modules)
"""
SMALL_KERNEL = """
from lcpstep.compiled import compiled
from lcpstep.events.flight.oscillator import flow, oscillator
kernel = compiled(flow)
kernel(oscillator(1.0, 0.1, 1.0, 0.0, 1.0, 0.0, 2.0), 0.0, 1.0, 0.0, 0.5)
print(sum(kernel.stats.cache_hits.values()), sum(kernel.stats.cache_misses.values()))
"""


def test_steps_of_one_size_compile_nothing():
    assert python(AHEAD_OF_TIME).split("\n")[-1] == "False"


def test_the_next_process_finds_the_kernel_on_disk(tmp_path):
    first, second = (python(SMALL_KERNEL, NUMBA_CACHE_DIR=str(tmp_path)) for _ in range(2))
    assert first.split("\n")[-1] == "0 1"
    assert second.split("\n")[-1] == "1 0"


SCENE_FILE = """
from lagrangian import Scene, System
import numpy as np
import os
NUMBER = float(os.environ["NUMBER"])
ARRAY = np.array([NUMBER])

def helper(x):
    return NUMBER * x

def force(t, q, v, p, out):
    out[0] = {expression}

scene = Scene(system=System(1, 1.0, force), q0=1.0, v0=0.0, t_span=(0.0, 1.0))
"""


@pytest.mark.parametrize("expression", ["NUMBER", "helper(1.0)", "ARRAY[0]"])
def test_a_callback_kept_on_disk_is_not_taken_for_another(tmp_path, expression):
    (tmp_path / "scene.py").write_text(SCENE_FILE.replace("{expression}", expression))
    run = (
        f"import sys; sys.path.insert(0, {str(tmp_path)!r}); from scene import scene; "
        "from lcpstep import Moreau, simulate; print(simulate(scene, Moreau(0.5)).v[-1, 0])"
    )
    for number in ("2.0", "3.0", "2.0"):
        assert float(python(run, NUMBER=number).split("\n")[-1]) == float(number)


@by_address
class Inner(NamedTuple):
    x: np.ndarray
    count: int


@by_address
class Outer(NamedTuple):
    inner: Inner
    y: np.ndarray
    scale: float
    whole: bool


def gather(o, times):
    total = 0
    for i in range(times):
        for j in range(len(o.inner.x)):
            o.inner.x[j] += o.scale * o.y[i % 2, j]
        total += weigh_rows(o)
    return total


def weigh_rows(o):
    o.y[1, 0] += o.y[0, 0]
    return o.inner.count if o.whole else -o.inner.count


@pytest.mark.parametrize("whole", [True, False])
def test_a_tuple_handed_on_by_address_is_read_and_its_arrays_written_as_in_plain_python(whole):
    def made():
        return Outer(Inner(np.arange(3.0), 7), np.arange(6.0).reshape(2, 3), 0.5, whole)

    plain, fast = made(), made()
    for times in (4, 3):  # the second call reads its own tuple, not the first one's
        assert compiled(gather)(fast, times) == gather(plain, times)
    np.testing.assert_array_equal(fast.inner.x, plain.inner.x)
    np.testing.assert_array_equal(fast.y, plain.y)
    other = made()._replace(scale=2.0)
    compiled(gather)(other, 1)
    np.testing.assert_array_equal(other.inner.x, np.arange(3.0) + 2.0 * np.arange(3.0))


def test_the_type_of_a_tuple_by_address_has_a_short_name_and_tells_kinds_apart():
    from numba import typeof

    compiled(gather)
    first = typeof(Inner(np.zeros(2), 1))
    assert first == typeof(Inner(np.ones(5), 2))
    assert first != typeof(Inner(np.ones(5), 2.0))
    assert first != typeof(Inner(np.ones((2, 2)), 2))
    assert len(first.name) < 30
