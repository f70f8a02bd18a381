"""Random rods that fall on a rough floor, linked to chains by joints or each for itself."""

import numpy as np

from lagrangian import Contacts, Coulomb, Joints, LinearSystem, Scene

HALF, G = 0.5, 9.81


def gaps(t, q, v, p, out):
    """Of the left and the right end of each rod."""
    for i in range(len(q) // 3):
        out[2 * i] = q[3 * i + 1] - HALF * np.sin(q[3 * i + 2])
        out[2 * i + 1] = q[3 * i + 1] + HALF * np.sin(q[3 * i + 2])


def normals(t, q, v, p, out):
    out[:] = 0.0
    for i in range(len(q) // 3):
        c = HALF * np.cos(q[3 * i + 2])
        out[2 * i, 3 * i + 1], out[2 * i, 3 * i + 2] = 1.0, -c
        out[2 * i + 1, 3 * i + 1], out[2 * i + 1, 3 * i + 2] = 1.0, c


def tangents(t, q, v, p, out):
    out[:] = 0.0
    for i in range(len(q) // 3):
        s = HALF * np.sin(q[3 * i + 2])
        out[2 * i, 3 * i], out[2 * i, 3 * i + 2] = 1.0, s
        out[2 * i + 1, 3 * i], out[2 * i + 1, 3 * i + 2] = 1.0, -s


def links(t, q, v, p, out):
    """The right end of each rod is the left end of the next."""
    for k in range(len(q) // 3 - 1):
        i, j = 3 * k, 3 * k + 3
        out[2 * k] = q[i] + HALF * np.cos(q[i + 2]) - q[j] + HALF * np.cos(q[j + 2])
        out[2 * k + 1] = q[i + 1] + HALF * np.sin(q[i + 2]) - q[j + 1] + HALF * np.sin(q[j + 2])


def link_rows(t, q, v, p, out):
    out[:] = 0.0
    for k in range(len(q) // 3 - 1):
        for r in range(2):
            for i, sign in ((3 * k, 1.0), (3 * k + 3, -1.0)):
                turned = np.cos(q[i + 2]) if r == 1 else -np.sin(q[i + 2])
                out[2 * k + r, i + r], out[2 * k + r, i + 2] = sign, HALF * turned


def rods(seed):
    """Up to four rods of 1 m, of random masses, friction and restitution."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 5))
    linked = n > 1 and rng.random() < 0.8
    mu, r = float(rng.choice([0, 0.1, 0.3, 0.6])), float(rng.choice([0, 0.3, 0.7]))
    m, a = rng.uniform(0.5, 2, n), rng.uniform(-1.2, 1.2, n)
    q, v, x, y = np.zeros(3 * n), np.zeros(3 * n), 0.0, 0.0
    for i in range(n):
        if not linked:
            x, y = x + 2.0, 0.0
        q[3 * i : 3 * i + 3] = x + HALF * np.cos(a[i]), y + HALF * np.sin(a[i]), a[i]
        x, y = x + np.cos(a[i]), y + np.sin(a[i])
    q[1::3] += rng.uniform(0.02, 0.5) - min(q[1::3] - HALF * abs(np.sin(a)))
    if linked:
        v[0::3], v[1::3] = rng.normal(), rng.normal()
    else:
        v = rng.normal(size=3 * n)
    return Scene(
        LinearSystem(
            np.diag(np.column_stack([m, m, m / 12]).ravel()), force=np.outer(m, [0.0, -G, 0.0]).ravel()
        ),
        q0=q,
        v0=v,
        t_span=(0.0, 1.0),
        contacts=Contacts(
            2 * n, gaps, normals, restitution=r, friction=Coulomb(mu, tangents) if mu else None
        ),
        joints=Joints(2 * (n - 1), links, link_rows) if linked else None,
    )
