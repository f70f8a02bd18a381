"""Planar Coulomb friction in the time-stepping, against motions in closed form and what no friction may do."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System, scenes
from lagrangian.friction import Coulomb
from lcpstep import Moreau, simulate
from lcpstep.errors import LcpStepError

SPREAD = (1.0, 1.07, 1.13, 1.21, 1.29, 1.37)
G0 = 9.81


def block(v0, mu, slope=0.0, restitution=0.0, t_end=1.0, tangential=None, height=0.0, slip=None):
    """Block of 1 kg on a slope; coordinates along it, downwards, and normal to it."""
    friction = Coulomb(mu, [[1.0, 0.0]], slip=slip, restitution=tangential)
    return Scene(
        system=LinearSystem(M=np.eye(2), force=[G0 * math.sin(slope), -G0 * math.cos(slope)]),
        contacts=LinearContacts([[0.0, 1.0]], restitution=restitution, friction=friction),
        q0=[0.0, height], v0=v0, t_span=(0.0, t_end), name="block",
    )  # fmt: skip


def mean_error(scene, n):
    """Largest error of the positions at the end, meant over a few neighbouring steps."""
    errors = []
    for s in SPREAD:
        m = simulate(scene, Moreau(scene.t_span[1] / round(n * s)))
        errors.append(np.max(np.abs(m.q[-1] - scene.exact(m.t[-1:])[0][0])))
    return np.mean(errors)


# --- closed forms


@pytest.mark.parametrize(
    ("scene", "order"),
    [
        # Friction acts along, and stops within a step, with errors of h^2 each; a change from slipping to rolling
        # too. A fall in front of it is rounded to the grid.
        (scenes.sliding_block(), 2),
        (scenes.slipping_wheel(), 2),
        (scenes.coulomb_oscillator(), 2),
        (scenes.slope_landing(), 1),
    ],
    ids=lambda x: getattr(x, "name", ""),
)
def test_motions_with_dry_friction_end_where_they_should(scene, order):
    levels = np.array([100, 400, 1600])
    errors = [mean_error(scene, n) for n in levels]
    fitted = -np.polyfit(np.log(levels), np.log(errors), 1)[0]
    assert fitted > order - 0.35
    assert errors[-1] < 5.0 * (scene.t_span[1] / levels[-1]) ** order


@pytest.mark.parametrize(
    "scene",
    [scenes.sliding_block(), scenes.coulomb_oscillator(), scenes.slope_landing()],
    ids=lambda s: s.name,
)
@pytest.mark.parametrize("h", [1.3e-2, 1e-3])
def test_what_stops_is_at_rest_to_the_last_bit(scene, h):
    m = simulate(scene, Moreau(h))
    assert np.all(m.v[-1] == 0.0)
    last = np.flatnonzero(np.any(m.v != 0.0, axis=1))[-1]
    assert last < len(m.t) - 2
    assert np.all(m.q[last + 2 :] == m.q[-1])


@pytest.mark.parametrize("restitution", [0.0, 0.7])
def test_a_block_rests_for_ever_on_a_slope_below_the_angle_of_friction(restitution):
    slope = 0.5
    h, mu = 1e-3, 1.001 * math.tan(slope)
    m = simulate(block([0.0, 0.0], mu, slope, restitution, t_end=100.0), Moreau(h), keep=100)
    assert np.all(m.v == 0.0)
    assert np.all(m.q == 0.0)
    np.testing.assert_allclose(m.friction_impulse[1:], -100 * h * G0 * math.sin(slope), rtol=1e-12)
    np.testing.assert_allclose(m.impulse[1:], 100 * h * G0 * math.cos(slope), rtol=1e-12)


def test_a_block_slides_down_a_slope_above_the_angle_of_friction():
    slope, mu = 0.5, 0.4
    m = simulate(block([0.0, 0.0], mu, slope), Moreau(1e-3))
    a = G0 * (math.sin(slope) - mu * math.cos(slope))
    np.testing.assert_allclose(m.v[:, 0], a * m.t, rtol=0, atol=1e-12)
    np.testing.assert_allclose(m.q[:, 0], 0.5 * a * m.t**2, rtol=0, atol=1e-12)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_belt_takes_a_block_along(side):
    # the belt runs with side * 0.5 m/s, so that the block slides with -side * 0.5 m/s when at rest
    h, mu = 1e-3, 0.2
    m = simulate(block([0.0, 0.0], mu, slip=-0.5 * side), Moreau(h))
    t = 0.5 / (mu * G0)
    np.testing.assert_allclose(m.v[m.t < t - h, 0], side * mu * G0 * m.t[m.t < t - h], rtol=0, atol=1e-12)
    np.testing.assert_allclose(m.v[m.t > t + h, 0], 0.5 * side, rtol=0, atol=1e-15)


@pytest.mark.parametrize(("mu", "sticks"), [(0.49, False), (0.51, True)])
def test_a_plastic_landing_sticks_if_and_only_if_friction_suffices(mu, sticks):
    # weightless, so that nothing but the impact acts: v_N = -2, v_T = 1
    scene = dataclasses.replace(block([1.0, -2.0], mu, height=0.1), system=LinearSystem(M=np.eye(2)))
    m = simulate(scene, Moreau(1e-3))
    assert (m.v[-1, 0] == 0.0) == sticks
    assert m.v[-1, 0] == pytest.approx(0.0 if sticks else 1.0 - 2.0 * mu, abs=1e-15)
    assert m.v[-1, 1] == 0.0
    assert m.friction_impulse.sum() == pytest.approx(-min(1.0, 2.0 * mu), abs=1e-14)


# --- impacts


def kinetic(scene, q, v):
    M = np.zeros((2, 2))
    scene.system.mass(0.0, q, v, scene.p, M)
    return 0.5 * v @ M @ v


@pytest.mark.parametrize(("law", "change"), [("moreau", -0.4376), ("newton", 0.5875)])
def test_kanes_pendulum_loses_or_creates_energy_by_the_law_of_its_tangent(law, change):
    scene = scenes.kane_pendulum(law=law)
    h = 1e-6
    scene = dataclasses.replace(scene, t_span=(0.0, 4 * h), exact=None)
    m = simulate(scene, Moreau(h))
    assert kinetic(scene, m.q[-1], m.v[-1]) / kinetic(scene, m.q[0], m.v[0]) - 1.0 == pytest.approx(
        change, abs=6e-5
    )


@st.composite
def bodies(draw):
    """Force-free bodies that fly into frictional obstacles, one coefficient of restitution for all."""
    n_q, n_c = draw(st.integers(2, 4)), draw(st.integers(1, 4))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    A = rng.normal(size=(n_q, n_q))
    r = draw(st.sampled_from([0.0, 0.3, 0.8, 1.0]))
    G, T = rng.normal(size=(2, n_c, n_q))
    lengths = np.linalg.norm(G, axis=1) * np.linalg.norm(T, axis=1)
    assume(np.all(np.abs(np.sum(G * T, axis=1)) < 0.999 * lengths))  # tangents are none along the normal
    v0 = rng.normal(size=n_q)
    G *= -np.sign(G @ v0)[:, None]
    friction = Coulomb(rng.choice([0.0, 0.2, 1.0, 3.0], size=n_c), T)
    return Scene(
        system=LinearSystem(M=A @ A.T + 0.1 * np.eye(n_q)),
        contacts=LinearContacts(G, offset=0.3 * rng.random(n_c), restitution=r, friction=friction),
        q0=np.zeros(n_q), v0=v0, t_span=(0.0, 1.0), name="bodies",
    )  # fmt: skip


@settings(max_examples=60, deadline=None)
@given(bodies())
def test_friction_with_one_restitution_for_normal_and_tangent_never_creates_energy(scene):
    m = simulate(scene, Moreau(1e-2))
    assert m.status.name == "DONE"
    E = 0.5 * np.einsum("ti,ij,tj->t", m.v, scene.system.M, m.v)
    assert np.all(np.diff(E) <= 1e-12 * E[0])
    mu, p = np.asarray(scene.contacts.friction.mu), m.impulse
    assert np.all(p >= 0.0)
    assert np.all(np.abs(m.friction_impulse) <= mu * p * (1.0 + 1e-12))


def test_contacts_without_friction_among_others_are_frictionless():
    # two blocks on one floor, (x, y) each; the first on ice
    friction = Coulomb([0.0, 0.5], np.eye(4)[[0, 2]])
    scene = Scene(
        system=LinearSystem(M=np.eye(4), force=[0.0, -1.0, 0.0, -1.0]),
        contacts=LinearContacts(np.eye(4)[[1, 3]], friction=friction),
        q0=np.zeros(4), v0=[1.0, 0.0, 0.1, 0.0], t_span=(0.0, 1.0),
    )  # fmt: skip
    m = simulate(scene, Moreau(1e-2))
    assert np.all(m.friction_impulse[:, 0] == 0.0)
    assert m.v[-1, 0] == 1.0
    assert m.v[-1, 2] == 0.0


@pytest.mark.parametrize("n", [2, 5, 12])
def test_a_block_on_many_rough_feet_rests(n):
    # x, height, angle of a block on n feet, pushed below the limit of friction: forces are not unique, motion is
    a = np.linspace(-0.5, 0.5, n)
    normal, tangent = np.tile([0.0, 1.0, 0.0], (n, 1)), np.tile([1.0, 0.0, 0.2], (n, 1))
    normal[:, 2] = a
    scene = Scene(
        system=LinearSystem(M=np.diag([1.0, 1.0, 0.1]), force=[2.0, -G0, 0.0]),
        contacts=LinearContacts(normal, restitution=0.5, friction=Coulomb(0.3, tangent)),
        q0=np.zeros(3), v0=np.zeros(3), t_span=(0.0, 1.0),
    )  # fmt: skip
    h = 1e-3
    m = simulate(scene, Moreau(h))
    assert m.status.name == "DONE"
    assert np.max(np.abs(m.v)) == 0.0
    np.testing.assert_allclose(m.impulse[1:].sum(axis=1), G0 * h, rtol=1e-12)
    np.testing.assert_allclose(m.friction_impulse[1:].sum(axis=1), -2.0 * h, rtol=1e-12)
    np.testing.assert_allclose(
        m.impulse[1:] @ a + 0.2 * m.friction_impulse[1:].sum(axis=1), 0.0, atol=1e-12 * h
    )


# --- a rod that slides on its tip: where Coulomb's law alone has no solution (Painleve)

LENGTH, INERTIA = 1.0, 0.05


def tip_gap(t, q, v, p, out):
    out[0] = q[1] - 0.5 * math.sin(q[2])


def tip_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 0.0, 1.0, -0.5 * math.cos(q[2])


def tip_tangent(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 1.0, 0.0, 0.5 * math.sin(q[2])


def rod_force(t, q, v, p, out):
    out[0], out[1], out[2] = 0.0, -9.81, 0.0


@pytest.mark.parametrize("angle", [0.3, 0.6, 1.0, 1.3])
def test_a_rod_that_jams_stops_by_an_impact_without_collision(angle):
    # with mu = 2 and this slender rod, sliding backwards is inconsistent when upright: pressed, the tip goes down
    mu, v = 2.0, -3.0
    s, c = 0.5 * math.sin(angle), 0.5 * math.cos(angle)
    paradox = 1.0 + c * (c - mu * s) / INERTIA < 0.0
    scene = Scene(
        system=System(3, np.diag([1.0, 1.0, INERTIA]), rod_force),
        contacts=Contacts(1, tip_gap, tip_jacobian, friction=Coulomb(mu, tip_tangent)),
        q0=[0.0, s, angle], v0=[v, 0.0, 0.0], t_span=(0.0, 0.2), name="rod",
    )  # fmt: skip
    m = simulate(scene, Moreau(1e-4))
    assert m.status.name == "DONE"
    assert np.all(np.isfinite(m.q))
    E = 0.5 * m.v**2 @ [1.0, 1.0, INERTIA] + 9.81 * m.q[:, 1]
    assert np.max(np.diff(E)) < 1e-5  # gaps drift by h^2, which lifts the rod
    assert paradox == (angle > 0.5)
    if paradox:
        tip = m.v[1, 0] + s * m.v[1, 2]
        assert abs(tip) < 1e-2  # stopped within one step
        assert m.impulse[1, 0] > 100 * 9.81 * 1e-4


# --- what is refused, or fails with words


@pytest.mark.parametrize("solver", ["qp", "auto", "newton"])
def test_solvers_that_are_not_compiled_with_the_loop_are_refused(solver):
    with pytest.raises(LcpStepError, match=r"lcp: .* does not treat joints, friction and projected=True"):
        simulate(block([1.0, 0.0], 0.3), Moreau(1e-3, lcp=solver))


def squeeze(t, q, v, p, out):
    """A floor that rises and a ceiling that falls."""
    for i in range(2):
        out[i, 0], out[i, 1], out[i, 2] = t, 1.0, 0.0


def test_contacts_that_nothing_can_satisfy_end_the_run_with_their_names():
    scene = Scene(
        system=LinearSystem(M=np.eye(2)),
        contacts=LinearContacts(
            [[0.0, 1.0], [0.0, -1.0]], offset=[0.0, 0.5], motion=squeeze, friction=Coulomb(0.3, [[1.0, 0.0]] * 2)
        ),
        q0=[0.0, 0.1], v0=[1.0, 0.0], t_span=(0.0, 1.0),
    )  # fmt: skip
    m = simulate(scene, Moreau(1e-2))
    assert m.status.name == "LCP_FAILED"
    assert 0.24 < m.t[-1] < 0.27
    assert "the obstacles of contacts [0, 1] approach each other with nothing left between them" in m.message
    assert np.all(np.isfinite(m.q))
