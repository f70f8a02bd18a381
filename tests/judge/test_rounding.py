"""The judge tells rounding that adds up over many steps from error."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge.checks import check
from benchmarks.judge.describe import Description, numbers
from benchmarks.judge.runs import run
from tests.judge.kept_other import OTHER
from tests.judge.kept_recently import RECENTLY


def pressed_while_open(d, r, opened):
    """Whether the judge finds an impulse on an open contact in a run whose kept states are moved by so much."""
    moved = replace(r, motion=replace(r.motion, q=r.motion.q + opened))
    return "impulse while open" in {x.kind for x in check(d, moved)}


def test_gaps_drift_by_rounding_of_impulses_as_long_as_something_rests():
    """2000 steps of rest in the apex of five walls move them by 7e-13; no step may move them by so much."""
    d, _ = RECENTLY["rest in the apex of five walls for two thousand steps"]
    r = run(d, "moreau")
    assert not pressed_while_open(d, r, 0.0)
    assert pressed_while_open(d, r, 1e-11)
    early = replace(d, t_span=(0.0, 20.0 * d.h))
    assert pressed_while_open(early, run(early, "moreau"), 3e-13)


GROOVE = Description(
    M=((1.0, 0.0), (0.0, 1.0)), q0=(0.0, 0.0), v0=(0.0, 0.0), t_span=(-51800.0, -51799.74), h=0.0115,
    G=((0.862, 0.507), (-0.375, 0.927)), offset=(-0.08967075530492283, 0.08702926227928887), restitution=0.7,
    K=((49.8, -11.4), (-11.4, 9.0)), constant=(0.0, -9.81), cosine=(3.57, -4.44), force_omega=2.08,
    amplitude=(0.0901, 0.0901), phase=(3.54, 0.0), omega=10.6, form=1, function=True, family="groove",
)  # fmt: skip


@pytest.mark.parametrize("method", ["located-tolerance", "located-4-tolerance"])
def test_hops_at_the_rounding_of_time_end(method):
    """50,000 and 20,000 events before: two walls chatter, and each impact on the one throws off the other anew."""
    r = run(GROOVE, method)
    assert r.done
    assert len(r.motion.impacts) < 2000


def table(t0, bodies):
    """Balls that chatter on a table from time t0 on, each from another height."""
    return Description(
        M=numbers(np.eye(bodies)), q0=tuple(0.1 + 0.01 * k for k in range(bodies)), v0=(0.0,) * bodies,
        t_span=(t0, t0 + 2.0), h=0.01, G=numbers(np.eye(bodies)), offset=(0.0,) * bodies, restitution=0.7,
        constant=(-9.81,) * bodies, amplitude=(0.05,) * bodies, phase=(-10.5 * t0,) * bodies, omega=10.5, form=1,
        function=True,
    )  # fmt: skip


@pytest.mark.parametrize("method", ["located", "located-tolerance", "located-4"])
@pytest.mark.parametrize("bodies", [1, 2])
def test_chattering_takes_no_more_events_far_from_time_zero(method, bodies):
    """Four to six times as many by steps of order two before."""
    near, far = (run(table(t0, bodies), method).motion for t0 in (0.0, -65536.0))
    assert 25 * bodies < len(near.impacts)
    assert abs(len(far.impacts) - len(near.impacts)) < 0.1 * len(near.impacts)
    np.testing.assert_allclose(far.q[-1], near.q[-1], atol=1e-8)


def test_a_bead_at_rest_on_its_wall_takes_part_in_blows_in_any_order_of_coordinates():
    """Rounding of its speed let it go by a damper: to the next blow it was in flight, 4e-3 off from there on."""
    d = OTHER["beads in a row of which the first rests against a wall"][0]
    order = [1, 0, 3, 2]
    names = {"q0": d.q0, "v0": d.v0, "constant": d.constant}
    turned = {name: tuple(values[k] for k in order) for name, values in names.items()}
    turned["G"] = tuple(tuple(row[k] for k in order) for row in d.G)
    for name in ("M", "C"):
        turned[name] = tuple(tuple(getattr(d, name)[i][k] for k in order) for i in order)
    q, other = (run(x, "located").motion.at(4.0)[0] for x in (d, replace(d, **turned)))
    assert np.allclose(other, q[order], rtol=0.0, atol=1e-9)
