"""Runs that say that they have failed are judged up to where a step is far too long, and no further."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge import checks
from benchmarks.judge.breaking import breaks_down
from benchmarks.judge.checks import check
from benchmarks.judge.describe import Description
from benchmarks.judge.draw import draw
from benchmarks.judge.runs import Clock, run
from tests.judge.kept_jointed import JOINTED

# A light body beside a heavy one: thrown off its wall, its mass turns by many radians in a step
THROWN = Description(
    M=((0.106, 0.0), (0.0, 7190.0)), q0=(0.0, 0.0), v0=(0.0, 0.0), t_span=(0.0, 3.0), h=0.0509, G=((1.24, -0.647),),
    offset=(0.28859999999999997,), restitution=0.12, K=((1.11, 133.0), (133.0, 16500.0)), constant=(0.0, -70500.0),
    omega=9.85, form=1, bend=(-0.962,), round=(0.3,), general=True, spread=0.171, pendulum=1.43, b=(0.571, 1.3),
    family="curved",
)  # fmt: skip


@pytest.fixture(scope="module")
def thrown():
    return run(THROWN, "moreau")


@pytest.mark.slow
def test_what_grows_beyond_a_step_far_too_long_is_said_by_the_status(thrown):
    assert thrown.status == "NEWTON_FAILED"
    assert 0.1 < breaks_down(THROWN, thrown) < 0.4
    assert "energy gained" not in {x.kind for x in check(THROWN, thrown)}


@pytest.mark.slow
def test_what_grows_before_is_found(thrown, monkeypatch):
    """Speeds that have grown to twice theirs within the first three steps, with finer steps too."""
    m = thrown.motion
    faster = replace(thrown, motion=replace(m, v=m.v * np.where(m.t < 0.16, 1.0 + m.t / 0.16, 2.0)[:, None]))
    monkeypatch.setattr(checks, "run", lambda *_: faster)
    assert "energy gained" in {x.kind for x in check(THROWN, faster)}


def test_a_run_that_says_nothing_is_judged_to_its_end(thrown):
    silent = replace(thrown, status="DONE", motion=replace(thrown.motion, t=thrown.motion.t * (3.0 / 0.7126)))
    assert "energy gained" in {x.kind for x in check(THROWN, silent)}


@pytest.mark.slow
def test_a_run_that_leaves_its_joints_is_judged_up_to_where_they_swing_too_fast(monkeypatch):
    """A heavy body turns about within a millisecond, steps are seven long; before that it gains nothing."""
    d, _ = JOINTED["a joint that hands the energy of a heavy body to light ones within a millisecond"]
    r = run(d, "located")
    assert r.status == "PROJECTION_FAILED"
    m = r.motion
    r = replace(r, motion=replace(m, v=m.v * np.where(m.t > 0.095, 6.0, 1.0)[:, None]))
    assert checks.gain(d, r) > 20.0
    assert 0.08 < breaks_down(d, r) < 0.1
    assert "energy gained" not in {x.kind for x in check(d, r)}
    faster = replace(r, motion=replace(m, v=m.v * np.where(m.t < 0.05, 1.0 + m.t / 0.05, 2.0)[:, None]))
    monkeypatch.setattr(checks, "run", lambda *_: faster)
    assert "energy gained" in {x.kind for x in check(d, faster)}


def test_a_run_that_goes_on_by_roundings_of_time_alone_ends(monkeypatch):
    """Steps far too long for what swings on a round joint, 11,000 s from zero: it went on without step or event."""
    monkeypatch.setattr(Clock, "limit", 20.0)
    r = run(draw(2511250334, 4710), "located-4", 0.25)  # else it has hung
    assert r.status == "PROJECTION_FAILED"
    assert "no position near satisfies joint 0 at t = " in r.text
    assert "try a smaller h" in r.text
    assert r.motion.counts.steps + r.motion.counts.events < 10_000
