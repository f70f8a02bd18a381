"""Bodies on rough floors and along rough walls, and what is asked of their runs."""

import math

import numpy as np

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene

G0 = 9.81


def times(run, kind, contact=0):
    """When this happened at a contact."""
    chosen = (run.impacts.kind == kind) & (run.impacts.contact == contact)
    return run.impacts.time[chosen]


def shaken_tangent(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, 0.0


def shaken_slip(t, q, v, p, out):
    out[0] = -0.4 * math.cos(20.0 * t)


def block(seed):
    """A disc or a block with two feet, a floor and a wall, with springs, belts and restitution drawn."""
    rng = np.random.default_rng(seed)
    disc = rng.random() < 0.5
    if disc:
        M, rows, tangents = np.diag([1.0, 1.0, 0.045]), [[0, 1, 0], [-1, 0, 0]], [[1, 0, 0.3], [0, 1, 0.3]]
        offset = [0.2, 0.6]
    else:
        height = rng.uniform(0.05, 0.5)
        M, rows, tangents = np.diag([1.0, 1.0, 0.1]), [[0, 1, 0.3], [0, 1, -0.3]], [[1, 0, height]] * 2
        offset = [0.0, 0.0]
    v0 = rng.normal(size=3) * [1.5, 1.0, 2.0]
    v0[1] = abs(v0[1])
    v0[2] *= 1.0 if disc else 0.05
    return Scene(
        system=LinearSystem(M, K=np.diag([rng.uniform(0, 30), 0.0, 0.0]), force=[0.0, -G0, 0.0]),
        contacts=LinearContacts(
            rows, offset=offset, restitution=rng.choice([0.0, 0.3, 0.6]),
            friction=Coulomb(rng.uniform(0.0, 1.2, 2), tangents),
        ),
        q0=[0.0, 0.0, 0.0], v0=v0, t_span=(0.0, 1.0),
    )  # fmt: skip


def energy(scene, q, v):
    s = scene.system
    return 0.5 * np.sum(v @ s.M * v, axis=1) + 0.5 * np.sum(q @ s.K * q, axis=1) + G0 * q[:, 1]


def rod(t, q, v, p, out):
    out[0] = q[0] ** 2 + q[1] ** 2 - 1.0


def rod_row(t, q, v, p, out):
    out[0, 0], out[0, 1] = 2.0 * q[0], 2.0 * q[1]


def weight(t, q, v, p, out):
    out[0], out[1] = 0.0, -G0
