"""Steps that make a body faster than anything could, where walls leave it no place: the run says so."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge.describe import Description
from lagrangian import Contacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Moreau, SimulationError, simulate
from lcpstep.doubts.outrun import outrun
from lcpstep.kernels.outrun import steepest
from lcpstep.model import looked_at
from lcpstep.trajectory import Status
from tests.uncompiled import both_ways

# Three walls that move hold it where they meet, until they meet nowhere, at t = 0.02796
NOWHERE = Description(
    M=((0.362, 0.0, 0.0), (0.0, 2.65, 0.0), (0.0, 0.0, 1.43)), q0=(0.0, 0.0, 0.0), v0=(0.0, 0.0, 0.0),
    t_span=(0.0, 0.07833), h=0.00373, G=((1.93, -1.43, 1.38), (-0.395, -0.498, -0.312), (-0.26, 0.885, 0.0842)),
    offset=(0.2745674464638197, 0.18689999999999998, -0.006183723231909858), restitution=0.33,
    constant=(0.0, 0.0, -14.0), amplitude=(0.0236, 0.0236, -0.0118), phase=(2.59, 0.0, 2.59), omega=8.92,
    bend=(-0.874, -0.623, 0.217), round=(0.3, 0.3, 0.0), family='curved',
)  # fmt: skip


def test_walls_that_meet_nowhere_are_told():
    """Order 4 goes on at any speed, order 2 inside of a wall; each had said DONE."""
    scene = NOWHERE.scene()
    exact = simulate(scene, EventDriven())
    assert exact.status in (Status.STEP_TOO_SMALL, Status.LCP_FAILED)  # as rounding has it
    assert exact.t[-1] == pytest.approx(0.02796, abs=1e-5)
    try:  # how fast it becomes hangs on how the machine rounds
        run = simulate(scene, Located(NOWHERE.h, 4))
        assert run.doubt != ""
    except SimulationError as ended:
        run = ended.trajectory
    assert np.max(np.abs(run.v)) > 1e6
    assert outrun(replace(run, status=Status.DONE)).startswith("its kinetic energy grows from")
    run = simulate(scene, Located(NOWHERE.h))
    assert re.match(r"contact \d lies 0\.\d+ m inside of its obstacle", run.doubt)


def table(size, omega):
    """A bent wall under a plate: its gap is q + q^2/8 - size sin(omega t)."""

    def gap(t, q, v, p, out):
        out[0] = q[0] + 0.125 * q[0] * q[0] - size * math.sin(omega * t)

    def jacobian(t, q, v, p, out):
        out[0, 0] = 1.0 + 0.25 * q[0]

    def rate(t, q, v, p, out):
        out[0] = -size * omega * math.cos(omega * t)

    return Contacts(1, gap, jacobian, gap_t=rate, restitution=0.9)


@pytest.mark.parametrize("method", [Moreau(1e-2), Located(1e-2), Located(1e-2, 4)], ids=str)
@pytest.mark.parametrize(
    ("size", "omega", "force"), [(0.02, 30.0, -9.81), (0.3, 20.0, -1.0), (0.0, 1.0, -100.0)]
)
def test_what_obstacles_and_forces_give_is_no_doubt(method, size, omega, force):
    """A table strikes a plate that rests on it; a force throws it from a height."""
    start = 0.0 if size else 2.0
    run = simulate(
        Scene(LinearSystem(M=1.0, force=force), start, 0.0, (0.0, 1.0), table(size, omega)), method
    )
    assert (run.status, outrun(run)) == (Status.DONE, "")
    assert np.max(np.abs(run.v)) > 0.5


def pull(t, q, v, p, out):
    out[0], out[1] = 3.0 - 5.0 * q[0], -2.0 * q[1] + math.sin(t)


def wall(t, q, v, p, out):
    out[0] = q[0] + 0.5 * q[1] * q[1] - 0.2 * math.sin(3.0 * t)


def slope(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, q[1]


def rise(t, q, v, p, out):
    out[0] = -0.6 * math.cos(3.0 * t)


M = np.array([[2.0, 0.5], [0.5, 1.0]])


def test_the_bound_is_that_of_the_equation():
    scene = Scene(
        System(2, M, pull), [0.5, 0.1], [1.0, 0.0], (0.0, 5.0), Contacts(1, wall, slope, gap_t=rise)
    )
    rng = np.random.default_rng(3)
    n = 30
    t = np.cumsum(rng.choice([0.1, 0.2], n, p=[0.8, 0.2]))
    q, v, impulse = (
        rng.uniform(-1.0, 1.0, (n, 2)),
        rng.uniform(-3.0, 3.0, (n, 2)),
        rng.uniform(0.0, 2.0, (n, 1)),
    )

    def times(k):
        h, strongest, fastest, f, g_t = t[k + 1] - t[k], 0.0, 0.0, np.zeros(2), np.zeros(1)
        for share in (0.0, 0.5, 1.0):
            at = t[k] + share * h, (1.0 - share) * q[k] + share * q[k + 1], None, None
            pull(*at, f)
            rise(*at, g_t)
            strongest, fastest = max(strongest, f @ np.linalg.solve(M, f)), max(fastest, abs(g_t[0]))
        start, end = 0.5 * v[k] @ M @ v[k], 0.5 * v[k + 1] @ M @ v[k + 1]
        given = 0.5 * (math.sqrt(2.0 * start) + h * math.sqrt(strongest)) ** 2 + impulse[k + 1, 0] * fastest
        return end / given, k, start, end

    for parts in (1, 4, 64):
        looked = []
        for i in range(parts):
            grown = {
                k: v[k + 1] @ v[k + 1] - v[k] @ v[k]
                for k in range(i * (n - 1) // parts, (i + 1) * (n - 1) // parts)
                if t[k + 1] - t[k] < 0.15
            }
            if grown and max(grown.values()) > 0.0:
                looked.append(times(max(grown, key=grown.get)))
        expected = max(looked)
        np.testing.assert_allclose(
            steepest(looked_at(scene), t, q, v, impulse, 0.15, parts), expected, rtol=1e-12
        )


PROGRAM = """
from dataclasses import replace
from lagrangian import scenes
from lcpstep import Located, simulate
from lcpstep.kernels.outrun import steepest
from lcpstep.model import model

scene = scenes.CATALOGUE["bowl"].make()
run = simulate(replace(scene, t_span=(0.0, 1.0)), Located(0.02))
for parts in (1, 3, 64):
    print(*(float(x).hex() for x in steepest(model(scene), run.t, run.q, run.v, run.impulse, 0.021, parts)))
"""


@pytest.mark.slow
def test_the_bound_of_the_sources_alone_is_that_of_what_is_built():
    built, plain = both_ways(PROGRAM)
    assert built == plain
    assert len(built) == 3


def test_rounding_beside_what_an_impact_has_brought_to_rest_is_no_gain():
    """A pendulum that a plastic wall stops: speeds of 1e-90 m/s come and go in its joint."""
    stopped = Description(
        M=((1.0, 0.0), (0.0, 1.0)), q0=(0.6, -0.8), v0=(-0.8, -0.6), t_span=(0.0, 3.0), h=0.01, G=((1.0, 0.0),),
        offset=(-0.6,), J=((0.0, 0.0),), joint_offset=(-0.5,), joint_bend=(1.0,),
    )  # fmt: skip
    for order in (2, 4):
        run = simulate(stopped.scene(), Located(0.01, order))
        assert run.doubt == ""
        np.testing.assert_allclose(run.q[-1], stopped.q0, rtol=0, atol=1e-14)
