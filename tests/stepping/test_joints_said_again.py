"""Joints said again, in other units or with rows that are rounded, change no motion.

Their gaps are no smaller than the rounding of their terms, which grows as the motion leaves the place of its start.
"""

import numpy as np
import pytest
from scipy.linalg import null_space

from lagrangian import LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, Status, simulate
from tests.marks import seeds


def drawn(seed, units, rounded):
    """A body on joints, and the same with sums of their rows beside them."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 6))
    J = np.round(rng.normal(size=(int(rng.integers(1, n)), n)), 3)
    G = np.round(rng.normal(size=(2, n)), 3)
    k = int(rng.integers(1, 4))
    more = 10.0 ** rng.uniform(-units, units, (k, 1)) * (rng.normal(size=(k, len(J))) @ J)
    more *= 1.0 + rounded * rng.normal(size=more.shape)
    free = null_space(J)
    moving = seed % 2  # what begins at rest leaves a place without any size
    v0, gaps = moving * (free @ rng.normal(size=free.shape[1])), moving * rng.uniform(0.05, 0.5, 2)
    system = LinearSystem(
        M=np.diag(10.0 ** rng.uniform(-0.5, 0.5, n)),
        K=np.diag(rng.uniform(0.0, 30.0, n)),
        force=rng.normal(size=n),
    )
    contacts = LinearContacts(G, offset=gaps, restitution=0.4 * moving)
    return [
        Scene(system, q0=np.zeros(n), v0=v0, t_span=(0.0, 0.5), contacts=contacts, joints=LinearJoints(rows))
        for rows in (J, np.vstack([J, more]))
    ]


@pytest.mark.parametrize("numbers", seeds(60, 20))
@pytest.mark.parametrize(("units", "rounded"), [(3.0, 0.0), (0.0, 1e-14)])
@pytest.mark.parametrize(
    "method",
    [EventDriven(), Located(1e-3), Located(1e-2, order=4), Moreau(1e-3), Moreau(1e-3, projected=True)],
    ids=repr,
)
def test_they_change_no_motion(method, units, rounded, numbers):
    for seed in numbers:
        once, again = (simulate(scene, method) for scene in drawn(seed, units, rounded))
        assert once.status == again.status == Status.DONE, (seed, again.message)
        assert np.max(np.abs(again.q[-1] - once.q[-1])) < 1e-9 * (0.1 + np.max(np.abs(once.q[-1]))), seed
