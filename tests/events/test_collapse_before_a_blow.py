"""Two beads without forces collapse on a wall, and a third falls onto them, as they rest, a little later.

Their impacts accumulate 0.42 s from the start: from there on both lie at the wall, one on the other, and the third
bounces on them as on a floor. All of it has a closed form.
"""

import math

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, simulate

M, G0 = np.diag([0.333, 0.782, 0.963]), 9.45  # kg; N, on the third
WALL, APART, UNDER = 0.0609, 0.115, 0.52  # m: gaps between wall, first, second and third bead
UPON = 0.34  # restitution of the third bead on the second
END = 0.6


def pressing(t, q, v, p, out):
    out[0], out[1], out[2] = 0.0, 0.0, -9.45


def scene(general):
    contacts = LinearContacts(
        [[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0], [1.0, 0.0, 0.0]], [APART, UNDER, WALL], [0.38, UPON, 0.067]
    )
    system = System(3, M, pressing) if general else LinearSystem(M, force=[0.0, 0.0, -G0])
    return Scene(system, np.zeros(3), np.zeros(3), (0.0, END), contacts)


def third_bead(t):
    """Where the third bead is at times after the collapse."""
    (m, n), a = (M[1, 1], M[2, 2]), G0 / M[2, 2]
    now = math.sqrt(2.0 * UNDER / a)
    place, speed = -UNDER, -a * now * (n - UPON * m) / (m + n)
    found, floor = np.full_like(t, np.nan), -WALL - APART - UNDER
    for _ in range(4):
        later = t >= now
        s = t[later] - now
        found[later] = place + s * (speed - 0.5 * a * s)
        fall = (speed + math.sqrt(speed**2 + 2.0 * a * (place - floor))) / a
        now, place, speed = now + fall, floor, UPON * (a * fall - speed)
    return found


@pytest.mark.parametrize("general", [False, True], ids=["linear", "general"])
@pytest.mark.parametrize("tolerance", [1e-5, 1e-6, 1e-8, 1e-10, 1e-12])
def test_beads_that_have_collapsed_lie_together_when_the_next_blow_comes(tolerance, general):
    t = np.linspace(0.4197, END, 200)
    m = simulate(scene(general), EventDriven(tolerance, tolerance), keep=t)
    exact = np.column_stack([np.full_like(t, -WALL), np.full_like(t, -WALL - APART), third_bead(t)])
    assert np.max(np.abs(m.q - exact)) <= 10.0 * tolerance
