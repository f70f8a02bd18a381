"""Steps with friction and every event at its own time: closed forms, agreement with the event-driven run."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene, scenes
from lagrangian.scenes.rough_contacts import critical_friction
from lcpstep import EventDriven, Kind, LcpStepError, Located, Status, continued, simulate
from lcpstep import energy as energy_balance
from lcpstep.stepping.rubbing.run import RubbingRun
from tests.events.rough import G0, block, energy, shaken_slip, shaken_tangent, times
from tests.marks import shared
from tests.random_friction import draw
from tests.uncompiled import both_ways

ORDERS = (2, 4)


# --- closed forms


@pytest.mark.parametrize("order", ORDERS)
def test_the_coulomb_oscillator_turns_at_multiples_of_pi_and_stops_at_its_place(order):
    for h, size in ((0.05, 1.0), (0.005, 0.1)):
        run = simulate(scenes.coulomb_oscillator(), Located(h, order=order))
        turned = np.append(times(run, Kind.REVERSE), times(run, Kind.STICK_TANGENT))
        assert np.max(np.abs(turned - math.pi * np.arange(1, 6))) < 0.01 * size**order
        assert abs(run.q[-1, 0] + 0.05) < 2e-3 * size**order
        stopped = run.t > turned[-1]
        assert np.all(run.v[stopped] == 0.0)
        assert np.ptp(run.q[stopped], axis=0).tolist() == [0.0, 0.0]


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize(
    "scene",
    [
        scenes.slipping_wheel(),
        scenes.slipping_wheel(v0=2.0, mu=0.4, beta=1.0),
        scenes.sliding_block(),
        scenes.slope_landing(),
        scenes.slope_landing(slope=0.9, mu=0.3),
    ],
    ids=lambda s: s.name,
)
def test_motion_under_constant_forces_is_exact(scene, order):
    run = simulate(scene, Located(0.0377, order=order))
    t = np.linspace(*scene.t_span, 301)
    q, v = run.at(t)
    away = np.min(np.abs(t[:, None] - run.impacts.time), axis=1, initial=1.0) > 1e-3
    exact_q, exact_v = scene.exact(t)
    assert np.max(np.abs(q - exact_q)) < 1e-13 * (1.0 + np.max(np.abs(exact_q)))
    assert np.max(np.abs(v - exact_v)[away]) < 1e-12 * (1.0 + np.max(np.abs(exact_v)))


def test_the_friction_impulse_is_what_the_momentum_has_lost():
    run = simulate(scenes.slope_landing(), Located(1e-2))
    t = run.t[-1]
    along = 3.0 + G0 * math.sin(0.3) * t + np.sum(run.friction_impulse)
    assert abs(along - run.v[-1, 0]) < 1e-12
    assert abs(np.sum(run.impulse) - G0 * math.cos(0.3) * t) < 1e-11


@pytest.mark.parametrize("order", ORDERS)
def test_a_block_on_a_shaken_table_goes_with_the_event_driven_run(order):
    scene = Scene(
        system=LinearSystem(np.eye(2), force=[0.0, -G0]),
        contacts=LinearContacts([[0.0, 1.0]], friction=Coulomb(0.3, shaken_tangent, slip=shaken_slip)),
        q0=[0.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 3.0),
    )  # fmt: skip
    exact = simulate(scene, EventDriven())
    run = simulate(scene, Located(1e-2, order=order))
    turned = times(exact, Kind.REVERSE)
    assert len(times(run, Kind.REVERSE)) == len(turned) > 15
    # between two meetings the block has the acceleration +- mu g, which both orders follow exactly
    assert np.max(np.abs(times(run, Kind.REVERSE) - turned)) < 1e-13
    assert abs(run.q[-1, 0] - exact.q[-1, 0]) < 1e-13


@pytest.mark.parametrize("order", ORDERS)
def test_impulses_are_the_momentum_of_a_block_that_rocks_and_slides(order):
    run = simulate(scenes.sliding_rocking_block(), Located(1e-2, order=order))
    gained = run.v[-1, :2] - run.scene.v0[:2]
    assert abs(np.sum(run.friction_impulse) - gained[0]) < 1e-12
    assert abs(np.sum(run.impulse) - G0 * run.t[-1] - gained[1]) < 1e-12


def test_kanes_pendulum_leaves_its_impact_as_the_law_says():
    from lagrangian.scenes.kane_pendulum import after_impact

    for law in ("moreau", "newton"):
        scene = scenes.kane_pendulum(law=law)
        run = simulate(scene, Located(1e-4))
        assert np.max(np.abs(run.v[0] - after_impact(scene))) < 1e-10


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("mu", [0.05, 0.6])
def test_a_block_bounces_along_and_its_impulses_are_those_of_coulomb(mu, order):
    scene = Scene(
        system=LinearSystem(np.eye(2), force=[0.0, -G0]),
        contacts=LinearContacts([[0.0, 1.0]], restitution=0.8, friction=Coulomb(mu, [[1.0, 0.0]])),
        q0=[0.0, 0.5], v0=[4.0, 0.0], t_span=(0.0, 3.0),
    )  # fmt: skip
    run = simulate(scene, Located(0.1, order=order))
    if mu < 0.1:  # while it slides, friction is mu times what the weight and the impacts press with
        assert abs(run.v[-1, 0] - (4.0 - mu * (G0 * 3.0))) < 1e-10
    else:
        assert np.all(run.v[-1] == 0.0)
    assert abs(np.sum(run.impulse) - G0 * 3.0) < 1e-10


# --- agreement with the event-driven method


@pytest.mark.parametrize("seed", range(20))
def test_random_discs_and_blocks_go_with_the_event_driven_run(seed):
    scene, t = block(seed), np.linspace(0.05, 1.0, 20)
    exact, _ = simulate(scene, EventDriven(1e-12, 1e-12)).at(t)
    for order, (few, many) in {2: (400, 1600), 4: (100, 400)}.items():
        coarse, fine = (
            np.max(np.abs(simulate(scene, Located(1.0 / n, order=order), keep=t).q - exact))
            for n in (few, many)
        )
        assert fine < 1e-11 or fine < coarse / (0.6 * 4**order)


@pytest.mark.parametrize(("seed", "order", "n"), [(5, 2, 1603), (37, 4, 400)])
def test_feet_that_touch_down_far_slower_than_they_slide_find_their_impulses(seed, order, n):
    """At the end of a chattering, the last approach being as slow as the rounding of the sliding velocity."""
    run = simulate(block(seed), Located(1.0 / n, order=order), keep=[0.05, 1.0])
    assert run.status is Status.DONE, run.message


@pytest.mark.parametrize("seed", shared(range(1000, 1150), 10))
def test_more_random_discs_and_blocks_go_with_the_event_driven_run(seed):
    scene, t = block(seed), np.linspace(0.05, 1.0, 20)
    exact, _ = simulate(scene, EventDriven(1e-12, 1e-12)).at(t)
    for order, n in ((2, 10_000), (4, 1000)):
        run = simulate(scene, Located(1.0 / n, order=order), keep=t)
        assert np.max(np.abs(run.q - exact)) < 1e-5


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(ORDERS))
def test_no_energy_comes_from_friction_impulses_lie_in_the_cone_and_nothing_is_passed(seed, order):
    scene = block(seed)
    run = simulate(scene, Located(1e-3, order=order))
    assert run.status == Status.DONE, run.message
    E = energy(scene, run.q, run.v)
    assert np.max(np.diff(E)) < {2: 1e-5, 4: 1e-9}[order] * (1.0 + E[0])  # that of the smooth motion
    assert np.min(run.impulse) > -1e-9
    assert np.all(np.abs(run.friction_impulse) <= scene.contacts.friction.mu * run.impulse + 1e-12)
    assert np.max(run.penetration) < 1e-12


# --- Painleve


@pytest.mark.parametrize("order", ORDERS)
def test_a_rod_that_jams_is_named_with_its_critical_coefficient(order):
    scene = scenes.falling_rod(mu=1.05 * critical_friction(0.9), angle=0.9, t_end=1e-3)
    run = simulate(scene, Located(1e-4, order=order))
    assert run.status == Status.PAINLEVE_INCONSISTENT
    assert abs(float(run.message.split("state: ")[1].split(")")[0]) - critical_friction(0.9)) < 1e-7


# --- what is made of such runs


@pytest.mark.parametrize("seed", [3, 8, 21])
@pytest.mark.parametrize("order", ORDERS)
def test_the_motion_does_not_depend_on_what_is_kept(seed, order):
    scene, method = block(seed), Located(1.7e-3, order=order)
    whole, some, few = (simulate(scene, method, keep=keep) for keep in (1, [0.3, 1.0], 7))
    for run in (some, few):
        assert np.array_equal(whole.q[-1], run.q[-1])
        assert np.array_equal(whole.impacts, run.impacts)
        total = np.sum(whole.friction_impulse, axis=0)
        assert np.allclose(total, np.sum(run.friction_impulse, axis=0), atol=1e-12)
    assert np.allclose(whole.at(0.3)[0], some.q[0], rtol=0.0, atol=1e-14)
    assert whole.counts.steps == math.ceil(1.0 / 1.7e-3)
    assert len(few.t) < len(whole.t) / 4


def test_a_run_with_friction_goes_on_from_its_end():
    method = Located(1e-2, order=4)
    first = simulate(scenes.coulomb_oscillator(t_end=5.0), method)
    second = simulate(continued(first, t_end=20.0), method)
    whole = simulate(scenes.coulomb_oscillator(), method)
    assert np.max(np.abs(second.q[-1] - whole.q[-1])) < 1e-10


@pytest.mark.slow
def test_the_energy_that_friction_takes_never_comes_back():
    for scene in (scenes.sliding_block(), scenes.slope_landing(), scenes.slider_crank()):
        E = energy_balance(simulate(scene, Located(1e-4, order=4)))
        assert np.min(np.diff(E.friction)) > -1e-8
        assert len(E.created) == 0


def test_errors_and_audits_are_taken():
    scene = scenes.coulomb_oscillator()
    run = simulate(scene, Located(2e-2, audit=True), error=True)
    t = np.linspace(*scene.t_span, 2001)
    true = np.max(np.abs(run.at(t)[0] - scene.exact(t)[0]))
    assert 0.5 < true / run.error.position.sup < 2.0
    assert run.audit is not None


def test_what_is_refused_is_named():
    with pytest.raises(LcpStepError, match="order='exact' does not treat friction"):
        simulate(scenes.sliding_block(), Located(1e-2, "exact"))


PROGRAM = """
from lagrangian import scenes
from lcpstep import Located, simulate

for order, tolerance in ((2, None), (4, None), (4, 1e-5)):
    for scene in (scenes.coulomb_oscillator(t_end=4.0), scenes.woodpecker(t_end=0.04)):
        method = Located(scene.t_span[1] / 50, order=order, tolerance=tolerance)
        run = simulate(scene, method, keep=1)
        print(len(run.t), run.counts, *(float(x).hex() for x in (*run.q[-1], *run.v[-1], *run.impacts.impulse)))
"""


@pytest.mark.slow
def test_the_kernels_as_plain_python_give_the_same():
    built, plain = both_ways(PROGRAM)
    assert built == plain


def impact_of_the_orbit(scene, method):
    """Period and state at the last but one impact of contact 0."""
    run = simulate(scene, method, keep="impacts")
    hit = run.impacts.time[(run.impacts.kind == Kind.IMPACT) & (run.impacts.contact == 0)]
    return hit[-1] - hit[-2], np.concatenate(run.at(hit[-2:-1]), axis=1)[0]


def test_the_woodpeckers_orbit_is_the_same_to_ten_digits():
    period, x = impact_of_the_orbit(scenes.woodpecker(t_end=30.0), EventDriven(1e-13, 1e-13))
    scene = replace(scenes.woodpecker(), q0=x[:3], v0=x[3:], t_span=(0.0, 6.2 * period))
    for method, digits in (
        (EventDriven(1e-12, 1e-12), 11.0),
        (Located(1e-5, order=4), 10.0),
        (Located(1e-5), 5.5),
    ):
        found, y = impact_of_the_orbit(scene, method)
        assert abs(found / period - 1.0) < 10.0**-digits
        assert np.max(np.abs(y - x)[1:]) < 10.0**-digits * np.max(np.abs(x[1:]))


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("n", [500, 2000, 4000])
def test_endless_impacts_of_one_foot_between_those_of_the_other_have_an_end(n, order):
    """Hops lower than what steps resolve of a gap were followed until they had fallen that deep: none was the last.

    The other foot stops to slide meanwhile, an event that was taken for the first one.
    """
    scene = draw(577)
    start, end = scene.t_span
    m = simulate(scene, Located((end - start) / n, order=order, max_events=2000))
    reference = simulate(scene, EventDriven())
    assert m.status == Status.DONE
    assert len(m.impacts) < 1.1 * len(reference.impacts)
    assert np.max(np.abs(m.q[-1] - reference.q[-1])) < 1e-4


def test_parts_of_a_step_between_events_are_looked_at_as_steps_are(monkeypatch):
    """Else nobody would see that a run goes on without end within one step."""
    seen, end = [], RubbingRun.trajectory

    def told(run, code):
        seen.append((run.done, run.counts.steps))
        return end(run, code)

    monkeypatch.setattr(RubbingRun, "trajectory", told)
    m = simulate(scenes.mass_on_shaken_belt(), Located(2e-2))
    inside = {t for t in m.impacts.time if 1e-6 < t % 2e-2 < 2e-2 - 1e-6}
    ((done, steps),) = seen
    assert steps == m.counts.steps == 2000
    assert done - steps >= len(inside) > 0
