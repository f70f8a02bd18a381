"""Saltation matrices of systems with modes, against closed forms and differences of the motion itself."""

import math

import numpy as np
import pytest

from lagrangian import Guard, HybridScene, HybridSystem, Mode, scenes
from lcpstep import EventDriven, simulate
from lcpstep.analysis.derivative import differences
from lcpstep.analysis.hybrid_variation import monodromy

METHOD = EventDriven()


def end(scene, mode):
    return lambda x: simulate(scene.started(x, mode), METHOD).x[-1]


@pytest.mark.parametrize(
    "scene",
    [
        pytest.param(scenes.bilinear_oscillator(damping=0.1, amplitude=0.7, t_end=9.0), id="bilinear"),
        pytest.param(scenes.dry_friction_oscillator(1.05, t_end=9.0), id="dry-friction"),
        pytest.param(scenes.stick_slip_oscillator(t_end=13.0), id="stick-slip"),
    ],
)
def test_derivative_of_the_motion_is_that_of_its_differences(scene):
    x0 = np.array(scene.x0) - [0.0, 0.01 if scene.name == "dry-friction-oscillator" else 0.0]
    if scene.name == "stick-slip-oscillator":  # a start off the belt, where all directions are possible
        x0 = np.array([1.2, -0.1])
        scene = scene.started(x0, "slower")
    run = simulate(scene.started(x0, scene.mode), METHOD)
    assert len(run.switches) >= 2
    expected = differences(end(scene, scene.mode), x0)
    np.testing.assert_allclose(
        monodromy(run), expected, rtol=0, atol=1e-8 * max(1.0, np.max(np.abs(expected)))
    )


def test_a_free_bilinear_oscillator_comes_back_after_its_period():
    scene = scenes.bilinear_oscillator(left=2.0, right=5.0, x0=-0.8, v0=0.3)
    period = math.pi / math.sqrt(2.0) + math.pi / math.sqrt(5.0)
    run = simulate(scene.started(scene.x0, "left", (0.0, period)), METHOD)
    np.testing.assert_allclose(monodromy(run), np.eye(2), rtol=0, atol=1e-10)


def test_sliding_loses_a_dimension():
    run = simulate(scenes.dry_friction_oscillator(1.05, t_end=18.0), METHOD)
    M = monodromy(run)
    assert run.mode[-1] == "stick"
    assert np.linalg.matrix_rank(M, tol=1e-9) == 1
    np.testing.assert_allclose(M[1], 0.0, atol=1e-12)


def swinging(t, x, p, out):
    out[0], out[1] = x[1], -math.sin(x[0])


def swinging_faster(t, x, p, out):
    out[0], out[1] = x[1], -2.0 * math.sin(x[0])


def side(t, x, p, out):
    out[0] = math.sin(x[0])


def test_turns_that_an_angle_has_made_are_nothing_to_the_derivative():
    """Over a share of 1e4 rad a sine tells nothing of its slope."""
    modes = {
        "left": Mode(swinging, [Guard(side, "right")]),
        "right": Mode(swinging_faster, [Guard(side, "left", -1)]),
    }
    system, found = HybridSystem(2, modes), []
    for turns in (0, 100, 10_000):
        start = [2.0 * math.pi * turns - 0.5, 3.0]
        run = simulate(HybridScene(system, start, "left", (0.0, 5.0)), METHOD)
        assert len(run.switches) == 3
        found.append(monodromy(run))
    np.testing.assert_allclose(found[1:], [found[0]] * 2, rtol=0, atol=1e-8)
    assert np.linalg.det(found[0]) == pytest.approx(1.0, abs=1e-8)
