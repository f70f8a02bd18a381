"""Impacts to and fro at one instant, by the loop that has friction and joints: their sums are geometric series."""

from __future__ import annotations

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Located, Status, recording, simulate

RODS = [EventDriven(), Located(0.01, 4), Located(0.01, tolerance=1e-4), Located(0.01, 4, tolerance=1e-6)]


def series(m, v0, r):
    """Impulses of the wall struck first and of the other: |v| (1 + r_1) and r_1 |v| (1 + r_2), over 1 - r_1 r_2."""
    ratio = r[0] * r[1]
    return m * abs(v0) * np.array([1.0 + r[0], r[0] * (1.0 + r[1])]) / (1.0 - ratio)


@pytest.mark.parametrize("r", [(0.3, 0.3), (0.99, 0.99), (0.999, 0.9999), (0.2, 1.0)])
@pytest.mark.parametrize("method", RODS, ids=repr)
def test_two_bodies_on_a_rod_in_a_slit_give_their_momentum_to_its_walls(method, r):
    """Bodies of 2 and 3 kg at one distance, the first one in a slit without clearance."""
    scene = Scene(
        LinearSystem(M=np.diag([2.0, 3.0])), [0.0, 1.0], [-0.7, -0.7], (0.0, 0.1),
        LinearContacts(G=[[1.0, 0.0], [-1.0, 0.0]], restitution=r), LinearJoints([[-1.0, 1.0]], [-1.0]),
    )  # fmt: skip
    m = simulate(scene, method)
    assert m.status is Status.DONE, m.message
    np.testing.assert_allclose(m.impulse.sum(axis=0), series(5.0, 0.7, r), rtol=1e-8)
    np.testing.assert_allclose(m.v[-1], 0.0, rtol=0, atol=1e-9)
    # what is told of the law of impact is true: every impact leaves with r times its speed
    struck = m.impacts[(m.impacts.kind == Kind.IMPACT) & (m.impacts.before < 0.0)]
    np.testing.assert_allclose(struck.after, -np.array(r)[struck.contact] * struck.before, rtol=1e-9)


@pytest.mark.parametrize("method", [EventDriven(), Located(0.01, 4)], ids=repr)
@pytest.mark.parametrize("slip", [1.0, 0.1])
def test_a_body_that_slides_along_a_slit_loses_what_friction_takes_of_its_blows(method, slip):
    """All the blows together, 1.99 N s, have friction of 0.199 N s: it slides on, or comes to rest."""
    r, mu, v0 = 0.99, 0.1, 0.01
    friction = Coulomb(mu, [[0.0, 1.0], [0.0, 1.0]], restitution=0.0)
    scene = Scene(
        LinearSystem(M=np.eye(2)), [0.0, 0.0], [-v0, slip], (0.0, 0.1),
        LinearContacts(G=[[1.0, 0.0], [-1.0, 0.0]], restitution=r, friction=friction),
    )  # fmt: skip
    m = simulate(scene, method)
    assert m.status is Status.DONE, m.message
    blows = series(1.0, v0, (r, r))
    np.testing.assert_allclose(m.impulse.sum(axis=0), blows, rtol=1e-8)
    np.testing.assert_allclose(m.v[-1], [0.0, max(0.0, slip - mu * blows.sum())], rtol=0, atol=1e-9)


@pytest.mark.parametrize("room", [4096, 40])
def test_impacts_at_one_instant_go_on_where_the_log_has_been_emptied(room, monkeypatch):
    """A bead of 1 kg between a wall and a body of 100 kg in a slit without clearance: hundreds of impacts, then rest.

    They began anew with the room for the log, and so found no end: what had struck, and how often, was forgotten.
    """
    monkeypatch.setattr(recording, "EVENT_CAPACITY", room)
    scene = Scene(
        LinearSystem(M=np.diag([1.0, 100.0])), [0.0, 0.0], [0.1, -1.0], (0.0, 0.1),
        LinearContacts(G=[[1.0, 0.0], [-1.0, 1.0], [0.0, -1.0]], restitution=[1.0, 0.9, 1.0]),
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    assert m.status is Status.DONE, m.message
    np.testing.assert_allclose(m.v[-1], 0.0, rtol=0, atol=1e-9)
    p = m.impulse.sum(axis=0)  # the bead's momentum is gone, and the body's
    np.testing.assert_allclose([p[0] - p[1], p[1] - p[2]], [-0.1, 100.0], rtol=1e-9)
