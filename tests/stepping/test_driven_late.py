"""What is driven, far from t = 0: what times are rounded by takes no more steps, and no accuracy."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lagrangian import Joints, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, Status, simulate

SIZE, OMEGA, g, SPAN = 0.3, 4.0, 9.81, 0.2


def length(t, q, v, p, out):  # p: amplitude, frequency and start of the pivot's motion
    x = q[0] - p[0] * math.sin(p[1] * (t - p[2]))
    out[0] = 0.5 * (x * x + q[1] * q[1] - 1.0)


def normal(t, q, v, p, out):
    out[0, 0], out[0, 1] = q[0] - p[0] * math.sin(p[1] * (t - p[2])), q[1]


def driven(t, q, v, p, out):
    x = q[0] - p[0] * math.sin(p[1] * (t - p[2]))
    out[0] = -x * p[0] * p[1] * math.cos(p[1] * (t - p[2]))


def run_from(start, method, span=SPAN):
    scene = Scene(
        LinearSystem(M=np.eye(2), force=[0.0, -g]), q0=[0.0, -1.0], v0=[0.0, 0.0], t_span=(start, start + span),
        joints=Joints(1, length, normal, gap_t=driven), p=[SIZE, OMEGA, start],
    )  # fmt: skip
    return simulate(scene, method)


def exact(t):
    """The pendulum on a driven pivot, by its angle."""

    def rates(t, y):
        pivot = -SIZE * OMEGA**2 * math.sin(OMEGA * t)
        return [y[1], -g * math.sin(y[0]) - pivot * math.cos(y[0])]

    start, precise = [0.0, -SIZE * OMEGA], {"method": "DOP853", "rtol": 1e-13, "atol": 1e-14}
    angle = solve_ivp(rates, (0.0, SPAN), start, dense_output=True, **precise).sol(t)[0]
    return np.stack([SIZE * np.sin(OMEGA * t) + np.sin(angle), -np.cos(angle)], axis=1)


@pytest.mark.parametrize("start", [1e3, 1e5, 1e6])
@pytest.mark.parametrize(
    ("method", "tolerance"),
    [
        (Located(h=1e-2, order=4, tolerance=1e-9), 1e-9),
        (Located(h=1e-2, tolerance=1e-6), 1e-6),
        (EventDriven(), 1e-11),
    ],
)
def test_late_pendulums_on_a_driven_pivot_take_as_many_steps_as_early_ones(start, method, tolerance):
    early, late = run_from(0.0, method), run_from(start, method)
    assert late.status == Status.DONE
    assert late.counts.steps <= 2 * early.counts.steps + 10
    allowed = tolerance + 10.0 * np.finfo(float).eps * start
    np.testing.assert_allclose(late.q, exact(late.t - start), rtol=0, atol=allowed)


def shaken(t, q, v, p, out):
    angle = p[1] * (t - p[2])
    out[0, 0], out[0, 1] = p[0] * math.sin(angle), p[0] * p[1] * math.cos(angle)
    out[0, 2] = -p[0] * p[1] ** 2 * math.sin(angle)


def on_a_table(start):
    """It throws the ball off, which bounces, comes to rest, and is thrown off again."""
    amplitude, omega = 1.5 * g / 400.0, 20.0
    return Scene(
        LinearSystem(M=1.0, force=-g), q0=0.0, v0=amplitude * omega, t_span=(start, start + 0.9),
        contacts=LinearContacts(G=1.0, restitution=0.5, motion=shaken), p=[amplitude, omega, start],
        period=2.0 * math.pi / omega,
    )  # fmt: skip


def pulled_by_a_driven_one(start):
    """A mass on a spring whose other end is driven, at a wall."""
    return Scene(
        LinearSystem(M=np.eye(2), K=[[40.0, -40.0], [-40.0, 40.0]]), q0=[0.0, 0.0], v0=[1.5, 0.0],
        t_span=(start, start + 1.0), joints=LinearJoints(G=[[1.0, 0.0]], motion=shaken),
        contacts=LinearContacts(G=[[0.0, -1.0]], offset=0.35, restitution=0.7), p=[0.3, 5.0, start],
    )  # fmt: skip


@pytest.mark.parametrize("start", [1e4, 1e6])
@pytest.mark.parametrize("scene", [on_a_table, pulled_by_a_driven_one])
def test_moreaus_steps_by_a_tolerance_are_as_many_late_as_early(scene, start):
    method = Moreau(h=1e-2, tolerance=1e-4)
    early, late = simulate(scene(0.0), method), simulate(scene(start), method)
    assert late.status == Status.DONE
    assert late.counts.steps <= 1.2 * early.counts.steps
    true = simulate(scene(0.0), EventDriven())
    np.testing.assert_allclose(late.q, true.at(np.minimum(late.t - start, true.t[-1]))[0], rtol=0, atol=2e-5)
