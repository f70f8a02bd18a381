"""Surfaces that bend over less than the motion is long, and kinks of theirs at which switching accumulates."""

import math

import numpy as np
import pytest

from lagrangian import HybridScene, HybridSystem, Mode, Surface
from lcpstep import EventDriven, Status, simulate

METHOD = EventDriven()


def forwards(t, x, p, out):  # p: speed of the drive
    out[0], out[1] = 1.0, p[0]


def backwards(t, x, p, out):
    out[0], out[1] = 1.0, -p[0]


def beside_a_sine(t, x, p, out):
    out[0] = x[1] - math.sin(x[0])


@pytest.mark.parametrize(("angle", "span"), [(0.0, 10.0), (1e3, 10.0), (1e5, 10.0), (0.0, 300.0)])
def test_sliding_follows_a_surface_by_an_angle_however_often_that_has_turned(angle, span):
    system = HybridSystem(
        2, {"up": Mode(forwards), "down": Mode(backwards)}, [Surface(beside_a_sine, "up", "down")]
    )
    start = [angle, math.sin(angle) - 0.1]
    run = simulate(HybridScene(system, start, "up", (0.0, span), p=[2.0]), METHOD)
    assert (run.status, list(run.switches.target)) == (Status.DONE, ["sliding"])
    t = np.linspace(run.switches.time[0], span, 2000)
    x = run.at(t)
    np.testing.assert_allclose(x[:, 0], angle + t, rtol=1e-12, atol=1e-10)
    np.testing.assert_allclose(x[:, 1], np.sin(x[:, 0]), rtol=0, atol=20e-12 + 1e-14 * angle)


def up(t, x, p, out):
    out[0] = p[0]


def down(t, x, p, out):
    out[0] = -p[0]


def beside_what_moves_once(t, x, p, out):
    out[0] = x[0] - math.tanh(t - p[1])


def test_sliding_follows_a_surface_that_moves_for_a_short_part_of_a_long_span():
    system = HybridSystem(
        1, {"up": Mode(up), "down": Mode(down)}, [Surface(beside_what_moves_once, "up", "down")]
    )
    run = simulate(HybridScene(system, [-1.1], "up", (0.0, 1e3), p=[2.0, 500.0]), METHOD)
    assert (run.status, list(run.switches.target)) == (Status.DONE, ["sliding"])
    t = np.linspace(490.0, 510.0, 2000)
    np.testing.assert_allclose(run.at(t)[:, 0], np.tanh(t - 500.0), rtol=0, atol=1e-10)


def pushed(t, x, p, out):
    out[0], out[1] = x[1], 1.0


def pulled(t, x, p, out):
    out[0], out[1] = x[1], -1.0


def beside_a_parabola(t, x, p, out):  # that of the other side beyond the origin
    out[0] = x[0] + p[0] * x[1] * abs(x[1])


@pytest.mark.parametrize("c", [0.1, 0.3, 0.4446])
def test_switches_of_fullers_phenomenon_are_a_geometric_series(c):
    """Between two of them x -+ v^2/2 is constant, so of one speed to the next the square is (1 - 2c)/(1 + 2c)."""
    system = HybridSystem(
        2, {"pos": Mode(pushed), "neg": Mode(pulled)}, [Surface(beside_a_parabola, "pos", "neg")]
    )
    run = simulate(HybridScene(system, [1.0, 0.0], "neg", (0.0, 30.0), p=[c]), METHOD)
    speeds = np.abs(run.switches.before[:, 1])
    ratio, seen = math.sqrt((1.0 - 2.0 * c) / (1.0 + 2.0 * c)), int(np.sum(speeds > 1e-5))
    assert seen >= math.log(1e-5) / math.log(ratio)
    first = math.sqrt(1.0 / (0.5 + c))
    np.testing.assert_allclose(speeds[:seen], first * ratio ** np.arange(seen), rtol=0, atol=1e-6)
    np.testing.assert_allclose(
        run.switches.time[:seen],
        first * (1.0 + (1.0 + ratio) * np.concatenate([[0.0], np.cumsum(ratio ** np.arange(seen - 1))])),
        rtol=0,
        atol=1e-7,
    )


def both_against(t, x, p, out):
    out[0], out[1] = x[1], -p[0] - p[1]


def drag_on(t, x, p, out):
    out[0], out[1] = x[1], -p[0] + p[1]


def drag_back(t, x, p, out):
    out[0], out[1] = x[1], p[0] - p[1]


def both_on(t, x, p, out):
    out[0], out[1] = x[1], p[0] + p[1]


def place(t, x, p, out):
    out[0] = x[0]


def speed(t, x, p, out):
    out[0] = x[1]


def test_spiralling_into_a_crossing_of_two_surfaces_ends_soon_after_it_is_there():
    """A twisting controller: in half a turn the speed at x = 0 falls by sqrt((a - b)/(a + b)), to zero in the end."""
    a, b = 1.0, 0.4
    modes = {"pp": Mode(both_against), "pn": Mode(drag_on), "np": Mode(drag_back), "nn": Mode(both_on)}
    surfaces = [
        Surface(place, "np", "pp", "ahead"),
        Surface(place, "nn", "pn", "back"),
        Surface(speed, "pn", "pp", "right"),
        Surface(speed, "nn", "np", "left"),
    ]
    system = HybridSystem(2, modes, surfaces)
    scene = HybridScene(system, [0.0, 1.0], "pp", (0.0, 30.0), p=[a, b])
    run = simulate(scene, EventDriven(max_events=10_000))
    falls = math.sqrt((a - b) / (a + b))
    half_a_turn = 1.0 / (a + b) + 1.0 / math.sqrt((a + b) * (a - b))
    assert run.status == Status.ENDLESS_SWITCHING
    assert run.t[-1] == pytest.approx(half_a_turn / (1.0 - falls), abs=1e-4)
    np.testing.assert_allclose(run.x[-1], 0.0, rtol=0, atol=1e-5)
