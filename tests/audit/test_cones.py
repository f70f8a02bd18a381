"""Closed contacts with dry friction: forces by the audit against those of the run, and what is certified of them."""

from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Located, simulate
from lcpstep.audit import audit
from lcpstep.audit.pieces import Pieces
from lcpstep.audit.windows import Windows
from lcpstep.trajectory import Kind

NODES, WEIGHTS = np.polynomial.legendre.leggauss(5)


def friction(share=1.0):
    """Of two blocks on swaying belts."""
    slip = Harmonic([-0.2, 0.1], [0.3, 0.0], [0.0, 0.2], 1.7)
    T = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]
    return Coulomb(np.array([0.3, 0.2]) * share, T, slip=slip, mu_s=np.array([0.4, 0.2]) * share)


def blocks(seed=0, t_end=20.0):
    """Two blocks on swaying belts, joined by a spring, that are shaken along and across."""
    push = 2.0 * np.random.default_rng(seed).uniform(0.5, 2.0)
    K, G = np.zeros((4, 4)), [[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
    K[::2, ::2] = [[6.0, -3.0], [-3.0, 3.0]]
    force = Harmonic([0.0, -9.81, 0.0, -19.6], [push, 1.0, 0.0, 3.0], [0.0, 0.0, 1.0, 0.0], 2.3)
    return Scene(
        system=LinearSystem(M=np.diag([1.0, 1.0, 2.0, 2.0]), C=np.diag([0.05, 0.0, 0.05, 0.0]), K=K, force=force),
        contacts=LinearContacts(G, 0.0, 0.3, friction=friction()),
        q0=[0.5, 0.0, 0.0, 0.0], v0=[0.0, 0.0, 0.4, 0.0], t_span=(0.0, t_end),
    )  # fmt: skip


@pytest.mark.parametrize("seed", range(3))
def test_sticking_and_sliding_blocks_are_certified(seed):
    run = simulate(blocks(seed), EventDriven())
    assert {Kind.SLIP, Kind.STICK_TANGENT} <= set(run.impacts.kind)
    answer = audit(run)
    assert answer.share == pytest.approx(1.0, abs=1e-9)
    assert answer.windows == ()


def test_the_forces_are_those_of_the_run():
    run = simulate(blocks(), EventDriven())
    p = Pieces(run)
    k = np.flatnonzero(np.diff(run.t) > 1e-6)
    no = np.zeros(len(k), dtype=bool)
    pushed = np.zeros((len(k), 2))
    for x, share in zip(NODES, WEIGHTS, strict=True):
        t = run.t[k] + 0.5 * (1.0 + x) * np.diff(run.t)[k]
        q, v = run.at(t)
        waves = [f(w * t) for w in (2.3, 1.7) for f in (np.cos, np.sin)]
        known = np.concatenate([q, v, np.ones((len(k), 1)), np.stack(waves, axis=1)], axis=1)
        for c in range(2):
            rows, _ = p.cones.rows(Windows(k, np.full(len(k), c), run.t[k], run.t[k + 1], no, no, no))
            pushed[:, c] += 0.5 * share * np.diff(run.t)[k] * np.sum(rows[:, 0] * known, axis=1)
    np.testing.assert_allclose(pushed, run.impulse[k + 1], rtol=0, atol=1e-9)


@pytest.mark.parametrize("share", [0.97, 0.5])
def test_less_friction_than_the_run_has_had_is_not_certified(share):
    run = simulate(blocks(), EventDriven())
    scene = replace(run.scene, contacts=replace(run.scene.contacts, friction=friction(share)))
    answer = audit(replace(run, scene=scene))
    assert answer.share < 1.0
    assert "how fast it slides, is as near to its limit" in str(answer)
    assert not answer.missed


def test_a_contact_that_would_be_drawn_is_not_certified():
    run = simulate(blocks(), EventDriven())
    force = replace(run.scene.system.force, cosine=np.array([2.0, 12.0, 0.0, 3.0]))
    drawn = replace(run.scene, system=replace(run.scene.system, force=force))
    assert any(x.contact == 0 for x in audit(replace(run, scene=drawn)).windows)


@pytest.mark.parametrize(
    "name", ["coulomb-oscillator", "mass-on-belt", "mass-on-shaken-belt", "slipping-wheel"]
)
def test_scenes_that_rub_along_a_line_are_certified(name):
    assert audit(simulate(scenes.CATALOGUE[name].make(), EventDriven())).share == 1.0


def test_steps_leave_it_to_the_run_as_before():
    answer = audit(simulate(blocks(t_end=2.0), Located(1e-2)))
    assert "looked at by the run alone" in answer.windows[0].why
