"""Steps by a tolerance where nothing is built, and with functions that stay in Python."""

import pytest

from lagrangian import LinearContacts, Scene, System
from lcpstep import Located, Moreau, SimulationError, SimulationInterrupted, Status, simulate
from tests.uncompiled import both_ways

# Impacts, forces of closed contacts, friction, releases, corners, a mass that changes, more coordinates than are
# inverted in a step
MOTIONS = """
import dataclasses
import hashlib
import numpy as np
from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import Located, Moreau, simulate

sticking = dataclasses.replace(scenes.sticking_oscillator(), t_span=(0.0, 6.0))
table = dataclasses.replace(scenes.chattering_table(), t_span=(0.0, 0.5))
K = 30.0 * (2.0 * np.eye(9) - np.eye(9, k=1) - np.eye(9, k=-1))
chain = Scene(
    LinearSystem(np.eye(9), K=K, force=Harmonic(-5.0 * np.eye(9)[0])), np.zeros(9), np.zeros(9), (0.0, 0.6),
    LinearContacts(np.eye(9)[:2], [0.1, 0.2], 0.5),
)
cases = [(s, Located(0.1, order, tolerance=1e-2)) for s in (sticking, table, chain) for order in (2, 4)]
cases += [(scenes.pendulum_stop(t_end=0.7), Located(0.1, tolerance=1e-2))]
cases += [(s, Moreau(0.1, tolerance=3e-2)) for s in (sticking, table, chain)]
for scene, method in cases:
    for keep in (1, np.linspace(*scene.t_span, 7))[: 1 + (scene is sticking)]:
        m = simulate(scene, method, keep=keep)
        numbers = b"".join(x.tobytes() for x in (m.t, m.q, m.v, m.impulse, m.friction_impulse))
        print(scene.name, method, len(m.impacts), m.counts, m.message, hashlib.sha256(numbers).hexdigest())
"""


@pytest.mark.slow
def test_steps_are_alike_where_they_are_not_built():
    built, plain = both_ways(MOTIONS)
    assert plain == built
    assert len(plain) == 13


METHODS = [Moreau(0.1, tolerance=1e-2), Located(0.1, tolerance=1e-3), Located(0.1, 4, tolerance=1e-4)]


def falling(force):
    return Scene(
        System(n_q=1, mass=[[1.0]], force=force),
        [1.0],
        [0.0],
        (0.0, 3.0),
        LinearContacts([[1.0]], restitution=0.5),
    )


@pytest.mark.filterwarnings("ignore::lcpstep.model.UncompiledCallback")
@pytest.mark.parametrize("method", METHODS)
def test_an_interrupt_within_a_function_ends_the_run(method):
    calls = []

    def force(t, q, v, p, out):
        calls.append(t)
        if len(calls) == 200:
            raise KeyboardInterrupt
        out[0] = -9.81

    with pytest.raises(SimulationInterrupted) as stopped:
        simulate(falling(force), method)
    assert len(calls) < 230
    part = stopped.value.trajectory
    assert part.status == Status.INTERRUPTED
    assert 0.0 < part.t[-1] <= max(calls)


@pytest.mark.filterwarnings("ignore::lcpstep.model.UncompiledCallback")
@pytest.mark.parametrize("method", METHODS)
def test_an_exception_of_a_function_is_the_cause(method):
    seen = []

    def force(t, q, v, p, out):
        seen.append(t)  # machine code has no such list
        if t > 0.3:
            raise ZeroDivisionError("no force from here on")
        out[0] = -9.81

    with pytest.raises(SimulationError, match="no force from here on") as stopped:
        simulate(falling(force), method)
    assert isinstance(stopped.value.__cause__, ZeroDivisionError)
    assert stopped.value.trajectory.t[-1] == pytest.approx(0.3, abs=1e-6)
