"""What a bar costs: companions that are good enough, states kept on the way, and no run for nothing."""

import cProfile
import pstats
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge.draw import draw
from lagrangian import Scene, scenes
from lagrangian.scenes import CATALOGUE
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.errorbar import companions, estimate
from lcpstep.errorbar.advancement import Advancement
from lcpstep.errorbar.wide import BETWEEN, narrowed, widened
from lcpstep.recording import Kept
from lcpstep.stepping.pieces.run import Again
from tests.marks import slow


class Asked:
    """Runs that are made, by method."""

    def __init__(self, monkeypatch):
        self.of = []
        for kind in (Located, EventDriven, Advancement):
            monkeypatch.setattr(kind, "run", self.noted(kind.run))

    def noted(self, run):
        def noted(method, *question):
            self.of.append(method)
            return run(method, *question)

        return noted


ALL = Kept(1, False, np.zeros(0))
DEAR = (
    Located(2e-3, 4),
    Located(5e-3, "exact"),
    Located(1e-2, tolerance=1e-4),
    Located(1e-2, 4, tolerance=1e-6),
)


LONG = "elastic-chain", "block-on-feet", "falling-gas", "elastic-ball", "elastic-gas"


@pytest.mark.parametrize("name", slow(CATALOGUE, *LONG, longest=["stack", "column"]))
def test_states_between_steps_change_nothing_of_a_run(name):
    scene = CATALOGUE[name].make()
    if not isinstance(scene, Scene):
        pytest.skip("modes")
    start, end = scene.t_span
    scene = replace(scene, t_span=(start, start + 0.2 * (end - start)))
    for method in DEAR:
        method = replace(method, h=min(method.h, 4e-5 * (end - start)))
        kept = widened(method, scene, ALL)
        if kept is ALL or (method.order == "exact" and not companions.in_closed_form(scene)):
            continue
        run, wide = (method.run(scene, k, lambda _: None) for k in (ALL, kept))
        same = narrowed(wide, kept)
        assert len(wide.t) >= len(run.t) + 0.9 * BETWEEN
        for x in ("t", "q", "v", "impacts", "counts", "status"):
            assert np.array_equal(getattr(same, x), getattr(run, x)), x
        assert np.allclose(
            same.impulse, run.impulse, rtol=1e-10, atol=1e-12 * np.max(run.impulse, initial=0.0)
        )
        assert isinstance(run.dense, Again)


@pytest.mark.parametrize(
    ("scene", "method", "runs"),
    [
        (scenes.impact_oscillator(t_end=20.0), Located(4e-3, 4), 2),  # none for states between steps
        (scenes.impact_oscillator(t_end=20.0), EventDriven(), 2),
        (scenes.bouncing_ball(t_end=2.0), Located(1e-2), 2),  # one companion is enough in closed form
        (scenes.double_pendulum(t_end=2.5), Located(5e-4, 4), 2),
    ],
    ids=str,
)
def test_a_bar_takes_one_run_besides(monkeypatch, scene, method, runs):
    asked = Asked(monkeypatch)
    error = simulate(scene, method, error=True).error
    assert (error.until, len(asked.of)) == (scene.t_span[1], runs)


def test_the_bar_of_a_long_run_that_ends_early_takes_a_companion_over_a_part_alone(monkeypatch):
    scene, ends = scenes.rocking_block(t_end=100.0), []
    run = simulate(scene, Moreau(5e-3))
    monkeypatch.setattr(estimate, "MANY_STEPS", 10**9)
    whole = estimate.error_bar(run, True, 0.0)
    monkeypatch.setattr(estimate, "MANY_STEPS", 10_000)
    original = EventDriven.run

    def noted(self, scene, *more):
        ends.append(scene.t_span[1])
        return original(self, scene, *more)

    monkeypatch.setattr(EventDriven, "run", noted)
    soon = estimate.error_bar(run, True, 0.0)
    assert soon.reason
    assert whole.until == pytest.approx(soon.until, rel=0.1)
    assert max(ends) == pytest.approx(estimate.PART * 100.0)


def calls(work):
    """Functions called in Python or C, whose number the load of a machine does not change."""
    work()
    profile = cProfile.Profile()
    profile.runcall(work)
    return pstats.Stats(profile).total_calls


@pytest.mark.parametrize(
    ("scene", "method", "most"),
    [
        (scenes.bouncing_ball(t_end=1.0), Moreau(1e-3), 900),
        (scenes.bouncing_ball(t_end=1.0), EventDriven(), 1150),
        (scenes.newtons_cradle(t_end=0.5), Located(1e-3), 800),
        (scenes.cam_follower(rpm=358.0, t_end=1.0), Moreau(1e-3), 1500),
    ],
    ids=str,
)
def test_the_bar_of_a_short_run_is_a_companion_and_few_calls(scene, method, most):
    alone, both = (calls(lambda error=error: simulate(scene, method, error=error)) for error in (False, True))
    assert both - alone < most


def test_looks_are_as_many_as_tell_the_error():
    scene = scenes.impact_oscillator(t_end=20.0)
    t = np.linspace(0.0, 20.0, 20_001)
    for h in (2e-2, 1e-3):
        run = simulate(scene, Located(h), error=True)
        true = np.abs(run.at(t)[0] - scene.exact(t)[0])
        assert run.error.position.sup == pytest.approx(np.max(true), rel=0.05)
        assert run.error.position.l1 == pytest.approx(np.trapezoid(true[:, 0], t), rel=0.05)


def test_what_happens_at_the_start_alone_adds_nothing_to_the_integrals():
    """Beads that come to rest against each other at once, by many impacts: other ones in the companion."""
    d = draw(270623, 20)
    run = simulate(d.scene(), Located(d.length / 5000.0, 4), error=True)
    assert run.error.velocity.l1 < 1e-9


@pytest.mark.parametrize("method", [Located(5e-2), EventDriven(), Located(1e-1, 4)], ids=str)
def test_of_many_events_a_part_tells_the_integrals(method, monkeypatch):
    scene = scenes.elastic_ball(t_end=2000.0)
    whole = simulate(replace(scene, q0=1.0 + 1e-7), method)
    few = estimate.against(
        whole, True, [(companions.Companion(EventDriven()), simulate(scene, EventDriven()))]
    )
    monkeypatch.setattr("lcpstep.errorbar.looks.MANY", 10**6)
    monkeypatch.setattr("lcpstep.errorbar.distance.MANY", 10**6)
    all_of_them = estimate.against(
        whole, True, [(companions.Companion(EventDriven()), simulate(scene, EventDriven()))]
    )
    assert len(few.t) < len(all_of_them.t)
    assert few.velocity.l1 == pytest.approx(all_of_them.velocity.l1, rel=0.25)
    assert few.position.l1 == pytest.approx(all_of_them.position.l1, rel=0.25)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
def test_hops_that_are_no_longer_followed_are_in_the_bar_of_many_events(tolerance):
    """Where chattering ends, the run keeps to the table, and the motion hops on for a few microseconds."""
    scene = replace(scenes.chattering_table(), t_span=(0.0, 40.0))
    run = simulate(scene, EventDriven(tolerance, tolerance), error=True)
    true = simulate(scene, EventDriven(1e-13, 1e-13))
    t = np.unique(np.concatenate([true.impacts.time, np.linspace(0.0, 40.0, 4001)]))
    t = np.sort(np.concatenate([t, 0.5 * (t[1:] + t[:-1])]))
    error = np.max(np.abs(run.at(t)[0] - true.at(t)[0]))
    assert len(run.impacts) > 1000
    assert 0.5 * error < np.max(run.error.position.largest) < 2.0 * error
