"""Contacts whose gaps close at one instant strike together, however they are numbered and in whatever units."""

from itertools import combinations, permutations

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Kind, simulate

ROWS = np.array([[1.0, 0.3], [-0.4, 1.0]])
# A plane that depends on both, and the second once more; each with a restitution of its own
G = np.vstack([ROWS, 0.5 * ROWS[0] + 0.25 * ROWS[1], ROWS[1]])
OFFSET = np.array([0.1, 0.2])
OFFSETS = np.append(OFFSET, [0.5 * 0.1 + 0.25 * 0.2, 0.2])
RESTITUTION = np.array([0.9, 0.2, 0.5, 0.7])


def nothing(t, q, v, p, out):
    """No force, which the library is not told."""
    out[0] = out[1] = 0.0


def corner(order, length=1.0, mass=1.0, force=None):
    """A point that meets all four planes at 0.37 s; lengths and masses in other units."""
    M = mass * np.array([[1.0, 0.2], [0.2, 0.7]])
    q0 = np.linalg.solve(ROWS, np.array([0.37, 0.74]) - OFFSET)
    v0 = np.linalg.solve(ROWS, np.array([-1.0, -2.0]))
    contacts = LinearContacts(G=G[order], offset=length * OFFSETS[order], restitution=RESTITUTION[order])
    system = LinearSystem(M=M, force=force)
    return Scene(system, length * q0, length * v0, (0.0, 0.8), contacts)


def law_of_all(scene):
    """The velocity after 0 <= W p + (1 + r) u-  complementary to  p >= 0 for all planes; all sets are tried."""
    M_inverse, G = np.linalg.inv(scene.system.M), scene.contacts.G
    W, b = G @ M_inverse @ G.T, (1.0 + scene.contacts.restitution) * (G @ scene.v0)
    for k in range(3):
        for pressed in map(list, combinations(range(len(b)), k)):
            p = np.zeros(len(b))
            p[pressed] = np.linalg.lstsq(W[np.ix_(pressed, pressed)], -b[pressed])[0]
            if np.all(p >= 0.0) and np.all(W @ p + b >= -1e-12 * np.abs(b).max()):
                return scene.v0 + M_inverse @ G.T @ p
    raise AssertionError("no solution")


@pytest.mark.parametrize("length", [1.0, 1e3, 0.3048e-3])
@pytest.mark.parametrize("force", [None, nothing], ids=["exact", "integrated"])
def test_planes_that_close_together_strike_together(force, length):
    for order in permutations(range(4)):
        scene = corner(list(order), length, 1e3, force)
        run = simulate(scene, EventDriven(1e-12, 1e-12 * length))
        assert run.status.name == "DONE"
        struck = run.impacts[run.impacts.kind == Kind.IMPACT]
        np.testing.assert_allclose(struck.time, 0.37, rtol=1e-9)
        np.testing.assert_allclose(run.at(0.5)[1], law_of_all(scene), atol=1e-8 * length)
