"""Bodies that come to a table at the very time at which its velocity jumps: u- is before the jump, u+ beyond it.

u+ = max(u, -r u-),   u- = v - w-,   u = v - w+,   m (v+ - v) = p >= 0
"""

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Status, simulate

METHODS = [EventDriven(), EventDriven(1e-8, 1e-8), Located(h=1 / 128), Located(h=1 / 128, order=4)]
MASS = 2.0
# Velocities of the body, and of the table before and beyond: it retreats, advances, turns, stops, flees
MEETINGS = [
    (-4.0, 4.0, -4.0),
    (-6.0, 4.0, -4.0),
    (-6.0, -4.0, 4.0),
    (-1.0, 4.0, -4.0),  # faster than the body would leave it
    (-2.0, 4.0, -4.0),  # more slowly
    (-1.0, 0.0, 3.0),
    (-1.0, 2.0, 0.0),
    (-0.3125, 0.0, -0.25),
]


def scene(v, before, after, restitution, others=0, law=None):
    """The body and its table; other bodies, at rest, make it a scene of several coordinates."""

    def motion(t, q, v, p, out):
        late = t >= 1.0
        out[0, 0] = before + after * (t - 1.0) if late else before * t
        out[0, 1] = after if late else before
        out[0, 2] = 0.0

    n = 1 + others
    friction = None if law is None else Coulomb(0.5, np.eye(n)[[1]], law=law)
    table = LinearContacts(np.eye(n)[[0]], restitution=restitution, motion=motion, friction=friction)
    q0, v0 = np.zeros(n), np.zeros(n)
    q0[0], v0[0] = before - v, v
    return Scene(LinearSystem(MASS * np.eye(n)), q0, v0, (0.0, 1.25), table, corners=(1.0,))


@pytest.mark.parametrize("method", METHODS, ids=str)
@pytest.mark.parametrize("meeting", MEETINGS, ids=str)
@pytest.mark.parametrize(
    ("others", "law"),
    [
        (0, None),
        (1, "stronge"),
        *(pytest.param(1, law, marks=pytest.mark.slow) for law in (None, "moreau", "newton")),
    ],
)
def test_velocities_after_it(meeting, method, others, law):
    v, before, after = meeting
    for r in (0.0, 0.5, 1.0):
        m = simulate(scene(*meeting, r, others, law), method)
        assert m.status is Status.DONE, m.message
        came = v - (after if law == "stronge" else before)  # what is integrated takes place beyond it
        u = max(v - after, -r * min(came, 0.0))
        assert m.v[-1, 0] - after == pytest.approx(u, rel=0, abs=1e-12)
        assert m.q[-1, 0] == pytest.approx(before + 0.25 * (after + u), rel=0, abs=1e-12)
        assert m.impacts.impulse.sum() == pytest.approx(MASS * (after + u - v), rel=0, abs=1e-11)


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_one_on_its_back_takes_part(method):
    """Two bodies that fly as one come to a plastic table: both get its velocity beyond the jump, or go on."""

    def motion(t, q, v, p, out):
        late = t >= 1.0
        out[0, 0] = p[0] + p[1] * (t - 1.0) if late else p[0] * t
        out[0, 1] = p[1] if late else p[0]
        out[0, 2] = out[1, 0] = out[1, 1] = out[1, 2] = 0.0

    contacts = LinearContacts([[1.0, 0.0], [-1.0, 1.0]], restitution=0.0, motion=motion)
    for before, after, ends in [(0.0, 3.0, 3.0), (1.0, -0.5, -0.5), (1.0, -4.0, -2.0)]:
        q0 = before + 2.0
        table = Scene(
            LinearSystem(np.eye(2)),
            [q0, q0],
            [-2.0, -2.0],
            (0.0, 1.25),
            contacts,
            corners=(1.0,),
            p=(before, after),
        )
        m = simulate(table, method)
        assert m.v[-1] == pytest.approx([ends, ends], rel=0, abs=1e-12)
        assert m.q[-1] == pytest.approx(before + 0.25 * ends * np.ones(2), rel=0, abs=1e-12)
