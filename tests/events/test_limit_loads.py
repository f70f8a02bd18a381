"""Bodies braced between five to eight rough walls under a load that grows: none holds more than walls can bear.

Forces within the friction cones that balance the load are a linear programme, whose largest load nothing survives.
Source: A. Charnes, H. J. Greenberg, Bulletin of the American Mathematical Society 57 (1951) 480.
"""

import numpy as np
import pytest
from scipy.optimize import linprog

from lagrangian import Coulomb, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Located, Status, simulate
from tests.marks import seeds

LONGEST = 50.0  # s: what holds for so long may hold any load


def pull(t, q, v, p, out):
    for i in range(len(out)):
        out[i] = p[i] + p[len(out) + i] * t


def limit(G, T, J, mu, load, rate):
    """The time up to which forces of walls and joints balance load + rate t, or None."""
    k, n_j = len(mu), len(J)
    balance = np.column_stack([rate, G.T, T.T, J.T])
    cones = np.block(
        [[np.zeros((2 * k, 1)), np.tile(-np.diag(mu), (2, 1)), np.vstack([np.eye(k), -np.eye(k)])]]
    )
    cones = np.column_stack([cones, np.zeros((2 * k, n_j))])
    bounds = [(0, None)] * (1 + k) + [(None, None)] * (k + n_j)
    found = linprog([-1.0, *np.zeros(2 * k + n_j)], cones, np.zeros(2 * k), balance, -load, bounds=bounds)
    return found.x[0] if found.status == 0 else None


def drawn(seed):
    """A scene, and the time at which it has to move; None where it may hold for long."""
    rng = np.random.default_rng(seed)
    k, n = int(rng.integers(5, 9)), int(rng.integers(3, 7))
    n_j = int(rng.integers(0, n - 2))
    J, G, T = rng.normal(size=(n_j, n)), rng.normal(size=(k, n)), rng.normal(size=(k, n))
    pressed, share, mu = rng.random(k), rng.uniform(-0.6, 0.6, k), rng.uniform(0.1, 0.8, k)
    load, rate = -pressed @ G - (share * mu * pressed) @ T, rng.normal(size=n)
    end = limit(G, T, J, mu, load, rate)
    if end is None or end > LONGEST:
        return None
    scene = Scene(
        LinearSystem(np.diag(10.0 ** rng.uniform(-0.5, 0.5, n)), force=pull), np.zeros(n), np.zeros(n),
        (0.0, 1.1 * end + 0.01), LinearContacts(G, offset=0.0, friction=Coulomb(mu, T)),
        joints=LinearJoints(J) if n_j else None, p=[*load, *rate],
    )  # fmt: skip
    return scene, end


@pytest.mark.parametrize("numbers", seeds(300, 60))
@pytest.mark.parametrize("order", [None, 2, 4])
def test_what_no_forces_within_the_cones_hold_moves(order, numbers):
    moved = 0
    for seed in numbers:
        question = drawn(seed)
        if question is None:
            continue
        scene, end = question
        method = EventDriven() if order is None else Located(scene.t_span[1] / 100.0, order=order)
        run = simulate(scene, method, keep=[1.01 * end, scene.t_span[1]])
        assert run.status == Status.DONE, (seed, run.message)
        assert np.max(np.abs(run.v[0])) > 1e-9, seed
        moved += 1
    assert moved > 5
