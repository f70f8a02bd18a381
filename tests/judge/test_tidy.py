"""Scenes as people write them, before the judge."""

import numpy as np
import pytest

from benchmarks.judge import physics
from benchmarks.judge.case import judged
from benchmarks.judge.describe import Description
from benchmarks.judge.runs import WAYS, run
from benchmarks.judge.tidy import FAMILIES, tidy
from tests.judge.test_scenes import QUICK, new
from tests.marks import shared


def test_they_are_of_all_families_and_printed_as_python():
    drawn = [tidy(2, k) for k in range(200)]
    assert {d.family for d in drawn} == set(FAMILIES)
    for k, d in enumerate(drawn):
        assert eval(repr(d), {"Description": Description}) == d == tidy(2, k)


def test_they_begin_outside_of_obstacles():
    for k in range(100):
        assert run(tidy(3, k), "event-driven").status != "refused"


def test_friction_of_a_scene_is_that_of_its_numbers():
    """Sliding velocities and Coulomb's cone, by the equations alone: nothing of the library's."""
    for k in range(60):
        d = tidy(4, k)
        if not d.T:
            continue
        scene, v = d.scene(), np.array(d.v0)
        rubbing = scene.contacts.friction
        u = rubbing.sliding(0.0, np.array(d.q0), v, scene.p, d.contacts)
        assert u == pytest.approx(physics.sliding(d, 0.0, v), abs=1e-15)
        m = run(d, "event-driven").motion
        assert np.all(np.abs(m.friction_impulse) <= np.max([d.mu, d.mu_s or d.mu], axis=0) * m.impulse + 1e-9)


@pytest.mark.parametrize("first", [0, pytest.param(10, marks=pytest.mark.slow)])
def test_ten_scenes(first):
    assert [
        (k, x) for k in range(first, first + 10) for x in new(judged(tidy(5, k), QUICK, share=0.1).findings)
    ] == []


@pytest.mark.parametrize("first", shared(range(0, 400, 20), 10))
def test_some_hundred_scenes_by_every_method(first):
    numbers = range(first, first + 20)
    assert [(k, x) for k in numbers for x in new(judged(tidy(1, k), tuple(WAYS), share=0.1).findings)] == []
