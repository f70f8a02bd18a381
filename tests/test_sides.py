"""A gap that is positive on both sides of its obstacle lets everything through: the run says so."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, simulate

METHODS = [
    EventDriven(),
    Located(1e-3),
    Located(1e-3, order=4),
    Located(1e-2, tolerance=1e-6),
    Moreau(1e-3),
    Moreau(1e-2, tolerance=1e-4),
]
IDS = ["event", "order 2", "order 4", "tolerance", "moreau", "moreau by tolerance"]


def unsigned(t, q, v, p, out):
    out[0] = abs(q[0] - q[1])


def unsigned_q(t, q, v, p, out):
    out[0, 0] = 1.0 if q[0] > q[1] else -1.0
    out[0, 1] = -out[0, 0]


def apart(t, q, v, p, out):
    out[0] = math.sqrt((q[0] - q[2]) ** 2 + (q[1] - q[3]) ** 2) - p[0]


def apart_q(t, q, v, p, out):
    x, y = q[0] - q[2], q[1] - q[3]
    d = math.sqrt(x * x + y * y)
    if d > 0.0:  # else there is no gradient, as `out` says untouched
        out[0, 0], out[0, 1], out[0, 2], out[0, 3] = x / d, y / d, -x / d, -y / d


@pytest.mark.parametrize("keep", [1, 10, np.linspace(0.0, 1.0, 78)], ids=["all", "tenth", "times"])
@pytest.mark.parametrize("method", METHODS, ids=IDS)
def test_two_beads_whose_distance_has_no_sign_are_told_to_pass(method, keep):
    """They meet at t = 0.5 and exchange velocities, being elastic; they go on instead."""
    beads = Scene(
        LinearSystem(np.eye(2)),
        [0.0, 1.0],
        [1.0, -1.0],
        (0.0, 1.0),
        Contacts(1, unsigned, unsigned_q, restitution=1.0),
    )
    run = simulate(beads, method, keep=keep)
    assert run.q[-1] == pytest.approx([1.0, 0.0])  # where the other one belongs
    assert run.doubt.startswith("the gap of contact 0 falls to zero at t = 0.")
    assert float(run.doubt.split("t = ")[1].split(" s")[0]) == pytest.approx(0.5, abs=1e-6)


def two_discs(aside, radii, method):
    q0, v0 = [0.0, 0.0, 1.0, aside], [1.0, 0.0, -1.0, 0.0]
    contacts = Contacts(1, apart, apart_q, restitution=1.0)
    return simulate(Scene(LinearSystem(np.eye(4)), q0, v0, (0.0, 1.0), contacts, p=[radii]), method)


@pytest.mark.parametrize("method", METHODS, ids=IDS)
def test_points_that_meet_are_told_and_those_that_miss_or_have_a_size_are_not(method):
    assert "is positive beyond" in two_discs(0.0, 0.0, method).doubt
    assert two_discs(1e-4, 0.0, method).doubt == ""  # far enough to see that they miss each other
    struck = two_discs(0.0, 0.1, method)
    assert struck.doubt == ""
    assert struck.q[-1, 0] == pytest.approx(-0.1, abs=5e-3)  # at 0.45 s, and back


@pytest.mark.parametrize("method", METHODS[:3], ids=IDS[:3])
def test_what_goes_round_in_a_bowl_is_not_told(method):
    """The gradient turns about with it, and the gap is zero all the time."""

    def inside(t, q, v, p, out):
        out[0] = 1.0 - math.sqrt(q[0] ** 2 + q[1] ** 2)

    def inside_q(t, q, v, p, out):
        r = math.sqrt(q[0] ** 2 + q[1] ** 2)
        out[0, 0], out[0, 1] = -q[0] / r, -q[1] / r

    scene = Scene(LinearSystem(np.eye(2)), [1.0, 0.0], [0.0, 20.0], (0.0, 1.0), Contacts(1, inside, inside_q))
    run = simulate(scene, method)
    assert np.linalg.norm(run.q, axis=1) == pytest.approx(1.0, abs=1e-6)
    assert run.doubt == ""


def needle(t, q, v, p, out):
    out[0] = q[1] - p[0] * max(0.0, 1.0 - abs(q[0]) / p[1])


def needle_q(t, q, v, p, out):
    out[0, 0], out[0, 1] = 0.0, 1.0
    if abs(q[0]) < p[1]:
        out[0, 0] = p[0] / p[1] * (1.0 if q[0] > 0.0 else -1.0)


@pytest.mark.parametrize("method", METHODS, ids=IDS)
@pytest.mark.parametrize("height", [1e-6, 1e-8, 1e-10])
def test_a_sharp_tip_that_is_flown_over_at_next_to_no_height_has_an_inside(height, method):
    scene = Scene(
        LinearSystem(np.eye(2)), [-1.123, 0.5], [1.0, 0.1], (0.0, 2.0), Contacts(1, needle, needle_q),
        p=[0.6123 - height, 0.05],
    )  # fmt: skip
    run = simulate(scene, method)
    assert len(run.impacts) == 0
    assert run.q[-1] == pytest.approx([0.877, 0.7])
    assert run.doubt == ""
