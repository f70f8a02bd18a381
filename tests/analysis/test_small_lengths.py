"""Derivatives and orbits know no unit of length: a mechanism of nanometres has those of the same one in metres."""

import math

import numpy as np
import pytest

from lagrangian import (
    Contacts,
    Coulomb,
    Harmonic,
    HybridScene,
    HybridSystem,
    LinearContacts,
    LinearSystem,
    Mode,
    Scene,
    Surface,
    System,
)
from lcpstep import EventDriven
from lcpstep.analysis.attractors import attractors
from lcpstep.analysis.lyapunov import lyapunov
from lcpstep.analysis.map_diagram import periodic_points
from lcpstep.analysis.orbits import periodic_orbit
from lcpstep.analysis.starts import random_starts
from lcpstep.analysis.variation import PeriodMap

T = 2.0 * math.pi / 1.3


def force(t, q, v, p, out):  # p: the unit of length
    x, y = q[0] / p[0], q[1] / p[0]
    pull = y - x + 0.5 * math.sin(y - x)
    out[0] = p[0] * (pull - x + 2.0 * math.sin(1.3 * t)) - 0.1 * v[0]
    out[1] = -p[0] * pull - 0.1 * v[1]


def gap(t, q, v, p, out):
    out[0] = q[0] + 0.3 * p[0] * (1.0 + math.sin(q[1] / p[0]) ** 2)


def slope(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, 0.3 * math.sin(2.0 * q[1] / p[0])


def two_masses(unit, friction):
    contacts = Contacts(1, gap, slope, restitution=0.7, friction=friction)
    q0, v0 = unit * np.array([0.5, 0.6]), unit * np.array([0.3, -0.2])
    return Scene(System(2, np.eye(2), force), q0, v0, (0.0, T), contacts=contacts, p=[unit], period=T)


@pytest.mark.parametrize("friction", [None, Coulomb(0.2, [[0.0, 1.0]])], ids=["smooth", "rough"])
def test_the_derivative_of_a_motion_does_not_depend_on_the_unit_of_length(friction):
    found = []
    for unit in (1.0, 1e-9):
        P = PeriodMap(two_masses(unit, friction), EventDriven(1e-11, 1e-11 * unit))
        x = unit * np.array([0.5, 0.6, 0.3, -0.2])
        assert P.follow(x, 1).impacts[0, 0] > 0
        found.append(P.jacobian(x))
    assert np.max(np.abs(found[0])) > 0.3
    assert found[1] == pytest.approx(found[0], abs=1e-6)


def test_a_small_orbit_is_shot_to_as_many_digits_as_a_large_one():
    def struck(unit):
        block = LinearSystem(M=1.0, C=0.1, K=1.0, force=Harmonic(sine=2.0 * unit, omega=1.3))
        stop = LinearContacts(G=1.0, offset=0.3 * unit, restitution=0.7)
        return Scene(block, unit, 0.0, (0.0, T), contacts=stop, period=T)

    guess = np.array([0.965, 0.315])
    large, small = (periodic_orbit(struck(unit), unit * guess) for unit in (1.0, 1e-12))
    assert np.max(np.abs(large.x[0] - guess)) > 1e-5
    assert small.x == pytest.approx(1e-12 * large.x, rel=1e-9, abs=0.0)
    assert small.multipliers == pytest.approx(large.multipliers, abs=1e-9)


def soft(t, x, p, out):
    out[0], out[1] = x[1], p[0] * (2.0 * math.sin(1.3 * t) - math.sin(x[0] / p[0])) - 0.5 * x[0] - 0.1 * x[1]


def stiff(t, x, p, out):
    out[0], out[1] = (
        x[1],
        p[0] * (2.0 * math.sin(1.3 * t) - 4.0 * math.sin(x[0] / p[0])) - 0.5 * x[0] - 0.1 * x[1],
    )


def curve(t, x, p, out):
    out[0] = x[0] - 0.3 * p[0] * math.cos(x[1] / p[0])


def test_the_derivative_of_a_motion_with_modes_does_not_depend_on_it_either():
    sides = [Surface(curve, below="stiff", above="soft")]
    system = HybridSystem(2, {"soft": Mode(soft), "stiff": Mode(stiff)}, surfaces=sides)
    found = []
    for unit in (1.0, 1e-3, 1e-9):
        scene = HybridScene(system, [0.5 * unit, 0.0], "soft", (0.0, T), p=[unit], period=T)
        P = PeriodMap(scene, EventDriven(1e-12, 1e-12 * unit))
        x = unit * np.array([0.5, 0.3])
        assert P.follow(x, 1).impacts[0, 0] > 0
        found.append(P.jacobian(x))
    assert found[1:] == [pytest.approx(found[0], abs=1e-8)] * 2


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
def test_a_map_without_a_derivative_is_differenced_over_its_own_length(unit):
    def sine(x):
        return np.array([0.95 * unit * math.sin(math.pi * x[0] / unit)])

    (cycle,) = periodic_points(sine, [[0.0], [unit]], 1, starts=20)[1:]
    slope = 0.95 * math.pi * math.cos(math.pi * cycle.points[0, 0] / unit)
    assert cycle.points[0] == pytest.approx(sine(cycle.points[0]), rel=1e-14)
    assert cycle.multipliers[0].real == pytest.approx(slope, abs=1e-9)
    one = lyapunov(lambda x: sine(unit * x) / unit, [0.3], 30)
    assert lyapunov(sine, [0.3 * unit], 30).largest == pytest.approx(one.largest, abs=1e-6)


@pytest.mark.parametrize(
    ("unit", "place"), [pytest.param(1e-6, 1.0, marks=pytest.mark.slow), (1.0, 1e4), (1e-3, -3.0)]
)
def test_attractors_of_a_motion_far_from_zero_are_those_near_it(unit, place):
    def struck(unit, place):
        force = Harmonic(constant=place, cosine=unit, omega=2.6)
        stop = LinearContacts(G=-1.0, offset=place + 0.3 * unit, restitution=0.8)
        block = LinearSystem(M=1.0, C=0.04, K=1.0, force=force)
        return Scene(block, place, 0.0, (0.0, 1.0), contacts=stop, period=2.0 * math.pi / 2.6)

    starts = random_starts([[-1.0, -1.0], [0.3, 1.0]], 20, seed=0)
    near, far = (
        attractors(struck(unit, place), EventDriven(1e-12, 1e-12 * unit), [place, 0.0] + unit * starts)
        for unit, place in ((1.0, 0.0), (unit, place))
    )
    assert [a.name for a in near.found] == ["O(4, 2)", "O(4, 3)", "O(1, 0)"]
    assert [(a.name, a.share) for a in far.found] == [(a.name, a.share) for a in near.found]
    for one, other in zip(near.found, far.found, strict=True):
        assert other.lyapunov.largest == pytest.approx(one.lyapunov.largest, abs=1e-5)
