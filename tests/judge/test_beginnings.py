"""Scenes that the judge makes of one: its beginning, and a second part that is begun anew."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.judge.case import LONG, beginning
from benchmarks.judge.describe import Description
from benchmarks.judge.physics import rates
from benchmarks.judge.runs import run
from benchmarks.judge.variants import rest
from benchmarks.judge.vary import base, same


@pytest.mark.parametrize(("speed", "rests"), [(-1e-6, True), (-1e-2, False)])
def test_a_second_part_begins_at_rest_where_a_tolerance_tells_no_speed(speed, rests):
    """Two beads on each other and on an elastic table that goes up."""
    d = Description(
        M=((1.0, 0.0), (0.0, 3.0)), q0=(0.0, 0.0), v0=(0.0, 0.0), t_span=(0.0, 0.2), h=0.1,
        G=((1.0, 0.0), (-1.0, 1.0)), offset=(0.0, 0.0), restitution=1.0, constant=(-9.81, -30.0),
        amplitude=(0.1, 0.0), phase=(0.0, 0.0), omega=1.0,
    )  # fmt: skip
    q, v = np.full(2, 0.1 * np.sin(0.1)), 0.1 * np.cos(0.1) + np.array([speed, 0.5 * speed])
    motion = SimpleNamespace(q=q[None], v=v[None], at=lambda t: (q, v))
    second = rest(d, np.random.default_rng(1), motion, 1e-4).scene
    still = np.max(np.abs(rates(second, 0.1, q, np.array(second.v0)))) < 1e-15
    assert second.t_span == (0.1, 0.2)
    assert bool(still) is rests
    assert rest(d, np.random.default_rng(1), motion).scene.v0 == tuple(v)


@pytest.mark.parametrize("off", [0.0, 1e-9])
def test_a_run_begins_anew_without_places_that_are_rounding(off):
    """Pressed by 5.75 m/s^2 between two walls in one place; begun 1e-9 m off, it is a step's way off, and so told."""
    d = Description(
        M=((0.00577,),), q0=(0.0,), v0=(0.0,), t_span=(0.0, 2.0), h=0.0682, G=((1.0,), (-1.0,)), offset=(0.0, 0.0),
        restitution=(0.58, 0.0), K=((0.000155,),), constant=(0.0332,), family="slit",
    )  # fmt: skip
    motion = SimpleNamespace(
        q=np.zeros((2, 1)), v=np.zeros((2, 1)), at=lambda t: (np.array([-5e-16 - off]), np.zeros(1))
    )
    v = rest(replace(d, offset=(off, 0.0)), np.random.default_rng(1), motion)
    found = list(same(base(d, run(d, "moreau")), run(v.scene, "moreau"), v))
    assert bool(found) is (off > 0.0)


def test_of_a_long_scene_methods_by_a_tolerance_are_asked_the_beginning():
    """A ball that is let fall, and its steps by a tolerance: four times the span takes eight times as many."""
    d = Description(
        M=((1.0,),),
        q0=(1.0,),
        v0=(0.0,),
        t_span=(-3.0, 3.0),
        h=0.01,
        K=((25.0,),),
        G=((1.0,),),
        offset=(2.0,),
    )
    steps = [
        run(replace(d, t_span=(-3.0, end)), "moreau-tolerance").motion.counts.steps for end in (0.0, 9.0)
    ]
    assert steps[1] > 6 * steps[0]
    long = replace(d, t_span=(-3.0, 4.0 * LONG * d.h))
    assert beginning(long, "moreau") == long
    assert beginning(d, "moreau-tolerance") == d
    assert beginning(long, "moreau-tolerance") == replace(long, t_span=(-3.0, -3.0 + LONG * d.h))
