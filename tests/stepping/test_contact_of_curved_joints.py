"""A contact whose normal is always a curved joint's own changes nothing; one that is nearly so acts as any other.

A bead on an elliptic wire x^2 + k y^2 = 1, a wall x >= wall across its way, and an obstacle along it, whose gap is a
multiple of what is zero on the wire: steps see wire and obstacle at places off both.
"""

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, Joints, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, Status, simulate

STEPS = [Located(1e-2), Moreau(1e-2), Moreau(1e-2, theta=1.0), Moreau(1e-2, projected=True)]
OTHERS = [EventDriven(), Located(1e-2, tolerance=1e-6), Moreau(1e-2, tolerance=1e-3)]


def wire(t, q, v, p, out):
    out[0] = 0.5 * (q[0] * q[0] + p[0] * q[1] * q[1] - 1.0)


def wire_row(t, q, v, p, out):
    out[0, 0], out[0, 1] = q[0], p[0] * q[1]


def along(t, q, v, p, out):
    out[0] = (
        (p[1] + p[2] * q[0]) * 0.5 * (q[0] * q[0] + p[0] * q[1] * q[1] - 1.0) + p[4] * (q[0] - p[3]) + p[5]
    )
    if p[6] > 0.0:
        out[1] = q[0] - p[3]


def along_row(t, q, v, p, out):
    e, w = 0.5 * (q[0] * q[0] + p[0] * q[1] * q[1] - 1.0), p[1] + p[2] * q[0]
    out[0, 0], out[0, 1] = w * q[0] + p[2] * e + p[4], w * p[0] * q[1]
    if p[6] > 0.0:
        out[1, 0], out[1, 1] = 1.0, 0.0


def drawn(seed, resting, slope=0.0, room=0.0, mu=0.0):
    """Obstacle along the wire (slope, room) and wall; and the wall alone. With a slope the obstacle is the wall."""
    rng = np.random.default_rng(seed)
    k, angle = rng.uniform(0.5, 2.0), rng.uniform(0.8, 2.0)
    q0 = np.array([np.cos(angle), np.sin(angle) / np.sqrt(k)])
    way = np.array([-k * q0[1], q0[0]])
    wall = q0[0] - (0.0 if resting else rng.uniform(0.05, 0.3))
    force = np.array([-rng.uniform(1.0, 3.0), rng.normal()])
    masses, multiple = 10.0 ** rng.uniform(-0.5, 0.5, 2), rng.choice([-1.0, 1.0]) * rng.uniform(1.0, 2.0)
    p = [k, multiple, rng.uniform(-0.7, 0.7), wall, slope, room, 1.0 if slope == 0.0 else 0.0]
    n_c, r = 2 if slope == 0.0 else 1, 0.0 if resting else 0.5
    friction = Coulomb(mu, [[0.3, 1.0]] * n_c) if mu > 0.0 else None
    scenes = []
    for contacts in (
        Contacts(n_c, along, along_row, restitution=r, friction=friction),
        LinearContacts([[1.0, 0.0]], [-wall], r, friction=Coulomb(mu, [[0.3, 1.0]]) if mu > 0.0 else None),
    ):
        scenes.append(
            Scene(
                LinearSystem(M=np.diag(masses), force=force),
                q0=q0,
                v0=np.zeros(2) if resting else way / np.linalg.norm(way),
                t_span=(0.0, 0.5),
                contacts=contacts,
                joints=Joints(1, wire, wire_row),
                p=p,
            )
        )
    return scenes


def differ(scenes, method):
    """How far the two motions are apart in the end."""
    a, b = (simulate(scene, method) for scene in scenes)
    assert a.status == b.status == Status.DONE, a.message
    return np.max(np.abs(a.q[-1] - b.q[-1]))


@pytest.mark.parametrize("resting", [True, False])
@pytest.mark.parametrize("method", STEPS + OTHERS, ids=repr)
def test_it_changes_nothing(method, resting):
    for seed in range(10):
        for room in (0.0, 1e-9, 1e-6):
            alike = 1e-8 if getattr(method, "tolerance", None) is None else 1e-6
            assert differ(drawn(seed, resting, room=room), method) < alike, (seed, room)


@pytest.mark.parametrize("resting", [True, False])
@pytest.mark.parametrize("method", STEPS + OTHERS, ids=repr)
def test_nor_with_friction(method, resting):
    for seed in range(10):
        assert differ(drawn(seed, resting, mu=0.3), method) < 1e-8, seed


@pytest.mark.parametrize(
    ("method", "slope"),
    [
        (Located(1e-2), 1e-3),
        (Moreau(2e-3), 1e-2),
        (Moreau(2e-3), 1e-3),
        (Moreau(2e-3, projected=True), 1e-2),
    ],
    ids=repr,
)
def test_one_that_crosses_the_wire_at_a_small_angle_stops_the_bead_as_a_wall_does(method, slope):
    """By steps to half of the way that the bead comes and goes by in one, 9e-3."""
    for seed in range(10):
        for resting in (True, False):
            assert differ(drawn(seed, resting, slope=slope), method) < 5e-3, (seed, resting)
