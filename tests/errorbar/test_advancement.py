"""Conservative advancement of an oscillator above an obstacle: the motion and events of other methods."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, LcpStepError, Located, SimulationInterrupted, simulate
from lcpstep.errorbar import companions, estimate
from lcpstep.errorbar.advance import Advance
from lcpstep.errorbar.advancement import Advancement, _numbers
from lcpstep.errorbar.companions import Companion
from lcpstep.kernels.status import DONE
from lcpstep.model import model
from lcpstep.recording import Kept
from lcpstep.trajectory import Kind, Status
from tests.uncompiled import kernels

NOTHING = Kept(1, False, np.zeros(0))


def advanced(scene, t, progress=lambda _: None, run=Advancement.run):
    return run(Advancement(), scene, Kept(0, False, np.asarray(t)), progress)


def oscillator(offset, **more):
    """q'' = -q with an obstacle below or above."""
    system = LinearSystem(M=[[1.0]], K=[[1.0]])
    contacts = LinearContacts(G=[[-1.0]], offset=[offset], restitution=[0.5])
    return Scene(
        **({"system": system, "contacts": contacts, "q0": 0.0, "v0": 1.0, "t_span": (0.0, 3.0)} | more)
    )


def drawn(seed):
    """An oscillator with numbers over some decades, and whichever restitution, forcing and obstacle."""
    rng = np.random.default_rng(seed)
    M, w, zeta = (
        10.0 ** rng.uniform(-2, 2),
        10.0 ** rng.uniform(-1, 2),
        rng.choice([0.0, rng.uniform(0, 0.9)]),
    )
    G, Omega = (
        rng.choice([-1, 1]) * 10.0 ** rng.uniform(-1, 1),
        rng.choice([0.0, w * 10.0 ** rng.uniform(-1, 1)]),
    )
    force = M * w * w * 10.0 ** rng.uniform(-1, 1) * rng.normal(size=3) * [rng.choice([0, 1]), 1, 1]
    contacts = LinearContacts(G=[[G]], offset=[0.1], restitution=[rng.choice([0.0, rng.uniform(0, 0.95)])])
    start, length = rng.choice([0.0, 100.0]), 2.0 * np.pi / w * rng.uniform(2, 8)
    return Scene(
        system=LinearSystem(
            M=[[M]], C=[[2.0 * zeta * w * M]], K=[[M * w * w]],
            force=Harmonic(constant=force[:1], cosine=force[1:2], sine=force[2:], omega=Omega),
        ),
        contacts=contacts, q0=abs(rng.normal()) * np.sign(G), v0=rng.normal() * w,
        t_span=(start, start + length),
    )  # fmt: skip


def test_the_motion_is_that_in_closed_form():
    scene = scenes.impact_oscillator(t_end=20.0)
    t = np.linspace(0.0, 20.0, 2001)
    run = advanced(scene, t)
    q, v = scene.exact(t)
    assert np.max(np.abs(run.q - q)) < 1e-13
    smooth = np.min(np.abs(t[:, None] - run.impacts.time), axis=1) > 1e-9
    assert np.max(np.abs(run.v - v)[smooth]) < 1e-12


@pytest.mark.parametrize("seed", range(24))
def test_the_motion_of_any_oscillator_is_that_of_exact_steps(seed):
    scene = drawn(seed)
    exact = Located(np.ptp(scene.t_span) / 300.0, "exact").run(scene, NOTHING, lambda _: None)
    other = advanced(scene, np.linspace(*scene.t_span, 400))
    bar = estimate.against(exact, True, [(Companion(Advancement(), seen=True), other)])
    assert not bar.reason
    assert bar.position.sup < 1e-9 * max(1.0, np.max(np.abs(exact.q)))


def test_it_chatters_rests_and_lets_go_with_the_event_driven_run():
    scene = scenes.sticking_oscillator()
    run, other = advanced(scene, [0.0, 100.0]), simulate(scene, EventDriven())
    for kind in (Kind.ACCUMULATION, Kind.STICK, Kind.RELEASE):
        times, known = (x.impacts.time[x.impacts.kind == kind] for x in (run, other))
        assert len(times) > 2
        assert times == pytest.approx(known, abs=1e-10)
    assert run.q[-1] == pytest.approx(other.q[-1], abs=1e-10)


@pytest.mark.parametrize("depth", [1e-6, 1e-10, 1e-13, -1e-13, -1e-10])
def test_no_impact_is_passed_however_shallow(depth):
    run = advanced(oscillator(1.0 - depth), [0.0, 3.0])
    assert len(run.impacts) == (depth > 0.0)
    if depth > 0.0:
        assert run.impacts.time[0] == pytest.approx(math.asin(1.0 - depth), abs=1e-9)
        assert run.impacts.before[0] == pytest.approx(-math.sqrt(2.0 * depth), rel=1e-2)


def test_a_bar_ends_where_the_run_has_missed_an_impact():
    scene = oscillator(1.0 - 1e-3, t_span=(0.0, 20.0))
    free = simulate(replace(scene, contacts=None), EventDriven())
    missed = replace(free, scene=scene)
    bar = estimate.error_bar(missed, True, 0.0)
    assert bar.companions == ("Advancement()",)
    assert 1.3 < bar.until < math.asin(1.0 - 1e-3)
    assert "without partner" in bar.reason


def test_other_scenes_are_refused():
    for scene in (
        scenes.bouncing_ball(),
        scenes.cam_follower(),
        scenes.elastic_gas(),
        scenes.double_pendulum(),
    ):
        with pytest.raises(LcpStepError):
            advanced(scene, scene.t_span)
    overdamped = LinearSystem(M=[[1.0]], C=[[2.0]], K=[[1.0]])
    with pytest.raises(LcpStepError, match="oscillation"):
        advanced(oscillator(0.5, system=overdamped), [0.0, 1.0])


def test_an_interrupt_leaves_what_was_found():
    def stop(_):
        raise KeyboardInterrupt

    scene = scenes.impact_oscillator(t_end=1e6)
    with pytest.raises(SimulationInterrupted) as caught:
        advanced(scene, np.linspace(0.0, 1e6, 1001), stop)
    part = caught.value.trajectory
    assert len(part.impacts) > 1000
    assert 0.0 < part.t[-1] < 1e6


def test_compiled_and_uncompiled_are_the_same_to_the_last_bit():
    scene, t = scenes.sticking_oscillator(), np.linspace(0.0, 60.0, 50)
    numbers, found = _numbers(model(scene), scene) | {"t_end": 60.0}, []
    for made in (Advance, kernels("lcpstep.errorbar").advance.Advance):
        states, log = np.zeros((50, 2)), np.zeros((400, 6))
        assert made(numbers, t, states, log).go_on() == DONE
        found.append(states.tobytes() + log.tobytes())
    assert found[0] == found[1]


def test_a_companion_that_ends_early_leaves_all_states_to_the_next_one(monkeypatch):
    """It keeps those that are looked at alone; the next one has to keep its steps."""

    def half(self, scene, kept, progress):
        start, end = scene.t_span
        known = kept.times[kept.times < 0.5 * (start + end)]
        return replace(advanced(scene, known), status=Status.INTERRUPTED)

    def refuse(scene):
        raise LcpStepError("no exact steps")

    monkeypatch.setattr(Advancement, "run", half)
    monkeypatch.setattr(companions, "require_exact", refuse)
    run = simulate(scenes.sticking_oscillator(t_end=30.0), EventDriven(1e-6, 1e-6), error=True)
    assert run.error.until == 30.0
    assert run.error.companions[0].startswith("EventDriven")
