"""A table that goes up and down at one speed turns to the last digit where its function says, and not near it.

A ball that goes along with it, and does not rebound, is thrown off wherever the table begins to go down.
"""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, simulate

TURN, HEIGHT, G, END = 0.23, 0.02, 9.81, 3.0
SPEED = 4.0 * HEIGHT / TURN
TIMES = 1.25 * TURN + TURN * np.arange(12)  # at which the ball is thrown off


def table(t, q, v, p, out):
    x = ((t + p[0] * TURN + p[1]) / TURN) % 1.0
    if x < 0.25:
        out[0, 0], out[0, 1] = 4.0 * HEIGHT * x, SPEED
    elif x < 0.75:
        out[0, 0], out[0, 1] = HEIGHT * (2.0 - 4.0 * x), -SPEED
    else:
        out[0, 0], out[0, 1] = HEIGHT * (4.0 * x - 4.0), SPEED
    out[0, 2] = 0.0


def off(method, corners):
    """How far the ball is from its parabolas, half a flight after each of their starts."""
    contacts = LinearContacts(1.0, restitution=0.0, motion=table)
    scene = Scene(
        LinearSystem(1.0, force=-G), 0.0, SPEED, (0.0, END), contacts, p=[0.0, 0.0], corners=corners
    )
    run = simulate(scene, method)
    tau = 0.05
    return float(np.max(np.abs(run.at(TIMES + tau)[0][:, 0] - (HEIGHT + SPEED * tau - 0.5 * G * tau**2))))


@pytest.mark.parametrize("method", [EventDriven(), Located(3e-3), Located(3e-2, tolerance=1e-6)], ids=str)
def test_turns_that_no_corner_names_are_found_to_the_last_digit(method):
    assert off(method, ()) < 1e-12


@pytest.mark.parametrize("error", [-1e-13, -1e-14, 1e-14, 1e-13])
@pytest.mark.parametrize(
    "method",
    [EventDriven(), Located(3e-3), Located(3e-2, order=4, tolerance=1e-6), Moreau(3e-2, tolerance=1e-5)],
    ids=str,
)
def test_corners_that_are_off_by_the_rounding_of_a_sum_count_as_the_turns(method, error):
    corners = (np.arange(int(2.0 * END / TURN)) + 0.5) * 0.5 * TURN
    assert off(method, corners + error) < (1e-5 if isinstance(method, Moreau) else 1e-12)


@pytest.mark.parametrize("error", [-3e-12, 3e-12])
def test_so_they_do_late_where_times_have_fewer_digits(error):
    start = 4000.0 * TURN
    contacts = LinearContacts(1.0, motion=table)
    times = start + (np.arange(int(2.0 * END / TURN)) + 0.5) * 0.5 * TURN
    scene = Scene(
        LinearSystem(1.0, force=-G),
        0.0,
        SPEED,
        (start, start + END),
        contacts,
        p=[0.0, 0.0],
        corners=times + error,
    )
    run = simulate(scene, Located(3e-2, order=4, tolerance=1e-9))
    q = run.at(start + TIMES + 0.05)[0][:, 0]
    assert np.max(np.abs(q - (HEIGHT + SPEED * 0.05 - 0.5 * G * 0.05**2))) < 1e-11
