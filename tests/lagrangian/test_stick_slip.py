"""Exact motions of belts, superball and rocking block: equations of motion, laws of impact, conservation."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrangian import scenes
from lagrangian.scenes.belts import shaken_multipliers, shaken_phase
from lagrangian.scenes.rocking_block import friction_needed
from lagrangian.scenes.superball import bounces
from lcpstep import EventDriven, Kind, Moreau, Status, simulate

ETA = 1e-4  # of the differences [s]


def obeys_coulomb(scene, mu, belt, times):
    """The friction that the motion asks for: mu against the sliding, less than mu where there is none."""
    t = np.asarray(times)
    (q, v), (_, before), (_, after) = (scene.exact(t + d) for d in (0.0, -ETA, ETA))
    friction = (after - before)[:, 0] / (2.0 * ETA) + q[:, 0]
    slip = v[:, 0] - belt(t)
    slides = np.abs(slip) > 1e-3
    smooth = np.ones(len(t), dtype=bool)
    for d in (-ETA, ETA):  # no change of mode in between
        u = scene.exact(t + d)[1][:, 0] - belt(t + d)
        smooth &= (np.abs(u) > 1e-3) == slides
        smooth &= ~slides | (u * slip > 0.0)
    wrong = np.where(slides, np.abs(friction + mu * np.sign(slip)), np.maximum(np.abs(friction) - mu, 0.0))
    carried = ~slides & (np.abs(slip) < 1e-12)
    assert np.sum(smooth) > 0.9 * len(t)
    assert np.max(wrong[smooth & (slides | carried)]) < 1e-6


@settings(max_examples=50, deadline=None)
@given(st.floats(0.05, 1.0), st.floats(0.05, 1.0), st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
def test_the_motion_on_an_even_belt_obeys_coulomb_and_is_continuous(belt, mu, x0, v0):
    scene = scenes.mass_on_belt(belt=belt, mu=mu, x0=x0, v0=v0)
    t = np.linspace(0.01, 39.0, 700)
    obeys_coulomb(scene, mu, lambda s: belt + 0.0 * s, t)
    q, v = scene.exact(np.linspace(0.0, 40.0, 40001))
    last_digit = np.spacing(np.max(np.abs(q)))  # of a mass that all but rests
    assert np.max(np.abs(np.diff(q[:, 0]))) <= 1e-3 * 1.1 * np.max(np.abs(v)) + last_digit
    assert np.max(np.abs(np.diff(v[:, 0]))) <= 1e-3 * 1.1 * (np.max(np.abs(q[:, 0])) + mu)


@pytest.mark.parametrize(("mu", "amplitude", "omega"), [(0.1, 1.0, 1.5), (0.05, 1.0, 0.8), (0.1, 2.0, 0.6)])
def test_den_hartogs_motion_obeys_coulomb_repeats_and_its_multipliers_are_those_of_differences(
    mu, amplitude, omega
):
    scene = scenes.mass_on_shaken_belt(mu, amplitude, omega)
    phase, T = shaken_phase(mu, amplitude, omega), scene.period
    obeys_coulomb(
        scene, mu, lambda s: -amplitude * omega * np.sin(omega * s + phase), np.linspace(0.01, 2.9 * T, 500)
    )
    assert np.allclose(scene.exact(np.array([T]))[0], scene.exact(np.zeros(1))[0], atol=1e-13)

    def after_a_period(x):  # from where no turn is near
        made = scenes.mass_on_belt(
            belt=0.0, mu=mu, amplitude=amplitude, omega=omega, phase=phase + 0.25 * omega * T,
            x0=x[0], v0=x[1], t_end=T,
        )  # fmt: skip
        run = simulate(made, EventDriven())
        return np.array([run.q[-1, 0], run.v[-1, 0]])

    start = np.array([part[0, 0] for part in scene.exact(np.array([0.25 * T]))])
    d = 1e-4
    J = np.stack(
        [(after_a_period(start + e) - after_a_period(start - e)) / (2 * d) for e in d * np.eye(2)], 1
    )
    found = np.sort_complex(np.linalg.eigvals(J).astype(complex))
    assert np.max(np.abs(found - np.sort_complex(np.array(shaken_multipliers(mu, amplitude, omega))))) < 1e-5


def test_friction_too_strong_for_a_motion_without_a_stop_is_refused():
    with pytest.raises(ValueError, match="mu: expected friction weak enough"):
        scenes.mass_on_shaken_belt(mu=3.0)


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(0.1, 1.0), st.floats(0.5, 5.0))
def test_a_superball_keeps_its_energy_and_undoes_its_bounces(v, rim, beta, v_N):
    after, spin = bounces(v, rim, 2, v_N, 100.0, beta)
    assert np.allclose([after[2], spin[2]], [v, rim], rtol=0.0, atol=1e-13)
    assert after[1] + spin[1] == pytest.approx(-(v + rim), abs=1e-13)
    energy = after**2 + beta * spin**2
    assert np.ptp(energy) <= 1e-13 * (1.0 + energy[0])
    slid, rolled = bounces(v, rim, 1, v_N, 0.05, beta)
    assert slid[1] ** 2 + beta * rolled[1] ** 2 <= energy[0] + 1e-13


def test_a_superball_with_the_right_spin_goes_to_and_fro():
    scene = scenes.superball(spin=1.0 / (0.4 * 0.03))
    x = scene.exact(np.linspace(0.0, 5.0, 400))[0][:, 0]
    assert np.ptp(x) < 2.0 * 2.0 * math.sqrt(2.0 * 0.5 / 9.81)
    sliding_only = scenes.superball(mu=1e-12).exact(np.array([5.0]))
    assert sliding_only[0][0, 0] == pytest.approx(5.0, abs=1e-9)


@pytest.mark.parametrize(("b", "h", "theta0"), [(0.1, 0.4, 0.15), (0.1, 0.4, 0.24), (0.2, 0.3, 0.3)])
def test_corners_slide_exactly_where_friction_is_too_weak(b, h, theta0):
    mu = friction_needed(theta0, b, h)
    strong, weak = (
        scenes.rocking_block(b, h, theta0, mu=share * mu, form="corners", t_end=1.5) for share in (1.01, 0.95)
    )
    assert strong.exact is not None
    assert weak.exact is None
    runs = [simulate(scene, EventDriven(1e-10, 1e-10)) for scene in (strong, weak)]
    slips = [np.max(np.abs(np.einsum("ij,ij->i", tangents(run), run.v))) for run in runs]
    assert slips[0] < 1e-9
    assert slips[1] > 1e-4


def tangents(run):
    """Rows of the corner that carries the block."""
    b, h = run.scene.p
    s, c = np.sin(run.q[:, 2]), np.cos(run.q[:, 2])
    one = np.ones(len(s))
    return np.stack([one, 0.0 * one, np.where(s >= 0.0, b, -b) * s + h * c], axis=1)


def test_a_block_that_rocks_and_slides_comes_to_what_time_stepping_says():
    scene = scenes.sliding_rocking_block(t_end=1.0)
    run = simulate(scene, EventDriven())
    assert run.status == Status.DONE
    assert {Kind.SLIP, Kind.STICK_TANGENT, Kind.IMPACT, Kind.RELEASE} <= set(run.impacts.kind)
    coarse, fine = (simulate(scene, Moreau(h), keep=[1.0]).q[-1] - run.q[-1] for h in (1e-4, 1e-5))
    assert np.max(np.abs(fine)) < 0.2 * np.max(np.abs(coarse)) + 1e-7
