"""Random heaps of discs with friction that fall together between two walls, of up to 52 contacts.

`python -m tests.random_heaps A B` looks at those from A to B: all end, by all methods in one place, with no more
energy than they had. In some heaps hops meet, and rounding is made large: places differ as if moved by little.
"""

import sys
from dataclasses import replace

import numpy as np

from lagrangian import Contacts, Coulomb, LinearSystem, Scene
from lcpstep import EventDriven, Located, Status, simulate

R, G = 0.5, 9.81


def gap(t, q, v, p, out):
    """Of all pairs, then of each disc to the left wall, the right one at p[0], and the floor."""
    n, k = len(q) // 3, 0
    for i in range(n):
        for j in range(i + 1, n):
            out[k] = np.hypot(q[3 * i] - q[3 * j], q[3 * i + 1] - q[3 * j + 1]) - 2.0 * R
            k += 1
    for i in range(n):
        out[k], out[k + 1], out[k + 2] = q[3 * i] - R, p[0] - R - q[3 * i], q[3 * i + 1] - R
        k += 3


def normals(t, q, v, p, out):
    n, k = len(q) // 3, 0
    out[:] = 0.0
    for i in range(n):
        for j in range(i + 1, n):
            x, y = q[3 * i] - q[3 * j], q[3 * i + 1] - q[3 * j + 1]
            d = np.hypot(x, y)
            out[k, 3 * i], out[k, 3 * i + 1], out[k, 3 * j], out[k, 3 * j + 1] = x / d, y / d, -x / d, -y / d
            k += 1
    for i in range(n):
        out[k, 3 * i], out[k + 1, 3 * i], out[k + 2, 3 * i + 1] = 1.0, -1.0, 1.0
        k += 3


def tangents(t, q, v, p, out):
    """The normals, turned by a right angle, of each disc that they move; and its own turning."""
    normals(t, q, v, p, out)
    for k in range(out.shape[0]):
        for i in range(0, len(q), 3):
            x, y = out[k, i], out[k, i + 1]
            out[k, i], out[k, i + 1] = -y, x
            out[k, i + 2] = -R if x != 0.0 or y != 0.0 else 0.0


def heap(seed):
    """Up to eight discs of random masses, friction and restitution."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 9))
    side = int(np.ceil(np.sqrt(n)))
    width = 1.1 * side + rng.uniform(0.2, 2.0)
    mu, r = float(rng.choice([0.0, 0.1, 0.3, 0.6, 1.0])), float(rng.choice([0.0, 0.2, 0.5, 0.8]))
    off, places = 0.05 * rng.uniform(size=(side * side, 2)), np.mgrid[:side, :side].reshape(2, -1).T[:, ::-1]
    q0 = np.column_stack([1.1 * places + (0.7, 0.6) + off, np.zeros(side * side)])[:n].ravel()
    v0, m = rng.choice([0.3, 2.0]) * rng.normal(size=3 * n), rng.uniform(0.5, 2.0, n)
    system = LinearSystem(
        np.diag(np.column_stack([m, m, 0.5 * m * R * R]).ravel()),
        force=np.column_stack([0.0 * m, -G * m, 0.0 * m]).ravel(),
    )
    n_c = n * (n - 1) // 2 + 3 * n
    contacts = Contacts(n_c, gap, normals, restitution=r, friction=Coulomb(mu, tangents))
    return Scene(system, q0, v0, (0.0, 1.0), contacts, p=[width])


def energy(run):
    """Of motion and height."""
    M, f = run.scene.system.M, np.asarray(run.scene.system.force.constant)
    return 0.5 * np.sum(run.v * (run.v @ M), axis=1) - run.q @ f


METHODS = (
    EventDriven(1e-9, 1e-9),
    Located(5e-4),
    Located(4e-3, order=4),
    Located(1e-2, order=4, tolerance=1e-6),
)
MOVED, FARTHER, NEAR, GAINED = 1e-10, 100.0, 3e-6, 1e-5  # m, times, m, J


def sensitivity(scene, true):
    """How far apart a motion ends that begins elsewhere by next to nothing."""
    rng, apart = np.random.default_rng(0), 0.0
    for _ in range(3):
        moved = replace(scene, q0=scene.q0 + MOVED * rng.normal(size=len(scene.q0)))
        run = simulate(moved, METHODS[0], keep=[1.0])
        apart = max(apart, np.max(np.abs(run.q[-1] - true.q[-1])))
    return apart


def complaints(seed):
    """What is wrong with the runs of a heap, in words."""
    scene = heap(seed)
    runs = [simulate(scene, method) for method in METHODS]
    gains = [f"{run.method}: gains energy" for run in runs if np.max(np.diff(energy(run))) > GAINED]
    return gains + disagreement(scene, runs, NEAR, sensitivity)


def disagreement(scene, runs, near, sensitivity):
    """Which runs have not come to the end, or how far they are from the first there, in words."""
    words = [f"{run.method}: {run.message[:150]}" for run in runs if run.status is not Status.DONE]
    if not words:
        off = [np.max(np.abs(run.q[-1] - runs[0].q[-1])) for run in runs[1:]]
        if max(off) > near and max(off) > FARTHER * sensitivity(scene, runs[0]):
            words.append(f"{off} m off")
    return words


def tell(complaints):
    """Print the complaints of the scenes that the command line asks for."""
    for seed in range(int(sys.argv[1]), int(sys.argv[2])):
        for words in complaints(seed):
            print(seed, words, flush=True)


if __name__ == "__main__":
    tell(complaints)
