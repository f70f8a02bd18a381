"""Systems with modes that have contacts, against closed forms and the same scene without modes."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import (
    Contacts,
    Guard,
    HybridScene,
    HybridSystem,
    LinearContacts,
    LinearSystem,
    Mode,
    Scene,
    System,
)
from lcpstep import EventDriven, Kind, Status, simulate
from tests.events.switching import (
    FLOOR,
    METHOD,
    ball,
    bilinear_with_wall,
    falls,
    falls_otherwise,
    later,
    two_gravities,
)


def switched_at(t_switch, factor, t_end, r=0.5):
    modes = {"down": Mode(falls, [Guard(later, "up")]), "up": Mode(falls_otherwise)}
    return ball(
        modes, "down", [0.1, 0.0], t_end, [9.81, factor, t_switch], LinearContacts([[1.0]], restitution=r)
    )


def first_positive(a, b, c):
    """The first positive root of a tau^2 / 2 + b tau + c."""
    roots = [tau for tau in np.roots([0.5 * a, b, c]) if abs(tau.imag) < 1e-14 and tau.real > 1e-9]
    return min((float(tau.real) for tau in roots), default=math.inf)


def known_events(gravity, factor, place, r, x, t_end):
    """Switches and impacts of the ball of two gravities, by parabolas: (time, "low" or "high" or "impact")."""
    t, v, high, found = 0.0, 0.0, True, []
    while True:
        a = -gravity if high else -gravity * factor
        to_place, to_floor = first_positive(a, v, x - place), first_positive(a, v, x)
        tau = to_place if high else min(to_place, to_floor)
        if t + tau > t_end:
            return found
        t, x, v = t + tau, x + v * tau + 0.5 * a * tau**2, v + a * tau
        if tau == to_place:
            x, high = place, not high
            found.append((t, "high" if high else "low"))
        else:
            x, v = 0.0, -r * v
            found.append((t, "impact"))


@pytest.mark.parametrize("factor", [2.0, 0.5])
def test_a_ball_whose_gravity_changes_at_a_height(factor):
    run = simulate(two_gravities(6.0, factor), METHOD)
    assert run.status == Status.DONE
    known = known_events(9.81, factor, 0.4, 0.95, 1.0, 6.0)
    switches = [(t, name) for t, name in known if name != "impact"]
    impacts = [t for t, name in known if name == "impact"]
    assert len(switches) >= 9
    assert list(run.switches.target) == [name for _, name in switches]
    np.testing.assert_allclose(run.switches.time, [t for t, _ in switches], rtol=0, atol=1e-11)
    np.testing.assert_allclose(run.impacts.time, impacts, rtol=0, atol=1e-11)
    assert np.all(run.impacts.kind == Kind.IMPACT)
    np.testing.assert_allclose(run.impacts.impulse, -2.0 * 1.95 * run.impacts.before, rtol=1e-13)


def test_chattering_ends_in_its_limit_and_a_switch_releases():
    g, r, t_switch = 9.81, 0.5, 1.0
    run = simulate(switched_at(t_switch, -0.5, 2.0), METHOD)
    assert run.status == Status.DONE
    limit = math.sqrt(2.0 * 0.1 / g) * (1.0 + r) / (1.0 - r)
    log = run.impacts
    assert list(log.kind[-3:]) == [Kind.ACCUMULATION, Kind.STICK, Kind.RELEASE]
    np.testing.assert_allclose(log.time[-3:], [limit, limit, t_switch], rtol=0, atol=1e-9)
    assert log.time[-1] == run.switches.time[0]
    t = np.linspace(t_switch, 2.0, 101)
    exact = np.transpose([0.25 * g * (t - t_switch) ** 2, 0.5 * g * (t - t_switch)])
    np.testing.assert_allclose(run.at(t), exact, rtol=0, atol=1e-11)
    resting = run.at(np.linspace(limit + 1e-3, t_switch - 1e-3, 11))
    assert np.all(np.abs(resting) <= 1e-12)
    # weight times time until then, and what the first fall has brought: all that the floor has given
    assert float(run.impulse.sum()) == pytest.approx(2.0 * g * t_switch, abs=1e-11)


def test_a_switch_to_more_weight_keeps_a_contact_closed_and_its_multiplier_follows():
    run = simulate(replace(switched_at(1.0, 3.0, 2.0), x0=[0.0, 0.0]), METHOD)
    assert list(run.impacts.kind) == [Kind.STICK]
    assert float(run.impulse.sum()) == pytest.approx(2.0 * 9.81 * (1.0 + 3.0), abs=1e-11)
    assert np.all(np.abs(run.x) <= 1e-30)


def lifted(t, x, p, out):
    out[0], out[1] = x[1], -p[0] + p[1] * (t - p[2])


def test_within_a_mode_a_contact_opens_where_its_force_falls_to_zero():
    modes = {"down": Mode(falls, [Guard(later, "lifted")]), "lifted": Mode(lifted)}
    run = simulate(ball(modes, "down", [0.0, 0.0], 4.0, [9.81, 5.0, 0.5]), METHOD)
    opens = 0.5 + 9.81 / 5.0
    assert list(run.impacts.kind) == [Kind.STICK, Kind.RELEASE]
    assert run.impacts.time[1] == pytest.approx(opens, abs=1e-11)
    t = np.linspace(opens, 4.0, 51)
    np.testing.assert_allclose(run.at(t)[:, 0], 5.0 / 6.0 * (t - opens) ** 3, rtol=0, atol=1e-11)


def bilinear_events(t_end, r, wall, w1=1.0, w2=2.0):
    """Times of switches to the left and right, and of impacts, by half waves and arcs."""
    t, v, to_left, to_right, impacts, before = 0.5 * math.pi / w1, w1, [], [], [], []
    while t <= t_end:
        to_left.append(t)
        A = v / w2  # x = -A sin(w2 s)
        if wall < A:
            arc = math.asin(wall / A) / w2
            speed = v * math.cos(w2 * arc)
            impacts.append(t + arc)
            before.append(-speed)
            after = r * speed  # back: x = -wall cos(w2 s) + after/w2 sin(w2 s)
            t += arc + math.atan2(wall * w2, after) / w2
            v = math.hypot(after, wall * w2)
        else:
            t += math.pi / w2
        to_right.append(t)
        t += math.pi / w1
    return [[x for x in times if x <= t_end] for times in (to_left, to_right, impacts)] + [before]


@pytest.mark.parametrize("r", [0.8, 0.3, 1.0])
def test_an_oscillator_of_two_stiffnesses_that_hits_a_wall(r):
    run = simulate(bilinear_with_wall(20.0, r), METHOD)
    assert run.status == Status.DONE
    to_left, to_right, impacts, before = bilinear_events(20.0, r, 0.3)
    np.testing.assert_allclose(run.switches.time[run.switches.target == "left"], to_left, rtol=0, atol=1e-11)
    np.testing.assert_allclose(
        run.switches.time[run.switches.target == "right"], to_right, rtol=0, atol=1e-11
    )
    np.testing.assert_allclose(run.impacts.time, impacts, rtol=0, atol=1e-11)
    np.testing.assert_allclose(run.impacts.before, before[: len(impacts)], rtol=0, atol=1e-11)


def test_errors_follow_the_tolerance():
    to_left, to_right, _, _ = bilinear_events(20.0, 0.8, 0.3)
    known = np.sort(to_left + to_right)
    for tolerance in (1e-5, 1e-7, 1e-9, 1e-11):
        run = simulate(bilinear_with_wall(20.0), EventDriven(tolerance, tolerance))
        error = np.max(np.abs(run.switches.time - known))
        assert error <= 10.0 * tolerance


# --------------------------------------------------------------------------- without a guard: as any scene


def chain(t, x, p, out):
    f1 = math.cos(2.0 * t) - 5.0 * x[0] + 3.0 * (x[1] - x[0]) - 0.1 * x[2]
    f2 = -3.0 * (x[1] - x[0]) - 0.2 * x[3] - 2.0
    out[0], out[1] = x[2], x[3]
    out[2], out[3] = f1 / 1.0, f2 / 2.0


def chain_force(t, q, v, p, out):
    out[0] = math.cos(2.0 * t) - 5.0 * q[0] + 3.0 * (q[1] - q[0]) - 0.1 * v[0]
    out[1] = -3.0 * (q[1] - q[0]) - 0.2 * v[1] - 2.0


def shaken(t, q, v, p, out):
    for c in range(3):
        out[c, 0] = out[c, 1] = out[c, 2] = 0.0
    out[0, 0], out[0, 1], out[0, 2] = (
        0.05 * math.sin(2.0 * t),
        0.1 * math.cos(2.0 * t),
        -0.2 * math.sin(2.0 * t),
    )


def test_with_one_mode_a_scene_is_what_it_is_without_modes():
    contacts = LinearContacts(
        [[1.0, 0.0], [-1.0, 1.0], [0.0, -1.0]], [0.4, 0.2, 0.5], [0.6, 0.3, 0.9], shaken
    )
    mass, x0, span = [[1.0, 0.0], [0.0, 2.0]], [0.1, 0.2, 0.0, 0.3], (0.0, 12.0)
    modes = HybridScene(
        HybridSystem(4, {"only": Mode(chain)}, mass=mass), x0, "only", span, contacts=contacts, period=math.pi
    )
    plain = Scene(System(2, mass, chain_force), x0[:2], x0[2:], span, contacts, period=math.pi)
    one, other = simulate(modes, METHOD), simulate(plain, METHOD)
    assert len(other.impacts) > 20
    for name in ("contact", "kind"):
        np.testing.assert_array_equal(one.impacts[name], other.impacts[name])
    for name in ("time", "before", "impulse"):
        np.testing.assert_allclose(one.impacts[name], other.impacts[name], rtol=0, atol=1e-9)
    t = np.linspace(*span, 301)
    np.testing.assert_allclose(one.at(t), np.hstack(other.at(t)), rtol=0, atol=1e-9)
    np.testing.assert_allclose(one.impulse.sum(axis=0), other.impulse.sum(axis=0), rtol=0, atol=1e-9)


def swings(t, x, p, out):  # a bead in the plane, the mass of which depends on its height
    m = 1.0 + x[1] * x[1]
    out[0], out[1], out[2], out[3] = x[2], x[3], -x[0] / m, -9.81


def bead_force(t, q, v, p, out):
    m = 1.0 + q[1] * q[1]
    out[0], out[1] = -q[0], -9.81 * m


def bead_mass(t, q, v, p, out):
    out[0, 0] = out[1, 1] = 1.0 + q[1] * q[1]
    out[0, 1] = out[1, 0] = 0.0


def bowl(t, q, v, p, out):
    out[0] = 1.0 - q[0] * q[0] - q[1] * q[1]


def bowl_normal(t, q, v, p, out):
    out[0, 0], out[0, 1] = -2.0 * q[0], -2.0 * q[1]


def test_masses_and_gaps_may_be_functions():
    contacts = Contacts(1, bowl, bowl_normal, restitution=0.6)
    modes = HybridScene(
        HybridSystem(4, {"only": Mode(swings)}, mass=bead_mass), [0.3, 0.0, 0.0, 0.0], "only", (0.0, 3.0),
        contacts=contacts,
    )  # fmt: skip
    plain = Scene(System(2, bead_mass, bead_force), [0.3, 0.0], [0.0, 0.0], (0.0, 3.0), contacts)
    one, other = simulate(modes, METHOD), simulate(plain, METHOD)
    np.testing.assert_array_equal(one.impacts.kind, other.impacts.kind)
    np.testing.assert_allclose(one.impacts.time, other.impacts.time, rtol=0, atol=1e-9)
    np.testing.assert_allclose(one.x[-1], np.hstack([other.q[-1], other.v[-1]]), rtol=0, atol=1e-9)


def test_a_mass_without_contacts_changes_nothing():
    modes = {"down": Mode(falls)}
    scene = ball(modes, "down", [1.0, 0.3], 1.0, [9.81], contacts=None)
    run = simulate(scene, METHOD)
    assert run.at(1.0)[0] == pytest.approx(1.3 - 0.5 * 9.81, abs=1e-12)
    assert run.impacts is None


def test_masses_of_linear_systems_do_not_matter_to_free_flight():
    plain = Scene(LinearSystem([[2.0]], force=[-19.62]), [1.0], [0.0], (0.0, 1.8), FLOOR)
    run = simulate(ball({"down": Mode(falls)}, "down", [1.0, 0.0], 1.8, [9.81]), METHOD)
    other = simulate(plain, METHOD)
    np.testing.assert_allclose(run.impacts.time, other.impacts.time, rtol=0, atol=1e-11)
