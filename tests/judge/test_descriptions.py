"""Described scenes: what the library makes of them is what the judge's own physics says."""

import numpy as np
import pytest

from benchmarks.judge import physics
from benchmarks.judge.describe import Description
from benchmarks.judge.draw import draw
from benchmarks.judge.shapes import FAMILIES

DRAWN = [draw(11, k) for k in range(60)]


def states(d, seed=3):
    """Some states near the start."""
    rng = np.random.default_rng(seed)
    return np.array(d.q0) + rng.normal(size=(4, d.n)), rng.normal(size=(4, d.n)), d.t_span[0] + rng.random(4)


def test_a_scene_depends_on_its_seed_and_number_alone():
    assert draw(5, 17) == draw(5, 17)
    assert draw(5, 17) != draw(6, 17)


def test_a_scene_is_printed_as_python():
    for d in DRAWN:
        assert eval(repr(d), {"Description": Description}) == d


def test_all_families_are_drawn():
    assert {d.family for d in (draw(2, k) for k in range(200))} == set(FAMILIES)


def test_gaps_are_those_of_the_library():
    for d in DRAWN:
        scene = d.scene()
        for q, v, t in zip(*states(d), strict=True):
            g, u = scene.gap(t, q, v)
            np.testing.assert_allclose(physics.gaps(d, t, q), g, rtol=1e-12, atol=1e-11)
            np.testing.assert_allclose(physics.rates(d, t, q, v), u, rtol=1e-12, atol=1e-11)


def test_gap_rates_are_derivatives_of_the_gaps():
    for d in DRAWN:
        for q, v, t in zip(*states(d), strict=True):
            ahead, behind = (physics.gaps(d, t + s, q + s * v) for s in (1e-5, -1e-5))
            rate = physics.rates(d, t, q, v)
            size = 1.0 + np.abs(rate) + 1e-10 / 1e-5 * abs(t) * max(1.0, d.omega)
            assert np.all(np.abs((ahead - behind) / 2e-5 - rate) < 1e-3 * size)


def test_energy_is_kept_by_the_forces():
    """d(T + V)/dt = 0 along M v' = f where nothing damps or drives."""
    for k in range(200):
        d = draw(12, k)
        if physics.fed(d) or d.C:
            continue
        q, v, t = (x[0] for x in states(d))
        a = np.linalg.solve(physics.masses(d, q), physics.forces(d, t, q, v))
        s = 1e-6 / (1.0 + np.max(np.abs(v)) + np.max(np.abs(a)))
        energies = [sum(physics.energy(d, q + x * v, v + x * a)) for x in (s, -s)]
        kinetic, potential = physics.energy(d, q, v)
        power = (energies[0] - energies[1]) / (2.0 * s)
        assert abs(power) < 1e-3 * (kinetic + abs(potential) + abs(v) @ abs(physics.forces(d, t, q, v)))


@pytest.mark.parametrize("form", [0, 1])
def test_motions_of_obstacles_are_derivatives_of_each_other(form):
    d = Description(
        M=((1.0,),), q0=(0.0,), v0=(0.0,), t_span=(0.0, 1.0), h=0.1, G=((1.0,),), offset=(0.0,), amplitude=(0.3,),
        phase=(0.4,), omega=2.0, form=form,
    )  # fmt: skip
    t = np.linspace(0.05, 9.0, 57)
    for order in (0, 1):
        slope = (physics.obstacles(d, t + 1e-6, order) - physics.obstacles(d, t - 1e-6, order)) / 2e-6
        np.testing.assert_allclose(slope, physics.obstacles(d, t, order + 1), atol=1e-7)
