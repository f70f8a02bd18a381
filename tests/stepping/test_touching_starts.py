"""Bodies that touch at the start, in whole numbers: all orders, and `EventDriven`, take the same blows."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, simulate

METHODS = (
    EventDriven(),
    Located(0.01),
    Located(0.01, 4),
    Located(0.01, "exact"),
    Located(0.01, tolerance=1e-6),
)


def row(mass, q0, v0, *, floor=False, ceiling=None):
    """Elastic beads on a line, each the neighbour of the next, perhaps between two walls."""
    n = len(mass)
    G, offset = list(np.diff(np.eye(n), axis=0)), [0.0] * (n - 1)
    if floor:
        G, offset = [*G, np.eye(n)[0]], [*offset, 0.0]
    if ceiling is not None:
        G, offset = [*G, -np.eye(n)[-1]], [*offset, ceiling]
    contacts = LinearContacts(G=np.array(G), offset=offset, restitution=1.0)
    return Scene(LinearSystem(M=np.diag(mass)), q0, v0, (0.0, 1.0), contacts)


@pytest.mark.parametrize("method", METHODS)
def test_two_beads_that_a_blow_leaves_together_share_the_next(method):
    """The floor sends the first after the second, as fast; the third meets both: 2 p0 = p1, 2 p1 - p0 = 2 x 3."""
    run = simulate(row([1.0, 1.0, 1.0], [0.0, 0.0, 2.0], [-1.0, 1.0, 2.0], floor=True, ceiling=2.0), method)
    np.testing.assert_allclose(run.at(0.8)[1], [-1.0, -1.0, 2.0], rtol=0, atol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_pairs_that_collide_at_once_do_so_before_what_touches_them(method):
    """The outer pairs approach, the inner one parts, till both have collided; then it does, and they again."""
    mass, v = np.array([3.0, 1.0, 1.0, 2.0]), np.array([2.0, -1.0, 0.0, -2.0])
    run = simulate(row(mass, [2.0, 2.0, 2.0, 2.0], v), method)
    for pairs in ((0, 2), (1,), (0, 2), (1,), (0,)):
        for k in pairs:
            p = 2.0 * (v[k] - v[k + 1]) / (1.0 / mass[k] + 1.0 / mass[k + 1])
            v[k], v[k + 1] = v[k] - p / mass[k], v[k + 1] + p / mass[k + 1]
    assert np.all(np.diff(v) > 0.0)
    np.testing.assert_allclose(run.v[-1], v, rtol=0, atol=1e-9)
