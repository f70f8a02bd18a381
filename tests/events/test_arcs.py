"""What rubs along a line under a constant normal force: closed form against integration and exact motions."""

from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lagrangian.scenes.belts import stick_slip_period
from lcpstep import EventDriven, energy, simulate
from lcpstep.events.arcs.line import line_of
from lcpstep.events.arcs.run import ArcRun
from lcpstep.events.contacts.run import ContactRun
from lcpstep.recording import Kept
from lcpstep.trajectory import Kind


def integrated(scene, keep, tolerance=1e-12):
    """The same motion by Runge-Kutta steps."""
    method = EventDriven(tolerance, tolerance)
    return ContactRun(method, scene, Kept.parse(keep, scene.t_span)).finish(lambda t: None)


def drawn(seed):
    """A body on a belt: oblique coordinates, damping, any two of springs, harmonic forces and a belt that sways."""
    rng = np.random.default_rng(seed)
    angle, omega = rng.uniform(0.0, 6.0), float(rng.uniform(0.3, 3.0))
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])  # rows: along, normal
    mass = rng.uniform(0.5, 2.0)
    spring, damping = rng.choice([0.0, 1.0, 1.0]) * rng.uniform(0.2, 4.0), rng.choice([0.0, 1.0]) * 0.1
    damping = damping if spring > 0.0 else 0.0
    along, normal = turn
    drive = rng.choice([0.0, 1.0]) * rng.uniform(-1.5, 1.5)
    force = Harmonic(
        rng.uniform(-0.5, 0.5) * along - rng.uniform(0.5, 2.0) * normal,
        drive * along, rng.uniform(-1.0, 1.0) * drive * along, 1.37 * omega,
    )  # fmt: skip
    mu = rng.uniform(0.1, 0.6)
    belt = -rng.choice([0.0, rng.uniform(-0.5, 0.5)])
    slip = (
        Harmonic(belt, rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), omega) if rng.random() < 0.5 else belt
    )
    friction = Coulomb(mu, [2.0 * along], slip=slip, mu_s=mu * rng.choice([1.0, rng.uniform(1.0, 2.0)]))
    offset = rng.uniform(-1.0, 1.0)
    return Scene(
        system=LinearSystem(
            mass * np.eye(2), damping * np.outer(along, along), spring * np.outer(along, along), force
        ),
        contacts=LinearContacts([normal], offset=[offset], friction=friction),
        q0=rng.uniform(-2.0, 2.0) * along - offset * normal,
        v0=rng.choice([0.0, 1.0]) * rng.uniform(-2.0, 2.0) * along,
        t_span=(0.5, 30.5),
    )


def lasting(run):
    """What happens to the contact, but for touches: what a belt lets off just reaches its velocity.

    The steps know the slip to 1e-11, so where it turns at zero, with a second derivative near 1, they may find it
    negative for as long as 2 (2e-11)^(1/2) s.
    """
    log = run.impacts
    touch = (log.kind[:-1] == Kind.STICK_TANGENT) & (log.kind[1:] == Kind.SLIP) & (np.diff(log.time) < 2e-5)
    short = np.append(touch, False) | np.append(False, touch)
    return list(log.kind[~short])


@pytest.mark.parametrize("part", range(6))
def test_motions_drawn_at_random_are_those_of_integration(part):
    for seed in range(20 * part, 20 * part + 20):
        scene = drawn(seed)
        assert line_of(scene) is not None
        times = np.linspace(*scene.t_span, 301)
        run, other = simulate(scene, EventDriven(), keep=times), integrated(scene, times)
        assert run.status == other.status == 0
        for name in ("q", "v", "impulse", "friction_impulse"):
            mine, truth = getattr(run, name), getattr(other, name)
            assert np.max(np.abs(mine - truth)) < 1e-9 * (1.0 + np.max(np.abs(truth))), (seed, name)
        assert lasting(run) == lasting(other), seed


@pytest.mark.parametrize(
    "make",
    [
        scenes.coulomb_oscillator,
        scenes.stick_slip_belt,
        scenes.mass_on_belt,
        lambda: scenes.mass_on_belt(belt=0.5, mu=0.1, x0=-2.5, v0=0.9),
        scenes.mass_on_shaken_belt,
        scenes.sliding_block,
    ],
)
def test_exact_motions_are_met_to_rounding(make):
    scene = make()
    times = np.linspace(*scene.t_span, 400)
    for keep in (times, 1, "impacts"):
        run = simulate(scene, EventDriven(), keep=keep)
        q, v = run.at(times)
        exact_q, exact_v = scene.exact(times)
        assert np.max(np.abs(q - exact_q)) < 2e-14
        assert np.max(np.abs(v - exact_v)) < 2e-14


def test_the_period_on_the_belt_is_known_to_rounding_after_a_thousand_of_them():
    period = stick_slip_period(0.2, 0.6, 1.0)
    run = simulate(scenes.stick_slip_belt(t_end=1001.0 * period), EventDriven(), keep="impacts")
    slips = run.impacts.time[run.impacts.kind == Kind.SLIP]
    assert np.max(np.abs(slips - 5.0 - period * np.arange(len(slips)))) < 1e-11


def test_impulses_are_the_same_however_states_are_kept():
    scene = scenes.stick_slip_belt(amplitude=0.3)
    sums = [
        np.sum(simulate(scene, EventDriven(), keep=keep).friction_impulse)
        for keep in (1, "impacts", np.linspace(0.0, 40.0, 77))
    ]
    assert np.ptp(sums) < 1e-13


def test_the_belt_does_the_work_that_is_missing():
    run = simulate(scenes.coulomb_oscillator(), EventDriven(), keep=1)
    found = energy(run)
    lost = 0.5 * (1.05**2 - 0.05**2)
    assert found.total[0] - found.total[-1] == pytest.approx(lost, abs=1e-14)


@pytest.mark.parametrize(
    "change",
    [
        {"force": Harmonic([0.0, -1.0], [0.0, 0.1], 0.0, 1.0)},  # a normal force that changes
        {"force": Harmonic([0.0, 1.0])},  # one that pulls
        {"force": Harmonic([0.0, -1.0], [0.1, 0.0], 0.0, 1.0)},  # resonance
        {"K": np.array([[1.0, 0.3], [0.3, 1.0]])},
        {"C": np.diag([3.0, 0.0])},  # overdamped
    ],
)
def test_other_scenes_are_integrated(change):
    scene = scenes.coulomb_oscillator()
    system = LinearSystem(**({"M": np.eye(2), "K": np.diag([1.0, 0.0]), "force": [0.0, -1.0]} | change))
    assert line_of(replace(scene, system=system)) is None
    assert line_of(replace(scene, q0=[1.0, 0.1])) is None


def test_events_beyond_the_bound_end_the_run():
    scene = scenes.stick_slip_belt(t_end=100.0)
    method = EventDriven(max_events=5)
    run = ArcRun(method, scene, Kept.parse(1, scene.t_span), line_of(scene)).finish(lambda t: None)
    assert run.status.name == "TOO_MANY_EVENTS"
    assert "max_events = 5" in run.message
