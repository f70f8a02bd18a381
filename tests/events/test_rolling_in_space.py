"""Spheres that roll in space: two contacts share a normal, one for each direction along the surface; closed forms.

What slides nowhere is held by both, whatever part of the load each has.
"""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, simulate

M0, R, G0 = 1.3, 0.25, 9.81
INERTIA = 0.4 * M0 * R * R
MASS = np.diag([M0, M0, M0, INERTIA, INERTIA, INERTIA])
OMEGA = 3.0
METHODS = [
    (EventDriven(1e-10, 1e-10), 1e-8),
    (Located(1e-2), 2e-4),
    (Located(1e-2, order=4), 1e-8),
    (Located(1e-2, tolerance=1e-6), 1e-5),
    (Moreau(1e-3), 1e-5),
]


def rows(normal, along):
    """Normal and tangent of a sphere's contact, on its velocity and angular velocity."""
    return np.r_[normal, 0.0, 0.0, 0.0], np.r_[along, np.cross(-R * np.asarray(normal), along)]


def of_table(t, q, v, p, out):
    out[:] = 0.0
    out[0, 0], out[0, 4] = 1.0, -R
    out[1, 1], out[1, 3] = 1.0, R


def turning(t, q, v, p, out):
    out[0], out[1] = p[0] * q[1], -p[0] * q[0]


def on_turntable(slope):
    """A ball that rolls on a table which turns by `OMEGA` and leans by `slope`; its places as complex numbers."""
    x, u = np.array([0.5, 0.0]), np.array([0.3, 0.4])
    spin = [(OMEGA * x[0] - u[1]) / R, (u[0] + OMEGA * x[1]) / R, 0.0]
    weight = M0 * G0 * np.array([math.sin(slope), 0.0, -math.cos(slope), 0.0, 0.0, 0.0])
    k, a = 2.0 / 7.0 * OMEGA, 5.0 / 7.0 * G0 * math.sin(slope)
    drift = a / k * 1j
    scene = Scene(
        system=LinearSystem(MASS, force=weight), q0=[*x, 0, 0, 0, 0], v0=[*u, 0, *spin], t_span=(0.0, 6.0), p=[OMEGA],
        contacts=LinearContacts([[0, 0, 1, 0, 0, 0]] * 2, friction=Coulomb(5.0, of_table, slip=turning)),
    )  # fmt: skip
    start = complex(*u) - drift
    return scene, lambda t: complex(*x) + start * (np.exp(1j * k * t) - 1.0) / (1j * k) + drift * t


@pytest.mark.parametrize(("method", "error"), METHODS)
@pytest.mark.parametrize("slope", [0.0, 0.2])
def test_a_ball_on_a_turntable_goes_round_by_two_sevenths_of_it_and_drifts_along_its_slope(
    slope, method, error
):
    scene, place = on_turntable(slope)
    run = simulate(scene, method, keep=np.linspace(0.0, 6.0, 40))
    assert np.max(np.abs(run.q[:, 0] + 1j * run.q[:, 1] - place(run.t))) < error


def test_what_rolls_is_held_where_one_of_its_forces_turns_round_in_tiny_steps():
    scene, place = on_turntable(0.0)
    run = simulate(scene, Moreau(1e-2, tolerance=1e-4), keep=np.linspace(0.0, 6.0, 40))
    assert np.max(np.abs(run.q[:, 0] + 1j * run.q[:, 1] - place(run.t))) < 1e-4


@pytest.mark.parametrize(("method", "error"), METHODS)
@pytest.mark.parametrize("turned", [0.0, 0.7, 0.5 * math.pi, 2.0])
def test_a_ball_rolls_down_a_slope_in_any_direction(turned, method, error):
    slope, down = 0.3, np.array([math.cos(turned), math.sin(turned), 0.0])
    feet = [rows([0, 0, 1], [1, 0, 0]), rows([0, 0, 1], [0, 1, 0])]
    weight = M0 * G0 * np.r_[math.sin(slope) * down[:2], -math.cos(slope), 0.0, 0.0, 0.0]
    contacts = LinearContacts([N for N, _ in feet], friction=Coulomb(1.0, [T for _, T in feet]))
    scene = Scene(LinearSystem(MASS, force=weight), np.zeros(6), np.zeros(6), (0.0, 1.0), contacts)
    run = simulate(scene, method)
    a = 5.0 / 7.0 * G0 * math.sin(slope)
    assert run.q[-1, :3] == pytest.approx(0.5 * a * down, abs=error)


@pytest.mark.parametrize(("method", "error"), METHODS)
def test_a_ball_rolls_along_a_groove(method, error):
    steep, slope, feet = 0.6, 0.3, []
    for side in (-1.0, 1.0):
        n = np.array([0.0, side * math.sin(steep), math.cos(steep)])
        feet += [rows(n, [1, 0, 0]), rows(n, np.cross(n, [1, 0, 0]))]
    weight = M0 * G0 * np.array([math.sin(slope), 0.0, -math.cos(slope), 0.0, 0.0, 0.0])
    contacts = LinearContacts([N for N, _ in feet], friction=Coulomb(2.0, [T for _, T in feet]))
    scene = Scene(LinearSystem(MASS, force=weight), np.zeros(6), np.zeros(6), (0.0, 1.0), contacts)
    run = simulate(scene, method)
    a = G0 * math.sin(slope) / (1.0 + 0.4 / math.cos(steep) ** 2)
    assert run.q[-1, :3] == pytest.approx([0.5 * a, 0.0, 0.0], abs=error)


def cylinder(t_end):
    """A ball that rolls round inside a vertical cylinder, by 8 rad/s, spinning about the radius; its height."""
    r0, round_, spin = 0.75, 8.0, 2.0

    def gap(t, q, v, p, out):
        out[0] = out[1] = r0 - math.hypot(q[0], q[1])

    def jacobian(t, q, v, p, out):
        out[:] = 0.0
        r = math.hypot(q[0], q[1])
        for c in range(2):
            out[c, 0], out[c, 1] = -q[0] / r, -q[1] / r

    def tangent(t, q, v, p, out):
        r = math.hypot(q[0], q[1])
        x, y = q[0] / r, q[1] / r
        out[:] = 0.0
        out[0, 2], out[0, 3], out[0, 4] = 1.0, R * y, -R * x
        out[1, 0], out[1, 1], out[1, 5] = -y, x, R

    scene = Scene(
        system=LinearSystem(MASS, force=[0, 0, -M0 * G0, 0, 0, 0]), q0=[r0, 0, 0, 0, 0, 0], t_span=(0.0, t_end),
        v0=[0, r0 * round_, 0, spin, 0, -r0 * round_ / R],
        contacts=Contacts(2, gap, jacobian, friction=Coulomb(50.0, tangent)),
    )  # fmt: skip
    k, a = math.sqrt(2.0 / 7.0) * round_, -2.0 / 7.0 * R * round_ * spin - 5.0 / 7.0 * G0
    return scene, lambda t: a / k**2 * (1.0 - np.cos(k * t))


@pytest.mark.parametrize(
    ("method", "error"),
    [(EventDriven(1e-10, 1e-10), 1e-8), (Located(5e-3, order=4), 1e-6), (Moreau(1e-5), 1e-3)],
)
def test_a_ball_in_a_cylinder_goes_up_and_down_by_the_root_of_two_sevenths(method, error):
    scene, height = cylinder(1.0)
    run = simulate(scene, method, keep=np.linspace(0.0, 1.0, 40))
    assert np.max(np.abs(run.q[:, 2] - height(run.t))) < error


def test_contacts_that_share_a_normal_stay_closed_both():
    scene, height = cylinder(0.1)
    run = simulate(scene, Moreau(1e-2, tolerance=1e-4))
    assert run.q[-1, 2] == pytest.approx(height(0.1), abs=1e-4)
    assert len(run.t) < 50000
    for steps in (run, simulate(scene, Moreau(1e-3))):
        assert sorted(steps.impacts.contact) == [0, 0, 1, 1]
        spare = 50.0 * steps.impulse[2:] - np.abs(steps.friction_impulse[2:])
        assert spare[:, 0] == pytest.approx(spare[:, 1], rel=1e-6)
