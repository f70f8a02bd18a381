"""Random scenes of points on slopes, between walls and each other, with friction.

`python -m tests.random_slopes A B` looks at those from A to B. One to four points in the plane, which share masses or
do not; slides, sticking by `mu_s`, chattering that others keep going. All end, by independent
methods in one place, be it one of Painleve's paradox.
"""

import sys

import numpy as np

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Status, simulate

CHAOS = 1e-4  # m: as far as thousands of impacts take roundings apart


def along(n, coordinates, values):
    row = np.zeros(n)
    row[coordinates] = values
    return row


def draw(seed):
    rng = np.random.default_rng(seed)
    k = int(rng.integers(1, 5))
    n, G, T, offset = 2 * k, [], [], []
    if rng.random() < 0.7:
        M = np.diag(np.repeat(10.0 ** rng.uniform(-1, 1, k), 2))
    else:
        A = rng.normal(size=(n, n))
        M = A @ A.T + np.eye(n)

    def touch(normal, tangent, gap):
        G.append(normal), T.append(tangent), offset.append(gap)

    for i in range(k):
        x, y, tilt = 2 * i, 2 * i + 1, rng.uniform(-0.5, 0.5)
        slope = [-np.sin(tilt), np.cos(tilt)], [np.cos(tilt), np.sin(tilt)]
        touch(along(n, [x, y], slope[0]), along(n, [x, y], slope[1]), 0.0)
        if rng.random() < 0.4:
            touch(along(n, [x], -1.0), along(n, [y], 1.0), rng.uniform(1.0, 3.0))
    for i in range(k - 1):
        if rng.random() < 0.4:
            pair = [2 * i, 2 * i + 2], [2 * i + 1, 2 * i + 3]
            touch(along(n, pair[0], [-1.0, 1.0]), along(n, pair[1], [-1.0, 1.0]), rng.uniform(0.1, 1.0))
    force, q0 = np.zeros(n), np.zeros(n)
    force[1::2], force[::2] = -9.81 * np.diag(M)[1::2], rng.normal(size=k)
    q0[1::2] = rng.uniform(0.5, 2.0, k)
    v0 = 2.0 * rng.normal(size=n)
    restitution = rng.uniform(0.0, 0.9, len(G)) if rng.random() < 0.7 else 0.0
    mu = rng.uniform(0.0, 0.8, len(G))
    rubbing = Coulomb(mu, np.array(T), mu_s=1.3 * mu if rng.random() < 0.3 else None)
    contacts = LinearContacts(np.array(G), np.array(offset), restitution, friction=rubbing)
    return Scene(LinearSystem(M, force=force), q0, v0, (0.0, float(rng.uniform(0.5, 4.0))), contacts=contacts)


def complaints(seed):
    """What is wrong with the runs of a scene, in words; nothing where its bodies begin inside of a wall."""
    try:
        scene = draw(seed)
    except ValueError:
        return []
    methods = EventDriven(max_events=200_000), EventDriven(1e-11, 1e-11), Located(1e-2, order=4)
    runs = [simulate(scene, method, keep=[scene.t_span[1]]) for method in methods]
    if all(run.status is Status.PAINLEVE_INCONSISTENT for run in runs):
        runs = [simulate(scene, method) for method in methods]  # which have the states that it is found at
    elif any(run.status is not Status.DONE for run in runs):
        return [f"{run.method}: {run.message}" for run in runs if run.status is not Status.DONE]
    off = [np.max(np.abs(run.q[-1] - runs[0].q[-1])) for run in runs[1:]]
    return [f"{run.method}: {d:.1e} m off" for run, d in zip(runs[1:], off, strict=True) if d > CHAOS]


if __name__ == "__main__":
    for seed in range(int(sys.argv[1]), int(sys.argv[2])):
        for words in complaints(seed):
            print(seed, words, flush=True)
