"""How fast the theta-method converges: to closed forms, and to the event-driven integrator."""

import numpy as np
import pytest

from lagrangian import scenes
from lcpstep import EventDriven, Moreau, simulate
from tests.known import KNOWN, SPREAD

LEVELS = (100, 200, 400, 800)


def slope(levels, errors):
    return -np.polyfit(np.log(levels), np.log(errors), 1)[0]


def observed_order(known, theta, levels=LEVELS):
    """Slope of log(mean |q - q_exact|) over log h, each level averaged over SPREAD."""
    span, errors = np.ptp(known.scene.t_span), []
    for n in levels:
        motions = [simulate(known.scene, Moreau(span / round(n * s), theta)) for s in SPREAD]
        errors.append(np.mean([np.mean(np.abs(m.q[:, 0] - known.q(m.t))) for m in motions]))
    return slope(levels, errors)


@pytest.mark.parametrize("known", KNOWN, ids=lambda k: k.name)
@pytest.mark.parametrize(("theta", "smooth_order"), [(0.5, 2), (0.75, 1), (1.0, 1)])
def test_moreau_reaches_its_order(known, theta, smooth_order):
    expected = 1 if known.impacts else smooth_order
    assert observed_order(known, theta) == pytest.approx(expected, abs=0.25)


SCENES = [
    pytest.param(scenes.impact_oscillator(t_end=15.0), (500, 1000, 2000, 4000, 8000), id="impact-oscillator"),
    # five impacts; each of them multiplies differences, and chaos makes later ones useless
    pytest.param(
        scenes.cam_follower(rpm=358.0, t_end=0.35), (1000, 2000, 4000, 8000, 16000), id="cam-follower"
    ),
]


@pytest.mark.parametrize(("scene", "levels"), SCENES)
@pytest.mark.parametrize("theta", [0.5, 0.75, 1.0])
def test_moreau_converges_to_the_event_driven_motion_with_order_one(scene, levels, theta):
    reference, span = simulate(scene, EventDriven()), np.ptp(scene.t_span)
    of_q, of_v = [], []
    for n in levels:
        q_errors, v_errors = [], []
        for s in SPREAD:
            m = simulate(scene, Moreau(span / round(n * s), theta))
            q, v = reference.at(m.t)
            q_errors.append(np.max(np.abs(m.q - q)))
            # velocities jump: their distance is an integral
            v_errors.append(np.trapezoid(np.abs(m.v - v)[:, 0], m.t))
        of_q.append(np.mean(q_errors))
        of_v.append(np.mean(v_errors))
    assert slope(levels, of_q) == pytest.approx(1.0, abs=0.25)
    assert slope(levels, of_v) == pytest.approx(1.0, abs=0.25)


@pytest.mark.parametrize("theta", [0.5, 0.75, 1.0])
def test_impact_times_converge_with_order_one_and_come_at_most_a_step_late(theta):
    scene = scenes.impact_oscillator(t_end=15.0)
    exact = simulate(scene, EventDriven()).impacts
    errors, levels = [], (500, 1000, 2000, 4000)
    for n in levels:
        scatter = []
        for s in SPREAD:
            log = simulate(scene, Moreau(15.0 / round(n * s), theta)).impacts
            log = log[log.kind == 0]
            scatter.append(np.mean(np.abs(log.time[: len(exact)] - exact.time)))
            assert len(log) == len(exact)
        errors.append(np.mean(scatter))
    assert slope(levels, errors) == pytest.approx(1.0, abs=0.25)


@pytest.mark.parametrize("h", [1e-4, 3.7e-4, 1e-3, 7.3e-3, 0.02])
def test_the_first_impact_is_moved_to_the_end_of_its_step_or_the_next(h):
    log = simulate(scenes.bouncing_ball(t_end=1.0), Moreau(h, theta=0.5)).impacts
    late = log.time[0] - np.sqrt(2 / 9.81)
    # active where g + (h/2) u <= 0 at the start of a step, that is up to half a step before the impact
    assert -0.5 * h <= late <= 1.5 * h + 1e-3 * h
