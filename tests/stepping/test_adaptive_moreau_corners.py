"""Moreau with a tolerance where an obstacle's velocity, or a force, jumps at a corner: against closed forms."""

import numpy as np
import pytest
from scipy.linalg import expm

from lagrangian import LinearContacts, LinearSystem, Scene, System
from lcpstep import Kind, Moreau, Status, simulate

WEIGHT, AT = 9.0, 0.3171


def table(t, q, v, p, out):
    """Moves with p[0] up to the corner at p[2], with p[1] after it."""
    out[0, 0] = p[0] * min(t - p[2], 0.0) + p[1] * max(t - p[2], 0.0)
    out[0, 1], out[0, 2] = p[0] if t < p[2] else p[1], 0.0


def falls(t, q, v, p, out):
    out[0] = -WEIGHT


def on_a_table(before, later, restitution, q, v, end, system="linear"):
    made = System(1, [[1.0]], falls) if system == "general" else LinearSystem(1.0, force=-WEIGHT)
    contacts = LinearContacts(1.0, 0.0, restitution, motion=table)
    return Scene(made, q, v, (0.0, end), contacts, p=[before, later, AT], corners=[AT])


@pytest.mark.parametrize("system", ["linear", "general"])
@pytest.mark.parametrize(("h", "tolerance", "theta"), [(0.25, 1e-5, 0.5), (0.01, 1e-3, 1.0), (AT, 1e-4, 0.5)])
def test_a_table_takes_along_what_lies_on_it(system, h, tolerance, theta):
    """One impact, without rebound as event-driven: u in its law is that before the corner."""
    m = simulate(
        on_a_table(0.0, 0.7, 0.5, 0.0, 0.0, 1.0, system), Moreau(h, theta=theta, tolerance=tolerance)
    )
    assert m.status is Status.DONE
    np.testing.assert_allclose(m.q[:, 0], 0.7 * np.maximum(m.t - AT, 0.0), rtol=0, atol=tolerance)
    np.testing.assert_allclose(m.v[m.t > AT + 1e-3, 0], 0.7, rtol=0, atol=tolerance)
    assert m.impulse.sum() == pytest.approx(0.7 + WEIGHT, abs=10.0 * tolerance)
    assert AT in m.t


def rectified(t, q, v, p, out):
    """|sin(pi t / p[0])| / 10."""
    w = np.pi / p[0]
    sign = 1.0 if t < p[0] else -1.0
    out[0, 0] = 0.1 * sign * np.sin(w * t)
    out[0, 1], out[0, 2] = 0.1 * sign * w * np.cos(w * t), -0.1 * sign * w**2 * np.sin(w * t)


@pytest.mark.parametrize("place", [1.0, 1.54])
def test_what_steps_have_left_open_below_a_body_is_not_opened_by_its_blow(place):
    """The gap above a table that bends lies within the tolerance; it is no error of the step from the corner on."""
    contacts = LinearContacts(1.0, 0.0, motion=rectified)
    scene = Scene(
        LinearSystem(1.0, force=-WEIGHT), 0.0, 0.1 * np.pi / place, (0.0, 2.0), contacts, p=[place],
        corners=[place],
    )  # fmt: skip
    m = simulate(scene, Moreau(0.02, tolerance=1e-4))
    assert m.status is Status.DONE
    np.testing.assert_allclose(m.q[:, 0], 0.1 * abs(np.sin(np.pi * m.t / place)), rtol=0, atol=1e-5)


@pytest.mark.parametrize(("before", "later"), [(0.7, 0.0), (0.0, -0.7)])
@pytest.mark.parametrize(("h", "tolerance", "theta"), [(1.0, 1e-4, 0.5), (0.1, 1e-3, 1.0)])
def test_what_lies_on_a_table_that_stops_or_drops_is_left_behind(before, later, h, tolerance, theta):
    """It flies for 2 * 0.7 / 9 s, and meets the table with 0.7 m/s again."""
    end = AT + 0.15
    m = simulate(
        on_a_table(before, later, 0.5, -before * AT, before, end), Moreau(h, theta=theta, tolerance=tolerance)
    )
    assert m.status is Status.DONE
    since = np.maximum(m.t - AT, 0.0)
    flown = before * (m.t - AT) - 0.5 * WEIGHT * since**2
    np.testing.assert_allclose(m.q[:, 0], flown, rtol=0, atol=tolerance)


@pytest.mark.parametrize("late", [1e-7, 1e-5, 1e-2])
def test_bodies_in_flight_meet_the_new_velocity(late):
    """However short after the corner: it comes with 4 m/s and is met with 1 m/s."""
    hit = AT + late
    start = 4.0 - WEIGHT * hit  # v = -4 at that time
    height = late + (4.0 - 0.5 * WEIGHT * hit) * hit
    m = simulate(
        on_a_table(0.0, 1.0, 0.5, height, -start, hit + 0.1), Moreau(0.25, tolerance=1e-4), keep=[hit + 0.1]
    )
    assert m.status is Status.DONE
    assert m.impacts[m.impacts.kind == Kind.IMPACT][0].before == pytest.approx(-5.0, abs=1e-3)
    assert m.v[-1, 0] == pytest.approx(1.0 + 2.5 - 0.1 * WEIGHT, abs=1e-3)


def pulled(t, q, v, p, out):
    out[0], out[1] = (0.0, 3.0) if t % 1.0 < 0.3171 else (5.0, -20.0)


def test_forces_that_jump_are_met_at_their_corners():
    """Steps up to them are of sizes of their own, with matrices of their own."""
    M, K, C = (
        np.diag([1.0, 2.0]),
        np.array([[300.0, -100.0], [-100.0, 200.0]]),
        np.array([[2.0, -1.0], [-1.0, 3.0]]),
    )
    scene = Scene(
        LinearSystem(M, C, K, pulled), [0.1, 0.0], [0.0, 1.0], (0.0, 2.0), corners=[0.0, AT], period=1.0
    )
    m = simulate(scene, Moreau(0.25, tolerance=1e-5))
    assert m.status is Status.DONE
    assert np.isin([AT, 1.0, 1.0 + AT], m.t).all()
    state = np.array([0.1, 0.0, 0.0, 1.0])
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    for length, force in ((AT, [0.0, 3.0]), (1.0 - AT, [5.0, -20.0])) * 2:
        rest = np.append(np.linalg.solve(K, force), [0.0, 0.0])
        state = rest + expm(A * length) @ (state - rest)
    np.testing.assert_allclose(m.q[-1], state[:2], rtol=0, atol=2e-5)
    np.testing.assert_allclose(m.v[-1], state[2:], rtol=0, atol=2e-4)
