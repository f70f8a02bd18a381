"""Hops that steps of `Moreau` do not see: what a motion lacks without them."""

import pytest

from benchmarks.judge.agree import Reference, nearer
from benchmarks.judge.hops import left_within
from benchmarks.judge.runs import REFERENCE, run
from tests.judge.kept_other import OTHER

FEET = OTHER["thrown off by less than it lies within its obstacle"][0]
FAST, LIFT, AGAIN = 0.62784, 0.0504528, -3.93534  # a foot falls, rests, and is thrown off by the next
UNTIL = -1.7086


def test_a_hop_lower_than_the_depth_of_its_contact_is_hidden():
    """The foot lies up to h FAST deep, and rises by a quarter of LIFT times how long it is off the ground."""
    motion = run(FEET, REFERENCE).motion
    height = 0.25 * LIFT * 0.0218063
    for h, hidden in ((0.99 * height / FAST, False), (1.01 * height / FAST, True)):
        found = left_within(FEET, motion, h, UNTIL)
        assert found == pytest.approx(2.0 * LIFT * (UNTIL - AGAIN) if hidden else 0.0, rel=1e-4)


def test_before_the_hop_is_over_there_is_nothing_to_lack():
    motion = run(FEET, REFERENCE).motion
    assert left_within(FEET, motion, FEET.h, AGAIN + 0.01) == 0.0


def test_steps_that_see_the_hop_have_to_come_nearer():
    """By steps in which it is no higher than the depth the whole turn is missing; a quarter of these have it."""
    reference, r = Reference(FEET, run(FEET, REFERENCE)), run(FEET, "moreau")
    k = int(abs(reference.looks - UNTIL).argmin())
    apart = [reference.apart(run(FEET, "moreau", 0.23**n))[k] for n in range(4)]
    assert min(apart[1:3]) > 0.2
    assert apart[3] < 0.1 * apart[2]
    assert nearer(reference, r, k, float(apart[1]))
    assert not nearer(reference, r, k, 0.01 * float(apart[3]))
