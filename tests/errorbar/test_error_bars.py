"""Error bars of runs against motions in closed form: within a factor of two, and honest about where they end."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, Harmonic, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.accuracy.reference import find_reference
from tests.known import KNOWN


def true_errors(known, run):
    """Sup and integral of the position error of the first coordinate, against a closed form."""
    t = np.linspace(run.t[0], run.error.until, 20_001)
    apart = np.abs(run.at(t)[0][:, 0] - known.q(t))
    return np.max(apart), np.trapezoid(apart, t)


@pytest.mark.parametrize("known", KNOWN, ids=lambda k: k.name)
@pytest.mark.parametrize("share", [1 / 150.0, 1 / 1333.0])
@pytest.mark.parametrize("method", [Moreau, lambda h: Moreau(h, theta=1.0), Located, lambda h: Located(h, 4)])
def test_the_bar_of_steps_is_the_error_within_a_factor_of_two(known, share, method):
    run = simulate(known.scene, method(share * np.ptp(known.scene.t_span)), error=True)
    bar, (sup, l1) = run.error.position, true_errors(known, run)
    assert run.error.until > 0.5 * known.scene.t_span[1]
    if sup > 1e-12:
        assert 0.5 < sup / bar.sup < 2.0
        assert 0.5 < l1 / bar.l1 < 2.0
    else:
        assert bar.sup < 1e-11
    assert bar.sup >= 0.1 * sup


def spring(t, q, v, p, out):
    out[0] = -4.0 * q[0]


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5, 1e-8])
def test_the_bar_of_an_event_driven_run_is_the_error_of_its_tolerance_and_a_second_method_agrees(tolerance):
    scene = Scene(system=System(1, [[1.0]], spring), q0=1.0, v0=0.0, t_span=(0.0, 20.0))
    run = simulate(scene, EventDriven(tolerance, tolerance), error=True)
    t = np.linspace(0.0, 20.0, 20_001)
    assert 0.5 < np.max(np.abs(run.at(t)[0][:, 0] - np.cos(2.0 * t))) / run.error.position.sup < 2.0
    v = run.at(t)[1][:, 0]
    assert 0.5 < np.trapezoid(np.abs(v + 2.0 * np.sin(2.0 * t)), t) / run.error.velocity.l1 < 2.0
    assert [x.split("(")[0] for x in run.error.companions] == ["EventDriven", "Located"]


def height(t, q, v, p, out):
    out[0] = q[0]


def one(t, q, v, p, out):
    out[0, 0] = 1.0


@pytest.mark.parametrize("method", [EventDriven(), EventDriven(1e-8, 1e-8), Located(1e-2, 4)])
def test_the_bar_of_a_motion_of_micrometres_is_its_error(method):
    stop = Contacts(1, height, one, restitution=1.0)
    scene = Scene(System(1, [[1.0]], spring), 1e-6, 0.0, (0.0, 10.0), stop)
    run = simulate(scene, method, error=True)
    t = np.linspace(0.0, 10.0, 2001)
    apart = np.abs(run.at(t)[0][:, 0] - 1e-6 * np.abs(np.cos(2.0 * t)))
    assert 0.5 < np.max(apart) / run.error.position.sup < 2.0


def test_errors_of_impacts_are_those_of_a_dropped_ball():
    h0, g, r = 1.0, 9.81, 0.8
    scene = scenes.bouncing_ball(h0=h0, restitution=r, t_end=2.0)
    fall = math.sqrt(2.0 * h0 / g)
    times = fall * (1.0 + 2.0 * np.concatenate([[0.0], np.cumsum(r ** np.arange(1, 3))]))
    run = simulate(scene, Moreau(1e-3), error=True)
    own = run.impacts.time[:3]
    assert np.all(np.abs(run.error.impact_time[:3] / np.abs(own - times) - 1.0) < 1e-6)
    exact = g * fall * (1.0 + r) * r ** np.arange(3)
    assert np.allclose(run.error.impact_impulse[:3], np.abs(run.impacts.impulse[:3] - exact), rtol=1e-6)
    # the velocity is compared away from impacts: far less than the 8 m/s of a jump
    assert run.error.velocity.sup < 0.05
    # but in L1 an impact that comes late counts with its jump
    late = np.abs(own - times) @ ((1.0 + r) * g * fall * r ** np.arange(3))
    assert run.error.velocity.l1 > 0.5 * late


def test_functions_of_time_grow_to_what_holds_over_the_span():
    run = simulate(scenes.impact_oscillator(t_end=20.0), Located(1e-2), error=True)
    bar = run.error
    for x in (bar.position, bar.velocity, bar.energy):
        assert len(x.largest) == len(x.integral) == len(bar.t)
        assert np.all(np.diff(x.largest, axis=0) >= 0.0)
        assert np.all(np.diff(x.integral, axis=0) >= 0.0)
        assert (x.sup, x.l1) == (np.max(x.largest[-1]), np.max(x.integral[-1]))
    assert (bar.t[0], bar.t[-1], bar.until, bar.reason, bar.horizon) == (0.0, 20.0, 20.0, "", math.inf)
    half = simulate(scenes.impact_oscillator(t_end=10.0), Located(1e-2), error=True).error
    k = np.searchsorted(bar.t, 10.0)
    assert half.position.sup == pytest.approx(bar.position.largest[k, 0], rel=0.1)


def test_halving_the_step_changes_the_bar_as_the_order_says():
    scene = scenes.double_pendulum(t_end=2.0)
    for method, order in ((Located, 2), (lambda h: Located(h, 4), 4)):
        bars = [simulate(scene, method(h), error=True).error.position.sup for h in (8e-3, 4e-3, 2e-3)]
        assert math.log2(bars[0] / bars[2]) / 2.0 == pytest.approx(order, abs=0.5)


def test_chaos_ends_the_bar_where_the_motion_can_no_longer_be_told():
    run = simulate(scenes.cam_follower(rpm=660.0, t_end=5.0), Located(1e-3), error=True)
    bar = run.error
    assert 0.1 < bar.until < bar.horizon < 3.0
    assert "quarter of the range" in bar.reason
    assert bar.position.sup < 0.25 * np.max(np.ptp(run.q, axis=0))
    assert np.all(np.isnan(bar.impact_time[run.impacts.time > bar.until]))


def test_runs_that_see_different_events_end_the_bar_there():
    # a stop just within the amplitude, which the damping of theta = 1 keeps a coarse run from reaching
    scene = Scene(
        system=LinearSystem(1.0, K=1.0), contacts=LinearContacts(1.0, 0.99, 1.0), q0=1.0, v0=0.0, t_span=(0.0, 6.0)
    )  # fmt: skip
    coarse = simulate(scene, Moreau(0.05, theta=1.0), error=True)
    assert len(coarse.impacts) == 0
    assert coarse.error.until == pytest.approx(math.acos(-0.99), abs=0.1)
    assert "different events, an impact of the companion without partner at contact 0" in coarse.error.reason
    whole = simulate(scene, Moreau(1e-4, theta=1.0), error=True)
    assert len(whole.impacts) == 1
    assert (whole.error.until, whole.error.reason) == (6.0, "")


def test_contacts_struck_together_or_in_turn_are_the_same_event_where_they_part_alike():
    beads = scenes.elastic_gas(t_end=1.0)
    run = simulate(beads, EventDriven(), error=True)
    assert (run.error.until, run.error.reason) == (1.0, "")
    assert run.error.position.sup < 1e-12


@pytest.mark.parametrize("keep", [7, "impacts", [0.0, 1.0, 1.5, 4.0, 9.0]])
def test_without_every_step_the_kept_states_are_compared(keep):
    scene = scenes.impact_oscillator(t_end=10.0)
    for method in (Moreau(1e-3), Located(1e-2), EventDriven(1e-6, 1e-6)):
        whole = simulate(scene, method, error=True).error
        some = simulate(scene, method, keep=keep, error=True)
        assert set(some.error.t) <= set(some.t)
        assert some.error.position.sup <= 1.2 * whole.position.sup
        assert some.error.latest == pytest.approx(whole.latest)
        assert some.error.until == whole.until == 10.0


@pytest.mark.parametrize("method", [Moreau(1e-3), Located(1e-3)])
def test_without_every_step_a_bar_that_ends_early_is_the_error_too(method):
    touching = LinearContacts(G=-1.0, offset=1.0, restitution=0.9)  # q = sin t touches it at pi/2
    scene = Scene(LinearSystem(M=1.0, K=1.0), 0.0, 1.0, (0.0, 10.0), touching)
    run = simulate(scene, method, keep=3, error=True)
    assert run.error.until < 1.6
    t = run.t[run.t <= run.error.until]
    q, v = run.at(t)
    assert run.error.position.sup == pytest.approx(np.max(np.abs(q[:, 0] - np.sin(t))), rel=0.01)
    assert run.error.velocity.sup == pytest.approx(np.max(np.abs(v[:, 0] - np.cos(t))), rel=0.01)


def test_of_many_kept_states_the_few_in_hops_that_are_not_followed_are_looked_at():
    ball = scenes.bouncing_ball(h0=1.0, g=10.0, restitution=0.8, t_end=6.0)
    run = simulate(ball, EventDriven(1e-6, 1e-6), keep=np.linspace(0.0, 6.0, 5001), error=True)
    apart = np.max(np.abs(run.q - ball.exact(run.t)[0]))
    assert apart > 1e-7
    assert 0.5 < apart / run.error.position.sup < 2.0


@pytest.mark.parametrize("scene", [scenes.sliding_block(), scenes.coulomb_oscillator()], ids=lambda s: s.name)
def test_steps_with_friction_are_held_against_the_event_driven_run(scene):
    run = simulate(scene, Moreau(1.3e-3), error=True)
    assert run.error.companions[0].startswith("EventDriven(")
    t = np.linspace(*scene.t_span, 2001)
    true = np.max(np.abs(run.at(t)[0] - scene.exact(t)[0]))
    assert 0.5 < true / run.error.position.sup < 2.0


def test_scenes_at_rest_and_without_contacts_have_bars_at_rounding():
    still = Scene(system=LinearSystem(2.0, force=Harmonic(-19.62)), contacts=LinearContacts([[1.0]], 0.0, 0.5),
                  q0=0.0, v0=0.0, t_span=(0.0, 1.0))  # fmt: skip
    free = Scene(system=LinearSystem(1.0), q0=3.0, v0=1.0, t_span=(0.0, 1.0))
    for scene in (still, free):
        for method in (Moreau(1e-2), Located(1e-2), EventDriven()):
            bar = simulate(scene, method, error=True).error
            assert (bar.until, bar.reason) == (1.0, "")
            assert bar.position.sup < 1e-13
            assert math.isnan(bar.latest)
    assert simulate(free, Located(1e-2), error=True).error.position.sup > 0.0  # never below rounding


def shaken(t, q, v, p, out):
    out[0] = 3.0 * math.cos(2.0 * t) - q[0] - 0.2 * q[0] ** 3


def test_references_are_checked_by_a_method_that_shares_nothing_with_theirs():
    linear = scenes.impact_oscillator(t_end=5.0)
    curved = Scene(
        system=System(1, [[1.0]], shaken), contacts=LinearContacts(1.0, 0.5, 0.8), q0=0.0, v0=0.0, t_span=(0.0, 5.0)
    )  # fmt: skip
    bound = scenes.slider_crank(t_end=0.02)
    for scene, given, checker in (
        (replace(linear, exact=None), None, "Located(order='exact')"),
        (linear, Moreau(1e-3), "EventDriven"),
        (curved, None, "Located(order=4)"),
        (bound, Moreau(1e-5), "EventDriven"),  # with friction
    ):
        found = find_reference(scene, given)
        assert f"checked by {checker}" in found.text
        unsure = found.uncertainty(["sup_position"])["sup_position"]
        assert unsure < (1e-9 if given is None else 1e-1)


def test_an_error_that_does_not_depend_on_the_tolerance_is_seen_by_the_other_method(monkeypatch):
    """A force that the event-driven method alone is given wrongly, by 1e-3 of the spring."""
    right = EventDriven.run

    def wrong(self, scene, kept, progress):
        softer = replace(scene, system=LinearSystem(1.0, K=0.999))
        return replace(right(self, softer, kept, progress), scene=scene)

    monkeypatch.setattr(EventDriven, "run", wrong)
    scene = Scene(system=LinearSystem(1.0, K=1.0), q0=1.0, v0=0.0, t_span=(0.0, 10.0))
    assert find_reference(scene, None).uncertainty(["sup_position"])["sup_position"] > 1e-3
    assert simulate(scene, EventDriven(), error=True).error.position.sup > 1e-3


def test_times_about_which_the_bar_of_velocities_says_nothing_are_few_and_told():
    run = simulate(scenes.impact_oscillator(t_end=20.0), Located(1e-2), error=True)
    out = run.error.left_out
    assert np.all(out[:, 0] <= out[:, 1])
    assert np.all(out[1:, 0] > out[:-1, 1])
    hits = run.impacts.time
    assert np.all(np.min(np.abs(hits[:, None] - np.mean(out, axis=1)), axis=1) < 1e-3)
    assert np.sum(np.diff(out)) < 1e-3 * 20.0
    t = np.linspace(0.0, 20.0, 5001)
    t = t[~np.any((t[:, None] >= out[:, 0]) & (t[:, None] <= out[:, 1]), axis=1)]
    apart = np.max(np.abs(run.at(t)[1] - run.scene.exact(t)[1]))
    assert 0.5 < apart / run.error.velocity.sup < 1.01


@pytest.mark.parametrize("atol", [1e-14, 1e-15])
def test_what_strikes_together_within_a_tight_tolerance_is_part_of_the_bar(atol):
    """Three rough blocks on each other, on a table that is shaken, whose hops collapse together."""
    G, T, f = np.zeros((3, 6)), np.zeros((3, 6)), np.zeros(6)
    f[1::2] = -9.81
    for i in range(3):
        G[i, 2 * i + 1] = T[i, 2 * i] = 1.0
        if i > 0:
            G[i, 2 * i - 1] = T[i, 2 * i - 2] = -1.0
    friction = Coulomb([0.5, 0.4, 0.3], T, slip=Harmonic(sine=[-0.6, 0.0, 0.0], omega=12.0))
    scene = Scene(
        LinearSystem(np.eye(6), force=f),
        q0=[0.0, 0.1, 0.0, 0.25, 0.0, 0.3],
        v0=[0.3, 0.0, 0.0, 0.0, -0.5, 0.0],
        t_span=(0.0, 2.0),
        contacts=LinearContacts(G, 0.0, restitution=[0.5, 0.3, 0.2], friction=friction),
    )
    run = simulate(scene, EventDriven(1e-13, atol), error=True)
    t = np.linspace(0.0, 2.0, 30)[1:-1]
    apart = np.max(np.abs(run.at(t)[0] - simulate(scene, EventDriven(1e-13, 1e-16)).at(t)[0]))
    assert 1e-12 < apart < 2.0 * run.error.position.sup
