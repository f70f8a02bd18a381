"""Ctrl-C in runs: heard once, by whatever is at work, and the motion so far is handed over."""

import math
import signal
import threading
import time
import warnings
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, Scene, System, scenes
from lcpstep import EventDriven, Located, Moreau, SimulationInterrupted, Status, simulate, simulation
from lcpstep.doubts import finished
from lcpstep.maps import periods
from lcpstep.model import UncompiledCallback
from lcpstep.pace import Pace
from lcpstep.recording import Recorder
from tests.marks import compiled_only
from tests.stepping.test_sparse import column


class StopAt:
    """Progress callback that interrupts after a number of calls."""

    def __init__(self, calls):
        self.left, self.times = calls, []

    def __call__(self, t):
        self.times.append(t)
        self.left -= 1
        if self.left <= 0:
            raise KeyboardInterrupt


@pytest.mark.parametrize(
    ("scene", "method"),
    [
        (scenes.impact_oscillator(t_end=100.0), Moreau(1e-4)),
        (scenes.bouncing_ball(restitution=1.0, t_end=1e5), EventDriven()),
        (scenes.impact_oscillator(t_end=1e5), EventDriven()),
    ],
)
@pytest.mark.parametrize("keep", [1, 100, "impacts"])
def test_an_interrupt_hands_over_the_motion_so_far(scene, method, keep):
    stop = StopAt(3)
    with pytest.raises(SimulationInterrupted) as caught:
        simulate(scene, method, keep=keep, progress=stop)
    assert isinstance(caught.value, KeyboardInterrupt)
    m = caught.value.trajectory
    assert m.status is Status.INTERRUPTED
    assert "interrupted" in m.message
    assert len(stop.times) == 3
    assert m.t[-1] == pytest.approx(stop.times[-1], rel=1e-12)
    assert 0.0 < m.t[-1] < scene.t_span[1]
    whole = simulate(scene, method, keep=[m.t[-1] / 2, float(m.t[-1])])
    np.testing.assert_allclose(m.q[-1], whole.q[-1], rtol=0, atol=1e-9)
    known = m.impacts.time <= m.t[-1]
    np.testing.assert_array_equal(m.impacts[known], whole.impacts[: np.count_nonzero(known)])


@pytest.mark.parametrize("method", [Moreau(1e-3), EventDriven()], ids=["moreau", "event-driven"])
def test_an_interrupt_while_a_trajectory_is_put_together_loses_nothing(method, monkeypatch):
    states, scene = Recorder.states, scenes.bouncing_ball()
    whole, calls = simulate(scene, method), []

    def hit(self):
        calls.append(self)
        if len(calls) == 1:
            raise KeyboardInterrupt
        return states(self)

    monkeypatch.setattr(Recorder, "states", hit)
    with pytest.raises(SimulationInterrupted) as caught:
        simulate(scene, method)
    np.testing.assert_array_equal(caught.value.trajectory.t, whole.t)


@pytest.mark.parametrize(
    ("of", "look"),
    [
        (simulation, "_compare_derivatives"), (simulation, "warn_of_fast_gaps"),
        (finished, "_of_obstacles"), (finished, "too_deep"), (finished, "unresolved"),
    ],
)  # fmt: skip
def test_an_interrupt_while_a_finished_run_is_looked_over_loses_nothing(of, look, monkeypatch):
    scene = scenes.double_pendulum(t_end=0.1)
    whole = simulate(scene, EventDriven())

    def hit(run):
        raise KeyboardInterrupt

    monkeypatch.setattr(of, look, hit)
    with pytest.raises(SimulationInterrupted) as caught:
        simulate(scene, EventDriven())
    kept = caught.value.trajectory
    np.testing.assert_array_equal(kept.q, whole.q)
    assert kept.status == Status.DONE
    assert "interrupted before" in kept.message


WAYS = {
    "moreau": (Moreau(1e-3), scenes.bouncing_ball),
    "moreau by a tolerance": (Moreau(1e-3, tolerance=1e-3), scenes.bouncing_ball),
    "located": (Located(1e-3), scenes.bouncing_ball),
    "located, order 4": (Located(1e-3, order=4), scenes.bouncing_ball),
    "located by a tolerance": (Located(1e-3, tolerance=1e-6), scenes.bouncing_ball),
    "located, friction": (Located(1e-2), scenes.mass_on_belt),
    "sparse": (Moreau(1e-3), lambda: column(210, drop=0.1)),
    "closed form": (EventDriven(), scenes.bouncing_ball),
    "general": (EventDriven(), scenes.double_pendulum),
    "friction": (EventDriven(), scenes.mass_on_belt),
}


@pytest.mark.parametrize("keep", [1, "impacts", [0.05, 0.08]], ids=str)
@pytest.mark.parametrize("way", WAYS)
def test_an_interrupt_before_the_first_step_leaves_the_start(way, keep, monkeypatch):
    (method, make), hits = WAYS[way], []

    def hit(self, done):
        hits.append(done)
        raise KeyboardInterrupt

    scene = make()
    monkeypatch.setattr(Pace, "goal", hit)
    with pytest.raises(SimulationInterrupted) as caught:
        simulate(scene, method, keep=keep)
    run = caught.value.trajectory
    assert run.status == Status.INTERRUPTED
    assert hits == [0]
    if not isinstance(keep, list):
        np.testing.assert_array_equal(run.t, [0.0])
        np.testing.assert_array_equal(run.q, [scene.q0])
        np.testing.assert_array_equal(run.v, [scene.v0])
    assert len(run.impulse) == len(run.t)


@pytest.mark.parametrize("which", ["force", "gap", "jacobian"])
@pytest.mark.parametrize(
    "method",
    [
        Located(1e-2, tolerance=1e-6),
        Located(1e-2, order=4, tolerance=1e-6),
        Moreau(1e-2),
        EventDriven(1e-9, 1e-9),
    ],
    ids=["located", "order four", "moreau", "event-driven"],
)
def test_an_interrupt_that_a_callback_hears_is_the_last_of_its_run(which, method):
    """Attempts that the control takes back had taken the interrupt back with them."""
    calls = {"force": 0, "gap": 0, "jacobian": 0}
    first, after = [0], []

    def called(name):
        calls[name] += 1
        if after:
            after.append(name)
        elif name == which and calls[name] == first[0]:
            after.append("interrupt")
            raise KeyboardInterrupt

    def force(t, q, v, p, out):
        called("force")
        out[0] = -9.81

    def gap(t, q, v, p, out):
        called("gap")
        out[0] = q[0]

    def jacobian(t, q, v, p, out):
        called("jacobian")
        out[0, 0] = 1.0

    contacts = Contacts(1, gap, jacobian, restitution=0.8)
    scene = Scene(System(1, 1.0, force), 1.0, 0.0, (0.0, 3.0), contacts=contacts)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UncompiledCallback)
        for number in (30, 75, 151):
            first[0] = calls[which] + number
            after.clear()
            with pytest.raises(SimulationInterrupted):
                simulate(scene, method)
            assert after == ["interrupt"]


@compiled_only
def test_an_interrupt_is_heard_once():
    """Not again by maps that follow, in which no run is begun."""
    heard = []

    def force(t, q, v, p, out):
        out[0] = -9.81
        if t > 0.1 and not heard:
            heard.append(t)
            raise KeyboardInterrupt

    with pytest.warns(UncompiledCallback), pytest.raises(SimulationInterrupted):
        simulate(Scene(System(1, 1.0, force), 1.0, 0.0, (0.0, 1.0)), Moreau(1e-2))
    cam = scenes.cam_follower(rpm=700.0)
    found = periods(cam, Moreau(1e-4), np.array([[1.33, -66.2]]), 1)
    assert np.all(np.isfinite(found.states))


@pytest.mark.parametrize("method", [Located(1e-3), EventDriven(1e-9, 1e-9)], ids=["located", "event-driven"])
def test_an_interrupt_between_c_and_a_function_in_python_is_heard(method):
    """It was dropped there, more often than not, and with it what the function had answered."""
    stiffness = {"k": 1.0}

    def force(t, q, v, p, out):
        out[0] = math.cos(1.7 * t) - stiffness["k"] * q[0]

    contacts = LinearContacts(G=[[1.0], [-1.0]], offset=[0.3, 0.9], restitution=0.6)
    scene = Scene(System(1, 1.0, force), 0.1, 0.0, (0.0, 2e3), contacts=contacts)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UncompiledCallback)
        whole = simulate(replace(scene, t_span=(0.0, 50.0)), method)
        for k in range(8):
            late = threading.Timer(0.05 + 0.01 * k, signal.raise_signal, (signal.SIGINT,))
            began = []

            def start(_, late=late, began=began):
                if (
                    not began
                ):  # nobody would hear it before the run is under way, which a busy machine may put off
                    began.append(time.perf_counter())
                    late.start()

            with pytest.raises(SimulationInterrupted) as caught:
                simulate(scene, method, progress=start)
            assert time.perf_counter() - began[0] < 5.0
            found = caught.value.trajectory
            seen = found.t < 40.0
            np.testing.assert_allclose(found.q[seen], whole.at(found.t[seen])[0], atol=1e-5)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
