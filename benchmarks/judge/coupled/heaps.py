"""Random heaps of discs with friction that fall together between two walls, of up to 52 contacts."""

import numpy as np

from lagrangian import Contacts, Coulomb, LinearSystem, Scene

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
