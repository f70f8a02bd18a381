"""Motions that end in no finite numbers are told from runs that leave them by themselves."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge import physics
from benchmarks.judge.checks import check, finite
from benchmarks.judge.describe import Description
from benchmarks.judge.endless import closed_up, grows_beyond, growth
from benchmarks.judge.runs import run
from tests.judge.kept_other import OTHER

# The stiffness of a chain, rounded to three digits, is that of one that falls apart: 0.183 1/s, 705 times in 3860 s
CHAIN = Description(
    M=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), q0=(0.0, 0.0, 0.0), v0=(0.0, 0.0, 0.0),
    t_span=(0.0, 5692.24), h=0.00678, G=((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)), offset=(0.0, 0.0),
    restitution=(0.89, 0.54), K=((17.5, -17.5, 0.0), (-17.5, 34.9, -17.5), (0.0, -17.5, 17.5)),
    sine=(1.52, 3.64, -4.43), force_omega=0.758, family="chain",
)  # fmt: skip
# A dome that rises to above the body: each blow throws it back 35 times as fast
CLOSING = Description(
    M=((1.0,),), q0=(0.0888,), v0=(0.0,), t_span=(0.0, 10.5585), h=0.00764, G=((-0.0,),),
    offset=(0.1683928520065115,), restitution=1.0, C=((1.21,),), constant=(0.011001194539820958,), sine=(0.143,),
    force_omega=2.46, amplitude=(0.215,), phase=(0.0,), omega=25.8, form=1, bend=(-0.458,), round=(0.3,),
    general=True, spread=0.87, pendulum=1.21, b=(-0.32,), family="curved",
)  # fmt: skip


@pytest.fixture(scope="module")
def grown():
    return run(CHAIN, "located-exact")


def kinds(d, r):
    return {x.kind for x in check(d, r)}


def test_the_rate_of_growth_is_that_of_a_spring_of_negative_stiffness():
    one = Description(
        M=((2.0,),), q0=(1.0,), v0=(0.0,), t_span=(0.0, 1.0), h=0.01, G=((1.0,),), offset=(5.0,), K=((-8.0,),)
    )
    assert growth(one) == pytest.approx(2.0)
    assert growth(replace(one, C=((12.0,),))) == pytest.approx(-3.0 + np.sqrt(13.0))
    assert growth(replace(one, K=((8.0,),))) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.slow
def test_what_grows_without_bound_leaves_the_finite_numbers_and_is_no_anomaly(grown):
    assert grown.status == "NOT_FINITE"
    assert kinds(CHAIN, grown) == set()


@pytest.mark.slow
def test_a_run_that_leaves_them_sooner_than_anything_grows_is_one(grown):
    short = replace(grown, motion=replace(grown.motion, t=0.9 * grown.motion.t))
    assert not grows_beyond(CHAIN, short)
    assert {x.kind for x in finite(CHAIN, short)} == {"not finite"}


def test_a_dome_that_closes_up_ends_the_motion():
    r = run(CLOSING, "located-4-tolerance")
    assert r.status == "NOT_FINITE"
    assert kinds(CLOSING, r) == set()
    lower = replace(CLOSING, offset=(0.2683928520065115,))
    assert not closed_up(lower, r)


@pytest.mark.slow
def test_the_highest_gap_of_a_dome_is_the_largest_of_many_places():
    d = OTHER["a dome that turns within the step that leads nowhere"][0]
    d = replace(d, round=(0.3, 0.4, 0.0), bend=(0.185, -2.0, -0.619))
    for c in (1, 2):
        way = np.array(d.G[c]) / np.linalg.norm(d.G[c])
        middle = 0.0
        for reach in (40.0, 0.1):  # from far away, and then nearby
            x = middle + np.linspace(-reach, reach, 10_001)
            seen = physics.gaps(d, np.full(len(x), 2.0), x[:, None] * way)[:, c]
            middle = x[np.argmax(seen)]
        assert physics.highest(d, 2.0)[c] == pytest.approx(np.max(seen), abs=1e-8)
    assert physics.highest(d, 2.0)[0] == np.inf
