"""Located impacts: orders through impacts, chattering, sticking and release; one contact."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Kind, Located, Moreau, simulate
from tests.known import SPREAD, ball_height
from tests.marks import slow
from tests.models import ball_on_table, bowl_scene, pendulum
from tests.stepping.test_order import slope

ACCUMULATION = math.sqrt(2 / 9.81) * 9.0  # of the ball dropped from 1 m with r = 0.8


def of_kind(m, kind):
    return m.impacts[m.impacts.kind == kind]


# --- scene 10: a double pendulum whose tip strikes a wall


def double_mass(t, q, v, p, out):
    out[0, 0], out[1, 1] = 2.0, 1.0
    out[0, 1] = out[1, 0] = math.cos(q[0] - q[1])


def double_force(t, q, v, p, out):
    s = math.sin(q[0] - q[1])
    out[0] = -s * v[1] * v[1] - 2.0 * 9.81 * math.sin(q[0])
    out[1] = s * v[0] * v[0] - 9.81 * math.sin(q[1])


def tip_gap(t, q, v, p, out):
    out[0] = 0.3 - math.sin(q[0]) - math.sin(q[1])


def tip_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = -math.cos(q[0]), -math.cos(q[1])


def tip_bias(t, q, v, p, out):
    out[0] = math.sin(q[0]) * v[0] * v[0] + math.sin(q[1]) * v[1] * v[1]


def double_pendulum(t_end, bias=tip_bias, restitution=0.7):
    return Scene(
        system=System(n_q=2, mass=double_mass, force=double_force),
        contacts=Contacts(1, tip_gap, tip_jacobian, bias=bias, restitution=restitution),
        q0=[-0.6, -0.9], v0=[0.0, 0.0], t_span=(0.0, t_end), name="double pendulum",
    )  # fmt: skip


def double_energy(m):
    (a, b), (x, y) = m.q.T, m.v.T
    return x * x + 0.5 * y * y + np.cos(a - b) * x * y - 9.81 * (2 * np.cos(a) + np.cos(b))


# --- orders

ORDERS = [
    pytest.param(scenes.impact_oscillator(t_end=20.0), 250, id="impact oscillator"),
    pytest.param(
        scenes.impact_oscillator(omega=0.25, amplitude=2.0, stop=0.5, restitution=0.6, t_end=60.0),
        250, id="chattering, sticking, release",
    ),
    pytest.param(scenes.cam_follower(t_end=0.35), 400, id="cam"),
    pytest.param(scenes.cam_follower(t_end=0.35, coordinates="absolute"), 100, id="moving cam"),
    pytest.param(double_pendulum(3.0), 300, id="double pendulum", marks=pytest.mark.slow),
    pytest.param(pendulum(1.0, 0.5, 10.0), 100, id="pendulum"),
    pytest.param(bowl_scene([0.5, -0.2], [0.0, 0.0], 2.0), 100, id="bowl"),
]  # fmt: skip


@pytest.mark.parametrize(("scene", "coarsest"), ORDERS)
def test_order_two_through_impacts_over_three_decades(scene, coarsest):
    reference, span = simulate(scene, EventDriven()), np.ptp(scene.t_span)
    levels, errors = coarsest * np.array([1, 4, 16, 64, 256, 1024]), []
    at = np.linspace(*scene.t_span, 200)
    q, _ = reference.at(at)
    for n in levels:
        runs = [simulate(scene, Located(span / round(n * s)), keep=at) for s in SPREAD[:3]]
        errors.append(np.mean([np.max(np.abs(m.q - q)) for m in runs]))
    assert slope(levels, errors) >= 1.9
    assert errors[-1] < 1e-6 * errors[0] * 2


def test_release_times_of_a_chattering_ball_on_a_table():
    # released where the table's acceleration is -g, whatever came before
    scene = ball_on_table(0.01, 40.0, 0.3, 0.02, 0.0, 2.0)
    exact = math.asin(9.81 / 16.0)
    levels, errors = (1000, 4000, 16000, 64000), []
    for n in levels:
        m = simulate(scene, Located(2.0 / n))
        phase = of_kind(m, Kind.RELEASE).time * 40.0 % (2 * math.pi)
        errors.append(np.max(np.abs(phase - exact)))
        cycles = 2.0 * 40.0 / (2 * math.pi)
        assert len(phase) >= int(cycles) - 2
        assert len(m.impacts) < 60 * cycles
        assert np.min(m.q[:, 0] - 0.01 * np.sin(40.0 * m.t)) > -1e-12
    assert slope(levels, errors) >= 1.8
    assert errors[-1] < (40.0 * 2.0 / levels[-1]) ** 2


# --- the bouncing ball: exact


@pytest.mark.parametrize("h", [1e-9, 1e-4, 3.7e-3, 0.1, 0.37, 3.0, 50.0])
def test_the_ball_is_exact_at_any_step(h):
    t_end = 5e-5 if h == 1e-9 else 60.0 if h > 1 else 5.0
    start = {"h0": 1e-10} if h == 1e-9 else {}
    m = simulate(scenes.bouncing_ball(t_end=t_end, **start), Located(h))
    exact = ball_height(start.get("h0", 1.0), 9.81, 0.8)
    end = ACCUMULATION * math.sqrt(start.get("h0", 1.0))
    assert m.status.name == "DONE"
    # rounding adds up over many steps
    np.testing.assert_allclose(m.q[:, 0], exact(m.t), rtol=0, atol=1e-13 if len(m.t) < 1e4 else 1e-12)
    assert np.min(m.q) > -1e-15
    late = m.t > end + 1e-12
    assert np.all(m.q[late] == 0.0)
    assert np.all(m.v[late] == 0.0)
    times = of_kind(m, Kind.IMPACT).time
    bounce = np.arange(len(times))
    np.testing.assert_allclose(times, end / 9 * (1 + 8 * (1 - 0.8**bounce)), rtol=1e-13)
    np.testing.assert_allclose(of_kind(m, Kind.ACCUMULATION).time, [end], rtol=1e-12)
    log = of_kind(m, Kind.IMPACT)
    np.testing.assert_allclose(log.after, -0.8 * log.before, rtol=1e-14)
    np.testing.assert_allclose(log.impulse, log.after - log.before, rtol=1e-12)
    # impulses: momentum balance over the whole run
    assert np.sum(m.impulse) == pytest.approx(9.81 * m.t[-1], rel=1e-12)


@pytest.mark.parametrize("h", [0.25, 2.0**-7, 0.25 * (1 + 2.0**-52), 0.25 * (1 - 2.0**-53)])
def test_impacts_on_the_ends_of_steps(h):
    m = simulate(scenes.bouncing_ball(g=2.0, restitution=0.5, t_end=4.0), Located(h))
    times = of_kind(m, Kind.IMPACT).time
    np.testing.assert_allclose(times, 3 - 2.0 ** (1 - np.arange(len(times))), rtol=1e-15)
    q, v = m.at([1.0, 2.0, 3.5])
    np.testing.assert_allclose(q[:, 0], 0.0, rtol=0, atol=1e-15)
    np.testing.assert_allclose(v[:, 0], [1.0, 0.5, 0.0], rtol=0, atol=1e-14)


def test_an_elastic_ball_keeps_energy_and_phase():
    bounces, flight = 20_000, 2 * math.sqrt(2 / 9.81)
    m = simulate(scenes.bouncing_ball(restitution=1.0, t_end=bounces * flight), Located(0.05), keep="impacts")
    log = m.impacts
    assert len(log) == bounces
    assert np.all(log.after == log.after[0])
    assert log.after[0] == pytest.approx(0.5 * flight * 9.81, rel=1e-15)
    assert np.max(np.abs(log.time / flight - np.arange(bounces) - 0.5)) < 2e-11


@pytest.mark.parametrize("order", [2, 4, "exact"])
@pytest.mark.parametrize("h", slow([0.05, 0.0123], longest=[0.0123]))
def test_elastic_balls_are_in_place_after_ten_thousand_bounces(order, h):
    # two of them side by side, so that impacts of many bodies are taken in turn where order is 2
    heights, bounces = np.array([1.0, 0.37]), 10_000
    t_end = 2 * math.sqrt(2 / 9.81) * bounces
    scene = Scene(
        system=LinearSystem(M=np.diag([1.0, 2.0]), force=[-9.81, -2 * 9.81]),
        contacts=LinearContacts(G=np.eye(2), restitution=1.0), q0=heights, v0=[0.0, 0.0], t_span=(0.0, t_end),
    )  # fmt: skip
    m = simulate(scene, Located(h, order), keep=np.linspace(0.999 * t_end, t_end, 50))
    fall = np.sqrt(2 * heights / 9.81)
    late = (m.t[:, None] + fall) % (2 * fall) - fall
    # times are known to 1.8e-12 s there, which is 8e-12 m
    np.testing.assert_allclose(m.q, heights - 0.5 * 9.81 * late**2, rtol=0, atol=1e-10)


@pytest.mark.parametrize("d", [1e-2, 1e-5, 1e-8, 1e-12])
def test_grazing_is_found_within_a_step(d):
    # gap t^2/2 - d about t = 0.55: touching speed sqrt(2 d)
    scene = Scene(
        system=LinearSystem(M=1.0, force=1.0), contacts=LinearContacts(G=1.0, restitution=0.5),
        q0=0.55**2 / 2 - d, v0=-0.55, t_span=(0.0, 1.0),
    )  # fmt: skip
    log = simulate(scene, Located(0.1)).impacts
    assert len(log) == 1
    assert log.before[0] == pytest.approx(-math.sqrt(2 * d), abs=2 * math.sqrt(4e-17))


# --- energy, penetration, interpolation


def test_contacts_create_no_energy_and_nothing_penetrates():
    scene = double_pendulum(6.0, bias=None)
    m = simulate(scene, Located(1e-3))
    assert len(of_kind(m, Kind.IMPACT)) > 3
    assert min(scene.gap(t, q, v)[0][0] for t, q, v in zip(m.t, m.q, m.v, strict=True)) > -1e-12
    jumps = np.diff(double_energy(m))
    assert np.max(jumps) < 1e-4  # the smooth motion's error, of order two
    assert double_energy(m)[-1] < double_energy(m)[0]


def test_states_between_kept_ones():
    scene = scenes.impact_oscillator(t_end=10.0)
    m, at = simulate(scene, Located(1e-2)), np.linspace(0.0, 10.0, 777)
    asked = simulate(scene, Located(1e-2), keep=at)
    np.testing.assert_allclose(m.at(at)[0], asked.q, rtol=0, atol=1e-13)
    np.testing.assert_allclose(m.at(at)[1], asked.v, rtol=0, atol=1e-10)
    events = simulate(scene, Located(1e-2), keep="impacts")
    assert np.all(np.isin(events.impacts.time, events.t))
    with pytest.raises(ValueError, match="keep=1"):
        events.at(0.5 * (events.t[0] + events.t[1]))


def test_velocities_between_kept_states_arrive_at_these():
    scene = pendulum(1.0, 0.6, 10.0)
    m = simulate(scene, Located(1e-2))
    before = np.nextafter(m.t[1:], 0.0)
    jumps = np.max(np.abs(m.v[1:] - m.at(before)[1]), axis=1)
    struck = np.isin(m.t[1:], m.impacts.time)
    assert np.sum(struck) > 2
    assert np.max(jumps[~struck]) < 1e-12
    assert np.min(jumps[struck]) > 1e-2
    at = np.linspace(0.0, 10.0, 777)
    asked = simulate(scene, Located(1e-2), keep=at)
    smooth = ~np.append(struck, True)[np.searchsorted(m.t, at, side="right") - 1]
    np.testing.assert_allclose(m.at(at)[1][smooth], asked.v[smooth], rtol=0, atol=1e-12)


def test_the_rest_of_a_span_begins_where_the_first_part_was_asked_for():
    scene = pendulum(1.0, 0.6, 1.0)
    whole = simulate(scene, Located(1e-2))
    t = np.nextafter(0.5, 0.0)  # a step ends a rounding later
    q, v = whole.at(t)
    rest = simulate(replace(scene, q0=q, v0=v, t_span=(t, 1.0)), Located(1e-2))
    np.testing.assert_allclose(rest.q[-1], whole.at(1.0)[0], rtol=0, atol=1e-12)


def test_far_fewer_steps_than_moreau_for_the_same_error():
    scene = scenes.impact_oscillator(t_end=20.0)
    q, _ = simulate(scene, EventDriven()).at(20.0)
    located, moreau = (simulate(scene, method) for method in (Located(0.02), Moreau(0.02 / 16)))
    assert abs(located.q[-1, 0] - q[0]) < 0.2 * abs(moreau.q[-1, 0] - q[0])


@pytest.mark.parametrize(("h", "bound"), [(0.0, 1), (-1.0, 1), (math.nan, 1), (1e-3, 0), (1e-3, 1.5)])
def test_bad_parameters_are_named(h, bound):
    with pytest.raises(ValueError, match=r"^(h|max_events): expected"):
        Located(h, max_events=bound)
    with pytest.raises(ValueError, match=r"^(h|max_per_step): expected"):
        Located(h, max_per_step=bound)


@pytest.mark.parametrize("order", [2, 4, "exact"])
@pytest.mark.parametrize("restitution", [1e-300, 1e-12])
def test_a_blow_that_leaves_next_to_nothing_is_an_impact(order, restitution):
    """A ball from 1 m strikes once, with sqrt(2 g), and rests: nothing accumulates."""
    floor = LinearContacts([[1.0]], 0.0, restitution=restitution)
    m = simulate(
        Scene(LinearSystem(1.0, force=-9.81), 1.0, 0.0, (0.0, 1.0), contacts=floor), Located(1e-2, order)
    )
    assert m.impacts.kind.tolist() == [Kind.IMPACT, Kind.STICK]
    np.testing.assert_allclose(m.impacts.time, math.sqrt(2.0 / 9.81), rtol=1e-14 + 4.0 * restitution)
    np.testing.assert_allclose(m.impacts.impulse[0], math.sqrt(2.0 * 9.81), rtol=1e-13 + 4.0 * restitution)
