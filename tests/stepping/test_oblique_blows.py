"""A pendulum whose bob strikes a rough floor, by Moreau's law: friction bears a part of the blow, and no more.

One coordinate rebounds as one whole, on normal and tangent, whatever the coefficient, and so as without friction.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, Joints, LinearContacts, LinearSystem, Scene, System
from lcpstep import Kind, Moreau, simulate

FLOOR = 0.97  # below the pivot of a pendulum of 1 m, which it meets at cos(angle) = 0.97: tan is 0.25 there


def mass(t, q, v, p, out):
    out[0, 0] = 1.0


def weight(t, q, v, p, out):
    out[0] = -9.81 * math.sin(q[0])


def height(t, q, v, p, out):
    out[0] = FLOOR - math.cos(q[0])


def upwards(t, q, v, p, out):
    out[0, 0] = math.sin(q[0])


def along(t, q, v, p, out):
    out[0, 0] = math.cos(q[0])


def rod(t, q, v, p, out):
    out[0] = math.hypot(q[0], q[1]) - 1.0


def direction(t, q, v, p, out):
    size = math.hypot(q[0], q[1])
    out[0, 0], out[0, 1] = q[0] / size, q[1] / size


by_angle = Scene(
    System(1, mass, weight),
    contacts=Contacts(1, height, upwards, restitution=0.5, friction=Coulomb(0.0, along)),
    q0=0.4, v0=2.0, t_span=(0.0, 1.7),
)  # fmt: skip
on_a_rod = Scene(
    LinearSystem(M=np.eye(2), force=[0.0, -9.81]),
    joints=Joints(1, rod, direction),
    contacts=LinearContacts([[0.0, 1.0]], FLOOR, restitution=0.5, friction=Coulomb(0.0, [[1.0, 0.0]])),
    q0=[math.sin(0.4), -math.cos(0.4)], v0=[2.0 * math.cos(0.4), 2.0 * math.sin(0.4)], t_span=(0.0, 1.7),
)  # fmt: skip


@pytest.mark.parametrize("method", [Moreau(1e-3), Moreau(1e-2, tolerance=1e-4)], ids=["fixed", "tolerance"])
@pytest.mark.parametrize("mu", [0.1, 0.3, 3.0])  # at 0.25 and more what slides there would jam
@pytest.mark.parametrize("scene", [by_angle, on_a_rod], ids=["angle", "rod"])
def test_a_mechanism_of_one_coordinate_rebounds_from_a_rough_floor(scene, mu, method):
    smooth = replace(scene.contacts, friction=None)
    rough = replace(scene.contacts, friction=replace(scene.contacts.friction, mu=mu))
    runs = [simulate(replace(scene, contacts=contacts), method) for contacts in (smooth, rough)]
    times = np.linspace(0.0, 1.7, 200)
    expected, got = (run.at(times)[0] for run in runs)
    blows = runs[1].impacts[runs[1].impacts.kind == Kind.IMPACT]
    assert len(blows) == 2
    assert np.allclose(blows.after, -0.5 * blows.before, rtol=1e-9)
    assert np.max(np.abs(got - expected)) < (1e-9 if method.tolerance is None else 1e-4)
