"""The judge tells rounding that adds up over many steps from error."""

from dataclasses import replace

from benchmarks.judge.checks import check
from benchmarks.judge.runs import run
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
