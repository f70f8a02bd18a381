"""Systems with modes that have contacts, against closed forms, the same scene without modes, and what goes wrong."""

import math
from dataclasses import replace

import numpy as np
import pytest

import lcpstep
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
from lcpstep import EventDriven, Kind, LcpStepError, SimulationError, Status, simulate
from lcpstep.maps import StroboscopicMap, SwitchMap

METHOD = EventDriven()
FLOOR, LIVELY = LinearContacts([[1.0]], restitution=0.7), LinearContacts([[1.0]], restitution=0.95)


def falls(t, x, p, out):  # p: gravity, its factor in the other mode, where that begins
    out[0], out[1] = x[1], -p[0]


def falls_otherwise(t, x, p, out):
    out[0], out[1] = x[1], -p[0] * p[1]


def below(t, x, p, out):
    out[0] = p[2] - x[0]


def above(t, x, p, out):
    out[0] = x[0] - p[2]


def later(t, x, p, out):
    out[0] = t - p[2]


def upwards(t, x, p, out):
    out[0] = x[1]


def at_the_floor(t, x, p, out):
    out[0] = -x[0]


def thrown_up(t, x, p, out):
    out[0], out[1] = 2.0, 0.0


def thrown_down(t, x, p, out):
    out[0], out[1] = -1.0, 0.0


def ball(modes, mode, x0, t_end, p, contacts=FLOOR, **more):
    return HybridScene(
        HybridSystem(2, modes, mass=[[2.0]]), x0, mode, (0.0, t_end), p=p, contacts=contacts, name="ball", **more
    )  # fmt: skip


def two_gravities(t_end=6.0, factor=2.0):
    modes = {"high": Mode(falls, [Guard(below, "low")]), "low": Mode(falls_otherwise, [Guard(above, "high")])}
    return ball(modes, "high", [1.0, 0.0], t_end, [9.81, factor, 0.4], LIVELY)


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


def soft(t, x, p, out):  # p: squares of the two frequencies, distance of the wall
    out[0], out[1] = x[1], -p[0] * x[0]


def stiff(t, x, p, out):
    out[0], out[1] = x[1], -p[1] * x[0]


def left(t, x, p, out):
    out[0] = -x[0]


def right(t, x, p, out):
    out[0] = x[0]


def bilinear_with_wall(t_end=30.0, r=0.8, wall=0.3, **more):
    modes = {"right": Mode(soft, [Guard(left, "left")]), "left": Mode(stiff, [Guard(right, "right")])}
    return HybridScene(
        HybridSystem(2, modes, mass=[[0.5]]), [1.0, 0.0], "right", (0.0, t_end), p=[1.0, 4.0, wall],
        contacts=LinearContacts([[1.0]], offset=wall, restitution=r), name="bilinear with wall", **more,
    )  # fmt: skip


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


# --------------------------------------------------------------------------- guards and impacts


@pytest.mark.parametrize("at_once", [True, False])
def test_a_guard_that_an_impact_carries_through_zero_acts_at_the_impact(at_once):
    modes = {
        "down": Mode(falls, [Guard(upwards, "up", at_once=at_once)]),
        "up": Mode(falls, [Guard(upwards, "down", direction=-1)]),
    }
    run = simulate(ball(modes, "down", [1.0, -0.1], 1.5, [9.81]), METHOD)
    hits = run.impacts.time[run.impacts.kind == Kind.IMPACT]
    assert len(hits) >= 2
    np.testing.assert_array_equal(run.switches.time[run.switches.target == "up"], hits)
    first = run.switches[0]
    assert first.before[1] == run.impacts.after[0]
    tops = hits + run.impacts.after / 9.81
    down = run.switches.time[run.switches.target == "down"]
    np.testing.assert_allclose(down, tops[: len(down)], rtol=0, atol=1e-11)


def test_a_guard_on_the_obstacle_acts_with_the_impact():
    modes = {"a": Mode(falls, [Guard(at_the_floor, "b", at_once=False)]), "b": Mode(falls_otherwise)}
    run = simulate(ball(modes, "a", [1.0, 0.0], 1.0, [9.81, 2.0]), METHOD)
    falls_for = math.sqrt(2.0 / 9.81)
    assert len(run.switches) == 1
    np.testing.assert_allclose([run.switches.time[0], run.impacts.time[0]], falls_for, rtol=0, atol=1e-12)
    assert run.impacts.after[0] == pytest.approx(0.7 * 9.81 * falls_for, abs=1e-11)
    assert run.impacts.time[1] - falls_for == pytest.approx(
        2.0 * run.impacts.after[0] / (2.0 * 9.81), abs=1e-11
    )


def test_a_reset_takes_a_resting_body_off_the_floor():
    modes = {"down": Mode(falls, [Guard(later, "again", reset=thrown_up)]), "again": Mode(falls)}
    run = simulate(ball(modes, "down", [0.0, 0.0], 1.5, [9.81, 1.0, 0.5]), METHOD)
    assert list(run.impacts.kind) == [Kind.STICK, Kind.RELEASE, Kind.IMPACT]
    np.testing.assert_allclose(run.impacts.time[1:], [0.5, 0.5 + math.sqrt(4.0 / 9.81)], rtol=0, atol=1e-11)
    np.testing.assert_array_equal(run.switches.after[0], [2.0, 0.0])
    np.testing.assert_array_equal(run.at(run.switches.time[0]), [2.0, 0.0])


def unchanged(t, x, p, out):
    out[0], out[1] = x[0], x[1]


@pytest.mark.parametrize("speed", [1e-2, -1e-2])
def test_a_reset_within_a_low_hop_leaves_the_hop_its_height(speed):
    """Lower than the tolerance of places, by 1e-6: it lands with the speed that its whole height gives."""
    place = 9e-7
    modes = {"down": Mode(falls, [Guard(later, "again", reset=unchanged)]), "again": Mode(falls)}
    t = 5e-5
    x = [place - t * speed, speed]
    table = LinearContacts([[1.0]], restitution=1.0)
    run = simulate(ball(modes, "down", x, 3e-3, [9.81, 1.0, t], table), EventDriven(1e-6, 1e-6))
    hits = run.impacts[run.impacts.kind == Kind.IMPACT]
    assert len(run.switches) == 1
    assert hits.before[0] == pytest.approx(-math.sqrt(speed * speed + 2.0 * 9.81 * x[0]), rel=1e-3)


def test_a_reset_that_leads_into_the_obstacle_is_named():
    modes = {"down": Mode(falls, [Guard(later, "deep", reset=thrown_down)]), "deep": Mode(falls)}
    run = simulate(ball(modes, "down", [0.0, 0.0], 1.5, [9.81, 1.0, 0.5]), METHOD)
    assert run.status == Status.PROJECTION_FAILED
    assert "reset of the switch to mode 'deep' leads inside the obstacle of contact 0" in run.message
    assert run.t[-1] == pytest.approx(0.5, abs=1e-12)


def test_a_mode_whose_guard_is_passed_at_the_start_is_left_at_once():
    modes = {"down": Mode(falls, [Guard(above, "low")]), "low": Mode(falls_otherwise)}
    run = simulate(ball(modes, "down", [1.0, 0.0], 0.3, [9.81, 2.0, 0.4]), METHOD)
    assert run.switches.time[0] == 0.0
    assert run.at(0.3)[0] == pytest.approx(1.0 - 9.81 * 0.09, abs=1e-12)


def test_modes_that_follow_one_another_for_ever_are_named():
    modes = {"a": Mode(falls, [Guard(above, "b")]), "b": Mode(falls, [Guard(above, "a")])}
    run = simulate(ball(modes, "a", [1.0, 0.0], 0.3, [9.81, 2.0, 0.4]), METHOD)
    assert run.status == Status.ENDLESS_SWITCHING
    assert "b -> a" in run.message or "a -> b" in run.message


def test_a_guard_that_is_only_touched_is_named():
    modes = {"a": Mode(falls, [Guard(above, "b", at_once=False)]), "b": Mode(falls)}
    top = 0.5 + 2.0**2 / (2.0 * 9.81)
    run = simulate(ball(modes, "a", [0.5, 2.0], 1.0, [9.81, 2.0, top]), METHOD)
    assert run.status == Status.NOT_TRANSVERSAL
    assert "touches the guard towards 'b'" in run.message


def test_events_of_both_kinds_count():
    run = simulate(two_gravities(), EventDriven(max_events=5))
    assert run.status == Status.TOO_MANY_EVENTS
    assert len(run.switches) + len(run.impacts) <= 7


# --------------------------------------------------------------------------- what can be done with a run


def test_a_run_keeps_what_is_asked_for():
    scene = two_gravities(1.8)
    whole = simulate(scene, METHOD)
    times = np.linspace(0.05, 1.75, 18)
    some = simulate(scene, METHOD, keep=times)
    np.testing.assert_allclose(some.x, whole.at(times), rtol=0, atol=1e-13)
    np.testing.assert_array_equal(some.mode, whole.mode_at(times))
    np.testing.assert_array_equal(some.at(times), some.x)
    assert some.mode_at(whole.switches.time[3]) == whole.switches.target[3]
    with pytest.raises(ValueError, match="keep=1"):
        some.at(0.051)
    events = simulate(scene, METHOD, keep="impacts")
    assert set(whole.impacts.time) | set(whole.switches.time) <= set(events.t)
    np.testing.assert_allclose(events.impulse.sum(axis=0), whole.impulse.sum(axis=0), rtol=1e-12)


def test_a_run_is_saved_drawn_tabled_and_continued(tmp_path):
    scene = bilinear_with_wall(10.0, labels=("position [m]", "velocity [m/s]"))
    run = simulate(scene, METHOD)
    again = lcpstep.load(run.save(tmp_path / "run.nc"), scene=scene)
    for name in ("t", "x", "impulse", "mode"):
        np.testing.assert_array_equal(getattr(again, name), getattr(run, name))
    for name in ("time", "impulse"):
        np.testing.assert_array_equal(again.impacts[name], run.impacts[name])
    t = np.linspace(0.0, 10.0, 77)
    np.testing.assert_array_equal(again.at(t), run.at(t))
    np.testing.assert_array_equal(again.mode_at(t), run.mode_at(t))
    assert len(run.plot().axes) == 4
    assert "impact" in run._repr_html_()
    table = run.to_dataframe()
    assert list(table.columns) == ["impulse0", "x0", "x1", "mode"]
    events = run.to_dataframe("events")
    assert len(events) == len(run.impacts) + len(run.switches)
    assert np.all(np.diff(events.time) >= 0.0)
    assert {"impact_time", "switch_time", "impulse"} <= set(run.to_xarray().variables)
    whole = simulate(replace(scene, t_span=(0.0, 20.0)), METHOD)
    rest = simulate(lcpstep.continued(run, t_end=20.0), METHOD)
    np.testing.assert_allclose(rest.at(20.0), whole.at(20.0), rtol=0, atol=1e-10)


def height_tells(t, x, p):
    return "high" if x[0] > p[2] else "low"


def test_returns_to_a_mode_are_found_and_derivatives_refused():
    scene = two_gravities()
    run, P = simulate(scene, METHOD), SwitchMap(scene, METHOD, "low")
    entered = run.switches[run.switches.target == "low"]
    np.testing.assert_allclose(P(P.entry()), entered.after[1], rtol=0, atol=1e-11)
    with pytest.raises(LcpStepError, match="velocities jump and contacts rest"):
        P.jacobian(P.entry())
    told = replace(scene, system=replace(scene.system, mode_of=height_tells), period=1.0)
    with pytest.raises(LcpStepError, match="velocities jump and contacts rest"):
        StroboscopicMap(told, METHOD)([0.7, 0.0])


# --------------------------------------------------------------------------- bad input


def wrong_order(t, x, p, out):
    out[0], out[1] = -p[0], x[1]


def nothing_after_a_while(t, x, p, out):
    out[0], out[1] = x[1], math.nan if t > 0.2 else -p[0]


def test_bad_input_is_named():
    modes = {"down": Mode(falls)}

    def scene(contacts=FLOOR, mass=1.0, x0=(1.0, 0.0), modes=modes):
        return HybridScene(
            HybridSystem(2, modes, mass=mass), x0, "down", (0.0, 1.0), p=[9.81], contacts=contacts
        )

    for expected, error, make in (
        ("contacts: expected a system with a mass matrix", ValueError, lambda: scene(mass=None)),
        ("mass: .*positive definite", ValueError, lambda: scene(mass=-1.0)),
        ("mass: expected shape", ValueError, lambda: scene(mass=np.eye(2))),
        ("n_x: expected an even number", ValueError, lambda: HybridSystem(3, modes, mass=np.eye(1))),
        ("x0: the initial state lies inside", ValueError, lambda: scene(x0=(-0.1, 0.0))),
        ("contacts.G: expected 1 columns", ValueError, lambda: scene(LinearContacts([[1.0, 0.0]]))),
        ("contacts: expected", TypeError, lambda: scene([[1.0]])),
        (r"field of mode 'down': expected \(v, v'\)", ValueError, lambda: scene(modes={"down": Mode(wrong_order)})),
    ):  # fmt: skip
        with pytest.raises(error, match=expected):
            make()


def test_a_field_that_fails_on_the_way_ends_the_run_with_its_name():
    with pytest.raises(SimulationError, match="mode 'down'"):
        simulate(ball({"down": Mode(nothing_after_a_while)}, "down", [1.0, 0.0], 1.0, [9.81]), METHOD)


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
