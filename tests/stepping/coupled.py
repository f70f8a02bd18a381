"""Random scenes of coupled contacts, and what physics demands of their motions whatever the method."""

import math

import numpy as np

from lagrangian import Contacts, Harmonic, LinearContacts, LinearSystem, Scene, System

G = 9.81


def groove(rng, restitution):
    """A particle of 1 kg that falls into a groove of two planes, whose lowest point is the origin."""
    a, b = rng.uniform(0.05, 1.5, 2)
    rows = np.array([[np.sin(a), np.cos(a)], [-np.sin(b), np.cos(b)]])
    x = rng.uniform(-0.5, 0.5)
    height = max(-rows[0, 0] * x / rows[0, 1], -rows[1, 0] * x / rows[1, 1])
    return Scene(
        system=LinearSystem(M=np.eye(2), force=Harmonic(constant=[0.0, -G])),
        contacts=LinearContacts(G=rows, restitution=restitution),
        q0=[x, height + 0.1], v0=0.5 * rng.normal(size=2), t_span=(0.0, 6.0),
    )  # fmt: skip


def slit(rng, restitution):
    """A body between two walls without clearance, pushed to and fro."""
    force = Harmonic(
        constant=[rng.normal()], cosine=[2.0 * rng.normal()], sine=[rng.normal()], omega=rng.uniform(1.0, 5.0)
    )
    return Scene(
        system=LinearSystem(M=[[rng.uniform(0.5, 2.0)]], force=force),
        contacts=LinearContacts(G=[[1.0], [-1.0]], restitution=restitution),
        q0=[0.0], v0=[rng.normal()], t_span=(0.0, 4.0),
    )  # fmt: skip


def three_by_three(rng, restitution):
    """Three coordinates under a constant force, and three contacts that the mass matrix couples."""
    A = rng.normal(size=(3, 3))
    rows, q0 = rng.normal(size=(3, 3)), 0.3 * rng.normal(size=3)
    offset = rng.uniform(0.05, 1.0, 3) - rows @ q0
    return Scene(
        system=LinearSystem(M=A @ A.T + 0.3 * np.eye(3), force=Harmonic(constant=5.0 * rng.normal(size=3))),
        contacts=LinearContacts(G=rows, offset=offset, restitution=restitution),
        q0=q0, v0=rng.normal(size=3), t_span=(0.0, 2.0),
    )  # fmt: skip


def unloaded(rng, restitution, shares=(0.5, 0.5)):
    """At rest or gliding on several contacts, redundant ones among them, some of whose forces begin at zero.

    shares : of the first two rows in the third, where that is a redundant one
    """
    n, m = int(rng.integers(1, 5)), int(rng.integers(1, 6))
    A, B, rows, q0 = (
        rng.normal(size=(n, n)),
        rng.normal(size=(n, n)),
        rng.normal(size=(m, n)),
        rng.normal(size=n),
    )
    if m > 1 and rng.random() < 0.4:
        rows[1] = rng.choice([-1.0, 1.0]) * rows[0]
    if m > 2 and rng.random() < 0.4:
        total = shares[0] * rows[0] + shares[1] * rows[1]
        rows[2] = total if np.any(total) else shares[0] * rows[0]
    K = B @ B.T * rng.choice([0.0, 1.0, 30.0])
    loads = np.where(rng.random(m) < 0.5, 0.0, rng.uniform(0.1, 2.0, m))
    balance, turning = K @ q0 - rows.T @ loads, 2.0 * rng.normal(size=n)
    force = [
        Harmonic(constant=balance, sine=turning, omega=3.0),  # loads change at once
        Harmonic(constant=balance - turning, cosine=turning, omega=3.0),  # their second derivatives do
        Harmonic(constant=balance),
    ][rng.integers(3)]
    tangents = np.linalg.svd(rows)[2][np.linalg.matrix_rank(rows) :]
    v0 = tangents.T @ rng.normal(size=len(tangents)) * rng.choice([0.0, 1.0])
    return Scene(
        system=LinearSystem(M=A @ A.T + 0.3 * np.eye(n), C=0.1 * K, K=K, force=force),
        contacts=LinearContacts(G=rows, offset=-rows @ q0, restitution=restitution),
        q0=q0, v0=v0, t_span=(0.0, 1.5),
    )  # fmt: skip


def weight(t, q, v, p, out):
    out[0], out[1], out[2] = 0.0, -G * p[1], 0.0


def tip_gaps(t, q, v, p, out):
    for k in range(2):
        s = p[0] * (1.0 - 2.0 * k)
        x = q[0] + s * math.cos(q[2])
        out[3 * k], out[3 * k + 1], out[3 * k + 2] = q[1] + s * math.sin(q[2]), x + 1.0, 1.0 - x


def tip_normals(t, q, v, p, out):
    for k in range(2):
        s = p[0] * (1.0 - 2.0 * k)
        for row in range(3):
            out[3 * k + row, 0] = out[3 * k + row, 1] = 0.0
        out[3 * k, 1], out[3 * k, 2] = 1.0, s * math.cos(q[2])
        out[3 * k + 1, 0], out[3 * k + 1, 2] = 1.0, -s * math.sin(q[2])
        out[3 * k + 2, 0], out[3 * k + 2, 2] = -1.0, s * math.sin(q[2])


def dumbbell(rng, restitution):
    """A rod that falls on a floor between two walls, in contact by its tips."""
    half, m = rng.uniform(0.1, 0.3), rng.uniform(0.5, 2.0)
    return Scene(
        System(3, np.diag([m, m, m * half**2 * rng.uniform(0.3, 1.0)]), weight),
        q0=[rng.uniform(-0.2, 0.2), 0.5, rng.uniform(-1.2, 1.2)], v0=rng.normal(size=3) * [0.5, 0.3, 1.0],
        t_span=(0.0, 2.0), contacts=Contacts(6, tip_gaps, tip_normals, restitution=restitution),
        parameters={"half": half, "mass": m},
    )  # fmt: skip


def check_bodies(scene, m, depth=1e-12):
    """The run is whole; contacts push, do not let through and account for the momentum of a constant force."""
    assert m.message == "reached the end of the span"
    assert np.max(m.penetration) <= depth
    assert np.min(m.impulse) >= 0.0
    if (
        isinstance(scene.system, LinearSystem)
        and not np.any(scene.system.K)
        and scene.system.force.omega == 0.0
    ):
        M, rows = np.asarray(scene.system.M), np.asarray(scene.contacts.G)
        pushed = np.asarray(scene.system.force.constant) * scene.t_span[1]
        given = M @ (m.v[-1] - m.v[0]) - rows.T @ np.sum(m.impulse, axis=0)
        np.testing.assert_allclose(given, pushed, rtol=0, atol=1e-10 * (1 + np.sum(m.impulse)))
