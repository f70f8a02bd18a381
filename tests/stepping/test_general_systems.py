"""Systems given by functions: the same as the linear ones where they are linear, of order two where they are not."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Harmonic, LinearContacts, LinearSystem, Scene, System
from lcpstep import Moreau, Status, simulate
from tests.known import SPREAD, pendulum_angle, without_contact
from tests.models import bowl_scene, no_damping, pendulum
from tests.stepping.test_order import slope

THETAS = [0.0, 0.5, 0.75, 1.0]


# --- a linear system, written as a general one: M = diag(2, 1), C, K, F below


def force(t, q, v, p, out):
    out[0] = 4.0 * math.cos(3.0 * t) - 0.1 * v[0] - 3.0 * q[0] + q[1]
    out[1] = 1.0 + 2.0 * math.sin(3.0 * t) - 0.1 * v[1] + q[0] - 3.0 * q[1]


def force_q(t, q, v, p, out):
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = -3.0, 1.0, 1.0, -3.0


def force_v(t, q, v, p, out):
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = -0.1, 0.0, 0.0, -0.1


def mass(t, q, v, p, out):
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = 2.0, 0.0, 0.0, 1.0


def gap(t, q, v, p, out):
    out[0], out[1] = q[0] + 0.2, 0.2 - q[0] + q[1]


def jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = 1.0, 0.0, -1.0, 1.0


LINEAR = LinearSystem(
    M=np.diag([2.0, 1.0]), C=0.1 * np.eye(2), K=[[3.0, -1.0], [-1.0, 3.0]],
    force=Harmonic(constant=[0.0, 1.0], cosine=[4.0, 0.0], sine=[0.0, 2.0], omega=3.0),
)  # fmt: skip
FLAT = LinearContacts(G=[[1.0, 0.0], [-1.0, 1.0]], offset=0.2, restitution=0.5)
CURVED = Contacts(n_c=2, gap=gap, jacobian=jacobian, restitution=0.5)
GIVEN = System(n_q=2, mass=mass, force=force, force_q=force_q, force_v=force_v)
DIFFERENCED = System(n_q=2, mass=np.diag([2.0, 1.0]), force=force)


def scene(system, contacts):
    return Scene(system=system, contacts=contacts, q0=[0.1, 0.0], v0=[-1.0, 0.5], t_span=(0.0, 2.0))


@pytest.mark.parametrize("theta", THETAS)
@pytest.mark.parametrize(
    ("system", "contacts"),
    [(LINEAR, CURVED), (GIVEN, FLAT), (GIVEN, CURVED), (DIFFERENCED, FLAT), (DIFFERENCED, CURVED)],
    ids=["linear, curved", "given, flat", "given, curved", "differenced, flat", "differenced, curved"],
)
def test_one_system_written_in_several_ways_moves_in_one_way(system, contacts, theta):
    expected = simulate(scene(LINEAR, FLAT), Moreau(1e-3, theta))
    m = simulate(scene(system, contacts), Moreau(1e-3, theta))
    assert len(expected.impacts) >= 3
    np.testing.assert_array_equal(m.impacts.kind, expected.impacts.kind)
    # Newton's iteration ends at 1e-12 of the velocity, 2000 times in a stable motion
    np.testing.assert_allclose(m.q, expected.q, rtol=0, atol=1e-11)
    np.testing.assert_allclose(m.v, expected.v, rtol=0, atol=1e-11)
    np.testing.assert_allclose(m.impulse, expected.impulse, rtol=0, atol=1e-11)


@pytest.mark.parametrize("theta", THETAS)
def test_jacobians_steer_the_iteration_and_do_not_enter_the_motion(theta):
    given, differenced = (
        simulate(pendulum(1.5, 0.5, 10.0, jacobians=j), Moreau(1e-2, theta)) for j in (True, False)
    )
    assert len(given.impacts) >= 2
    np.testing.assert_allclose(given.q, differenced.q, rtol=0, atol=1e-10)
    assert given.counts.force_evaluations < differenced.counts.force_evaluations


def test_a_linear_system_needs_one_iteration_and_a_check():
    m = simulate(scene(GIVEN, FLAT), Moreau(1e-3))
    assert m.counts.force_evaluations <= 3 * m.counts.steps


# --- a bead on the curve y = q^2 under gravity: M = 1 + 4 q^2, f = -4 q v^2 - 2 g q


def bead_mass(t, q, v, p, out):
    out[0, 0] = 1.0 + 4.0 * q[0] ** 2


def bead_force(t, q, v, p, out):
    out[0] = -4.0 * q[0] * v[0] ** 2 - 2.0 * p[0] * q[0]


def bead_force_q(t, q, v, p, out):
    out[0, 0] = -4.0 * v[0] ** 2 - 2.0 * p[0]


def bead_force_v(t, q, v, p, out):
    out[0, 0] = -8.0 * q[0] * v[0]


def bead(t_end, jacobians):
    given = {"force_q": bead_force_q, "force_v": bead_force_v} if jacobians else {}
    return Scene(
        system=System(n_q=1, mass=bead_mass, force=bead_force, **given),
        q0=1.0, v0=0.0, t_span=(0.0, t_end), parameters={"g": 9.81},
    )  # fmt: skip


def bead_energy(m):
    return 0.5 * (1 + 4 * m.q**2) * m.v**2 + 9.81 * m.q**2


@pytest.mark.parametrize("jacobians", [True, False])
@pytest.mark.parametrize(("theta", "order"), [(0.5, 2), (1.0, 1)])
def test_the_energy_of_a_bead_on_a_curve_converges_with_the_order_of_the_method(theta, order, jacobians):
    levels, errors = (100, 200, 400, 800), []
    for n in levels:
        runs = [simulate(bead(1.5, jacobians), Moreau(1.5 / round(n * s), theta)) for s in SPREAD]
        errors.append(np.mean([np.max(np.abs(bead_energy(m) / 9.81 - 1)) for m in runs]))
    assert slope(levels, errors) == pytest.approx(order, abs=0.25)


def test_pendulum_and_stop_converge_with_order_one():
    scene = pendulum(1.5, 1.0, 8.0)
    levels, errors = (200, 400, 800, 1600), []
    for n in levels:
        runs = [simulate(scene, Moreau(8.0 / round(n * s))) for s in SPREAD]
        # an elastic stop folds the free motion over
        exact = [np.abs(pendulum_angle(1.5)(m.t)) for m in runs]
        errors.append(np.mean([np.mean(np.abs(m.q[:, 0] - e)) for m, e in zip(runs, exact, strict=True)]))
    assert slope(levels, errors) == pytest.approx(1.0, abs=0.25)


def test_a_pendulum_at_rest_stays_at_rest():
    m = simulate(without_contact(pendulum(0.0, 0.0, 1.0)), Moreau(1e-2))
    assert np.all(m.q == 0.0)


# --- a point sliding in a bowl after a plastic landing


def test_a_point_slides_in_the_bowl_like_a_pendulum():
    def energy(m):
        return 0.5 * np.sum(m.v**2, axis=1) + m.q[:, 1]

    a = 1.0  # from rest on the rim, at this angle from the lowest point
    scene = bowl_scene([math.sin(a), -math.cos(a)], [0.0, 0.0], 3.0)
    levels, drift, errors = (300, 600, 1200, 2400), [], []
    for n in levels:
        m = simulate(scene, Moreau(3.0 / n))
        drift.append(np.max(np.abs(1.0 - np.hypot(*m.q.T))))
        errors.append(np.mean(np.abs(np.arctan2(m.q[:, 0], -m.q[:, 1]) - pendulum_angle(a)(m.t))))
        assert np.max(energy(m)) < energy(m)[0] + 3.0 / n
    assert slope(levels, errors) >= 0.75
    assert slope(levels, drift) >= 0.75


# --- a curved, moving obstacle


def rising_gap(t, q, v, p, out):
    out[0] = q[1] - 0.1 * math.sin(5.0 * t) + q[0] ** 2


def rising_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = 2.0 * q[0], 1.0


def rising_gap_t(t, q, v, p, out):
    out[0] = -0.5 * math.cos(5.0 * t)


def falling(t, q, v, p, out):
    out[0], out[1] = 0.0, -9.81


@pytest.mark.parametrize("theta", [0.5, 1.0])
def test_impacts_with_a_curved_moving_obstacle_obey_newton_with_order_one(theta):
    contacts = Contacts(1, rising_gap, rising_jacobian, gap_t=rising_gap_t, restitution=0.6)
    system = System(n_q=2, mass=np.eye(2), force=falling, force_q=no_damping, force_v=no_damping)
    scene = Scene(system=system, contacts=contacts, q0=[0.2, 0.5], v0=[0.3, 0.0], t_span=(0.0, 0.6))
    levels, errors = (200, 400, 800, 1600), []
    for n in levels:
        worst = []
        for s in SPREAD:
            m = simulate(scene, Moreau(0.6 / round(n * s), theta))
            k = int(np.searchsorted(m.t, m.impacts.time[0] - 1e-12))
            u = [scene.gap(m.t[i], m.q[i], m.v[i])[1][0] for i in (k - 1, k)]
            worst.append(abs(u[1] + 0.6 * u[0]))
        errors.append(np.mean(worst))
    assert slope(levels, errors) == pytest.approx(1.0, abs=0.25)


def sprung(t, q, v, p, out):
    for i in range(2):
        out[i] = -9.0 * p[0] - 4.0 * q[i] - 0.5 * v[i]


@pytest.mark.parametrize("at", [0.0, 1.0, -2.25])
@pytest.mark.parametrize("unit", [2.0**20, 2.0**30, 2.0**60, 2.0**-30])
def test_moreau_moves_alike_whatever_the_unit_of_length(unit, at):
    """From rest, where forces are large or cancel: differences were of 1e-10 m/s, which showed rounding."""

    def run(unit):
        contacts = LinearContacts(np.eye(2), 4.0 * unit, 0.5)
        scene = Scene(
            System(2, np.eye(2), sprung), [at * unit] * 2, [0.0, 0.0], (0.0, 3.0), contacts=contacts, p=[unit]
        )
        return simulate(scene, Moreau(1.0 / 64.0))

    one, other = run(1.0), run(unit)
    assert other.status == Status.DONE
    np.testing.assert_allclose(other.q, unit * one.q, rtol=0, atol=1e-9 * unit)
