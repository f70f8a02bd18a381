"""Scenes with friction in small units, by powers of two, which round nothing: the same runs."""

from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, simulate
from tests import random_friction, random_slopes

G0 = 9.81


def in_unit(scene, length):
    """A random scene whose coordinates are so many times as large."""
    system, contacts, force, p = scene.system, scene.contacts, scene.system.force, np.array(scene.p)
    terms = (length * np.array(x) for x in (force.constant, force.cosine, force.sine))
    p[::3] *= length  # of what shakes
    friction = replace(contacts.friction, slip=length * np.array(contacts.friction.slip))
    contacts = replace(contacts, offset=length * np.array(contacts.offset), friction=friction)
    system = replace(system, force=Harmonic(*terms, omega=force.omega))
    q, v = length * np.array(scene.q0), length * np.array(scene.v0)
    return replace(scene, system=system, q0=q, v0=v, p=p, contacts=contacts)


def stack(unit):
    """Three blocks that fall onto each other on a belt that sways, in metres times the unit."""
    rows, along = np.zeros((3, 6)), np.zeros((3, 6))
    for i in range(3):
        rows[i, 3 + i], along[i, i] = 1.0, 1.0
        if i > 0:
            rows[i, 2 + i], along[i, i - 1] = -1.0, -1.0
    sway = Harmonic(sine=[-0.6 * unit, 0.0, 0.0], omega=12.0)
    contacts = LinearContacts(rows, 0.0, [0.5, 0.3, 0.2], friction=Coulomb([0.5, 0.4, 0.3], along, slip=sway))
    q, v = unit * np.array([0, 0, 0, 0.1, 0.25, 0.3]), unit * np.array([0.3, 0.0, -0.5, 0, 0, 0])
    return Scene(LinearSystem(np.eye(6), force=[0] * 3 + [-G0 * unit] * 3), q, v, (0.0, 1.0), contacts)


@pytest.mark.parametrize(("order", "error"), [(2, 1e-5), (4, 5e-8)])
def test_hops_in_small_units_are_not_over_before_those_in_metres(order, error):
    """They ended at 1e-12 m: blocks of 1e-11 m never moved as those of a metre, and runs said nothing."""
    true = simulate(stack(1.0), EventDriven(1e-13, 1e-15), keep=[0.5, 1.0])
    for unit in (1.0, 2.0**-30, 2.0**-37, 2.0**-60):
        run = simulate(stack(unit), Located(1e-3, order), keep=[0.5, 1.0])
        assert run.q / unit == pytest.approx(true.q, abs=error)


def test_a_slow_collapse_is_not_over_before_a_fast_one():
    """Of 1e-9 m/s a thousandth was none, and balls between walls were 4e-4 m off where they had come to."""
    fast = random_slopes.draw(5115)
    fast = replace(fast, system=replace(fast.system, force=0.0))
    end = fast.t_span[1]
    true = simulate(fast, EventDriven(1e-13, 1e-15), keep=[end])
    slow = replace(fast, v0=1e-9 * np.array(fast.v0), t_span=(0.0, 1e9 * end))
    for method in (Located(1e7), Located(1e7, order=4)):
        assert simulate(slow, method, keep=[1e9 * end]).q == pytest.approx(true.q, abs=1e-11)


@pytest.mark.parametrize("source", [random_slopes, random_friction])
@pytest.mark.parametrize("order", [2, 4])
def test_random_scenes_move_alike_in_any_small_unit(source, order):
    for seed in range(20):
        scene = source.draw(seed)
        one, *others = (
            simulate(in_unit(scene, unit), Located(1e-2, order), keep=50)
            for unit in (2.0**-20, 2.0**-37, 2.0**-60)
        )
        for unit, run in zip((2.0**-17, 2.0**-40), others, strict=True):
            assert run.status == one.status
            np.testing.assert_array_equal(run.impacts.time, one.impacts.time)
            np.testing.assert_array_equal(run.q, unit * one.q)
