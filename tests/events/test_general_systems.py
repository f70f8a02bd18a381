"""Systems without a closed form, by DOP853: elliptic functions, curved contacts, and the order of accuracy."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ellipj, ellipk, ellipkinc

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, SimulationError, simulate
from lcpstep.trajectory import Kind
from tests.known import KNOWN, pendulum_angle
from tests.models import RISING_CIRCLE, ball_on_table, bowl_scene, pendulum

TOLERANCE = 1e-12


# --- pendulum and stop: the modulus falls by e at every impact, flights last 2 K(k_j)


@pytest.mark.parametrize("jacobians", [True, False])
@pytest.mark.parametrize("r", [0.7, 1.0])
def test_a_pendulum_strikes_its_stop_at_the_times_of_elliptic_functions(r, jacobians):
    angle, n = 2.0, 10
    k = math.sin(angle / 2) * r ** np.arange(n)
    flights = 2 * ellipk(k**2)
    times = flights[0] / 2 + np.concatenate([[0.0], np.cumsum(flights[1:])])
    m = simulate(pendulum(angle, r, times[-1] + 1.0, jacobians), EventDriven())
    assert np.all(m.impacts.kind == Kind.IMPACT)
    # some thirty steps a swing at 1e-12 each; elastic swings add up their errors of phase
    np.testing.assert_allclose(m.impacts.time, times, rtol=0, atol=1e-10)
    np.testing.assert_allclose(m.impacts.before, -2 * k, rtol=0, atol=1e-10)


def test_an_elastic_pendulum_is_known_between_its_steps_too():
    m = simulate(pendulum(2.0, 1.0, 20.0), EventDriven())
    t = np.linspace(0.0, 20.0, 1001)
    np.testing.assert_allclose(m.at(t)[0][:, 0], np.abs(pendulum_angle(2.0)(t)), rtol=0, atol=1e-10)


@pytest.mark.parametrize("known", [k for k in KNOWN if not k.impacts], ids=lambda k: k.name)
def test_smooth_motions_meet_the_tolerance(known):
    for tolerance in (1e-6, 1e-9, 1e-12):
        m = simulate(known.scene, EventDriven(tolerance, tolerance))
        # a local error of this size in each of the steps, motions that do not diverge
        bound = tolerance * max(len(m.t), 50) * 2
        np.testing.assert_allclose(m.q[:, 0], known.q(m.t), rtol=0, atol=bound)
        middles = 0.5 * (m.t[1:] + m.t[:-1])
        # the dense output is of order 7, one less than the steps
        np.testing.assert_allclose(m.at(middles)[0][:, 0], known.q(middles), rtol=0, atol=10 * bound)


# --- bowl


@pytest.mark.parametrize("bias", [True, False], ids=["bias given", "bias differenced"])
def test_a_point_slides_in_the_bowl_like_a_pendulum(bias):
    a = 1.0
    m = simulate(bowl_scene([math.sin(a), -math.cos(a)], [0.0, 0.0], 10.0, bias), EventDriven())
    assert [e.kind for e in m.impacts] == [Kind.STICK]
    angle = np.arctan2(m.q[:, 0], -m.q[:, 1])
    np.testing.assert_allclose(np.hypot(*m.q.T), 1.0, rtol=0, atol=TOLERANCE)
    np.testing.assert_allclose(np.sum(m.q * m.v, axis=1), 0.0, rtol=0, atol=TOLERANCE)
    np.testing.assert_allclose(angle, pendulum_angle(a)(m.t), rtol=0, atol=1e-10)
    t = np.linspace(0.0, 10.0, 501)
    q, _ = m.at(t)
    np.testing.assert_allclose(np.arctan2(q[:, 0], -q[:, 1]), pendulum_angle(a)(t), rtol=0, atol=1e-10)
    # the contact force is the tension of the pendulum, 3 cos(angle) - 2 cos(a)
    tension = np.trapezoid(3 * np.cos(pendulum_angle(a)(t)) - 2 * math.cos(a), t)
    assert m.impulse.sum() == pytest.approx(tension, rel=1e-4)  # the trapezoidal rule at 0.02 s


@pytest.mark.parametrize("bias", [True, False], ids=["bias given", "bias differenced"])
def test_a_plastic_landing_in_the_bowl_is_followed_by_sliding(bias):
    # free fall from (1/2, 0) to the bowl at 30 degrees from the lowest point; only the tangential speed is kept
    landing, theta = math.sqrt(2 * math.sqrt(0.75)), math.pi / 6
    speed = landing * math.sin(theta)
    m = simulate(bowl_scene([0.5, 0.0], [0.0, 0.0], landing + 8.0, bias), EventDriven())
    assert [e.kind for e in m.impacts] == [Kind.IMPACT, Kind.STICK]
    e = m.impacts[0]
    assert e.time == pytest.approx(landing, abs=1e-11)
    assert e.before == pytest.approx(-landing * math.cos(theta), abs=1e-11)
    assert e.impulse == pytest.approx(landing * math.cos(theta), abs=1e-11)
    k2 = speed**2 / 4 + math.sin(theta / 2) ** 2
    u0 = ellipkinc(math.asin(math.sin(theta / 2) / math.sqrt(k2)), k2)
    t = np.linspace(landing, landing + 8.0, 301)
    q, _ = m.at(t)
    expected = 2 * np.arcsin(math.sqrt(k2) * ellipj(u0 - (t - landing), k2)[0])
    np.testing.assert_allclose(np.arctan2(q[:, 0], -q[:, 1]), expected, rtol=0, atol=1e-10)
    np.testing.assert_allclose(np.hypot(*q.T), 1.0, rtol=0, atol=1e-11)
    np.testing.assert_allclose(np.hypot(*m.q[m.t >= landing].T), 1.0, rtol=0, atol=TOLERANCE)


def test_bounces_in_the_bowl_keep_the_energy_if_elastic():
    m = simulate(bowl_scene([0.5, 0.0], [0.0, 0.0], 20.0, restitution=1.0), EventDriven())
    E = 0.5 * np.sum(m.v**2, axis=1) + m.q[:, 1]
    assert len(m.impacts) > 10
    np.testing.assert_allclose(E, 0.0, rtol=0, atol=1e-10)


# --- a point slides off a ball, where cos(angle) = (2 + v0^2)/3


def outside_gap(t, q, v, p, out):
    out[0] = math.hypot(q[0], q[1]) - 1.0


def outside_jacobian(t, q, v, p, out):
    r = math.hypot(q[0], q[1])
    out[0, 0], out[0, 1] = q[0] / r, q[1] / r


def outside_bias(t, q, v, p, out):
    out[0] = (q[0] * v[1] - q[1] * v[0]) ** 2 / math.hypot(q[0], q[1]) ** 3


@pytest.mark.parametrize("bias", [outside_bias, None], ids=["bias given", "bias differenced"])
@pytest.mark.parametrize("v0", [0.1, 0.5, 0.9])
def test_a_point_leaves_the_ball_where_its_weight_no_longer_holds_it(v0, bias):
    contacts = Contacts(1, outside_gap, outside_jacobian, bias=bias)
    system = LinearSystem(M=np.eye(2), force=[0.0, -1.0])
    m = simulate(Scene(system, [0.0, 1.0], [v0, 0.0], (0.0, 5.0), contacts), EventDriven())
    assert [e.kind for e in m.impacts] == [Kind.STICK, Kind.RELEASE]
    q, v = m.at(m.impacts.time[1])
    assert q[1] == pytest.approx((2 + v0**2) / 3, abs=1e-10)
    assert math.hypot(*q) == pytest.approx(1.0, abs=TOLERANCE)
    # flies on a parabola from there
    tau = 5.0 - m.impacts.time[1]
    np.testing.assert_allclose(m.q[-1], q + v * tau + [0.0, -0.5 * tau**2], rtol=0, atol=1e-10)


# --- a moving, curved obstacle


def test_a_missing_bias_is_differenced_without_loss():
    def scene(bias):
        contacts = replace(RISING_CIRCLE, bias=bias, restitution=0.3)
        system = LinearSystem(M=np.diag([1.0, 2.0]), K=np.eye(2), force=[0.0, -8.0])
        return Scene(system, [0.05, 1.2], [0.0, 0.0], (0.0, 3.0), contacts, period=math.pi)

    given, differenced = (simulate(scene(b), EventDriven()) for b in (RISING_CIRCLE.bias, None))
    assert {Kind.IMPACT, Kind.ACCUMULATION, Kind.RELEASE} <= set(given.impacts.kind)
    large = given.impacts.before < -1e-3
    np.testing.assert_allclose(
        differenced.impacts.time[: len(large)][large], given.impacts.time[large], rtol=0, atol=1e-9
    )
    np.testing.assert_allclose(differenced.q[-1], given.q[-1], rtol=0, atol=1e-8)


# --- the same scenes by closed form and by Runge-Kutta


def spring_of_the_follower(t, q, v, p, out):
    out[0] = -1430.8 * q[0]


def minus_weight(t, q, v, p, out):
    out[0] = -9.81


def driven(t, q, v, p, out):
    out[0] = math.cos(2.0 * t)


def sprung_and_driven(t, q, v, p, out):
    out[0] = math.cos(2.0 * t) - 0.1 * v[0] - q[0]


def damping(t, q, v, p, out):
    out[0, 0] = -0.1


CAM = scenes.cam_follower(rpm=358.0, t_end=1.0, coordinates="absolute")
SLOW_CAM = scenes.cam_follower(rpm=150.0, q0=1e-3, v0=0.0, t_end=0.8, coordinates="absolute")
BALL = ball_on_table(0.01, 40.0, 0.3, 0.02, 0.0, 1.0)
OSCILLATOR = scenes.impact_oscillator(t_end=20.0)
PAIRS = [
    pytest.param(CAM, System(1, 1.221, spring_of_the_follower), 1e-8, id="cam-follower"),
    pytest.param(SLOW_CAM, System(1, 1.221, spring_of_the_follower), 1e-9, id="cam-follower, sticking"),
    pytest.param(BALL, System(1, 1.0, minus_weight), 1e-9, id="table"),
    pytest.param(BALL, LinearSystem(M=1.0, force=minus_weight), 1e-9, id="table, linear"),
    pytest.param(OSCILLATOR, System(1, 1.0, sprung_and_driven, None, damping), 1e-9, id="oscillator"),
    pytest.param(OSCILLATOR, LinearSystem(M=1.0, C=0.1, K=1.0, force=driven), 1e-9, id="oscillator, linear"),
]


@pytest.mark.parametrize(("scene", "system", "tolerance"), PAIRS)
def test_runge_kutta_agrees_with_the_closed_form(scene, system, tolerance):
    closed, stepped = (simulate(s, EventDriven()) for s in (scene, replace(scene, system=system)))
    assert closed.counts.force_evaluations == 0 < stepped.counts.force_evaluations
    for kind in (Kind.ACCUMULATION, Kind.RELEASE):
        ours, theirs = (m.impacts.time[m.impacts.kind == kind] for m in (closed, stepped))
        assert len(ours) == len(theirs)
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=tolerance)
    times = np.linspace(*scene.t_span, 301)
    np.testing.assert_allclose(closed.at(times)[0], stepped.at(times)[0], rtol=0, atol=tolerance)


def test_errors_fall_in_proportion_to_the_tolerance():
    # no contact and no period: nothing but the tolerance bounds the steps
    free = replace(OSCILLATOR, contacts=None, period=math.inf, t_span=(0.0, 500.0))
    scene = replace(free, system=LinearSystem(M=1.0, C=0.1, K=1.0, force=driven))
    exact, errors = simulate(free, EventDriven()), []
    tolerances = np.array([1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
    for tolerance in tolerances:
        m = simulate(scene, EventDriven(tolerance, tolerance))
        errors.append(np.max(np.abs(m.q - exact.at(m.t)[0])))
    assert np.all(np.array(errors) < 100 * tolerances)
    # from one to the next a factor of a hundred; the controller keeps to it within ten
    assert 1e7 < errors[0] / errors[-1] < 1e9


def test_tighter_tolerances_take_the_steps_of_order_eight():
    def steps(tolerance):
        free = replace(OSCILLATOR, system=System(1, 1.0, sprung_and_driven), contacts=None, period=math.inf)
        return simulate(replace(free, t_span=(0.0, 2000.0)), EventDriven(tolerance, tolerance)).counts.steps

    # error per step ~ h^8: tolerances 1e-6 and 1e-12 apart by (1e6)^(1/8) = 5.6; not cut short by the scan
    assert steps(1e-12) / steps(1e-6) < 5.6 * 1.3


def test_a_heavy_system_is_divided_by_its_mass():
    made = Scene(System(1, 1.221, spring_of_the_follower), 0.1, 0.0, (0.0, 0.2))
    m = simulate(made, EventDriven())
    np.testing.assert_allclose(m.q[:, 0], 0.1 * np.cos(math.sqrt(1430.8 / 1.221) * m.t), rtol=0, atol=1e-11)


def varying_mass(t, q, v, p, out):
    out[0, 0] = 1.0 + 4.0 * q[0] ** 2


def bead_force(t, q, v, p, out):
    out[0] = -4.0 * q[0] * v[0] ** 2 - 2.0 * 9.81 * q[0]


def test_a_bead_on_a_parabola_keeps_its_energy_between_elastic_impacts():
    system = System(1, varying_mass, bead_force)
    contacts = LinearContacts(G=1.0, offset=0.2, restitution=1.0)
    m = simulate(Scene(system, 1.0, 0.0, (0.0, 8.0), contacts), EventDriven())
    E = 0.5 * (1 + 4 * m.q**2) * m.v**2 + 9.81 * m.q**2
    assert len(m.impacts) > 5
    np.testing.assert_allclose(E / 9.81, 1.0, rtol=0, atol=1e-10)
    # (1 + 4 q^2) (v+ - v-) = p
    np.testing.assert_allclose(m.impacts.impulse, 1.16 * (m.impacts.after - m.impacts.before), rtol=1e-12)


def blows_up(t, q, v, p, out):
    out[0] = 2.0 * q[0] ** 3  # q = 1/(1 - t)


def test_a_motion_that_leaves_the_finite_numbers_is_an_error_with_the_part_before():
    with pytest.raises(SimulationError, match=r"at t = 1") as caught:
        simulate(Scene(System(1, 1.0, blows_up), 1.0, 1.0, (0.0, 2.0)), EventDriven())
    m = caught.value.trajectory
    early = m.t < 0.9
    assert np.count_nonzero(early) > 10
    np.testing.assert_allclose(m.q[early, 0], 1 / (1 - m.t[early]), rtol=1e-9)
