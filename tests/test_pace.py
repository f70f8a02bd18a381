"""Portions of compiled loops: they take the time that is wanted, and no result depends on them."""

import itertools
import threading

import numpy as np
import pytest

from lagrangian import LinearSystem, Scene, scenes
from lcpstep import EventDriven, Located, Moreau, pace, simulate
from lcpstep.events.hybrid.many import Follower
from lcpstep.maps import periods

SIZES = (1, 2, 7, 3, 1, 1, 19, 5, 64)


@pytest.fixture
def small_portions(monkeypatch):
    """Portions of a few steps, of sizes that change."""
    sizes = itertools.cycle(SIZES)
    monkeypatch.setattr(pace.Pace, "goal", lambda self, done: done + next(sizes))


def bits(run):
    """All that a run computed, to be compared to the last bit."""
    arrays = [
        run.t,
        run.q,
        run.v,
        run.impulse,
        *(np.asarray(run.impacts[name]) for name in run.impacts.dtype.names),
    ]
    return [a.tobytes() for a in arrays]


CAM = scenes.cam_follower(rpm=660.0, t_end=0.3)
GAS = scenes.falling_gas(t_end=0.5)
SCENES = [
    (CAM, Moreau(1e-4)),
    (CAM, Moreau(1e-3, tolerance=1e-4)),
    (CAM, Located(1e-3)),
    (CAM, Located(1e-2, tolerance=1e-5)),
    (CAM, Located(1e-3, order=4)),
    (CAM, EventDriven()),
    (scenes.bouncing_ball(t_end=4.0), Moreau(1e-3)),
    (scenes.bouncing_ball(t_end=4.0), Located(1e-2)),
    (scenes.bouncing_ball(t_end=4.0), EventDriven()),
    (scenes.double_pendulum(t_end=0.5), Moreau(1e-3)),
    (scenes.double_pendulum(t_end=0.5), EventDriven()),
    (GAS, Moreau(1e-3)),
    (GAS, Located(1e-2)),
    (GAS, EventDriven()),
]


@pytest.mark.parametrize("keep", [1, 3, "impacts"])
@pytest.mark.parametrize(("scene", "method"), SCENES, ids=lambda x: getattr(x, "name", repr(x)))
def test_no_result_depends_on_the_portions(scene, method, keep, request):
    whole = bits(simulate(scene, method, keep=keep))
    request.getfixturevalue("small_portions")
    assert bits(simulate(scene, method, keep=keep)) == whole


@pytest.mark.parametrize("method", [EventDriven(), Moreau(1e-4), Located(1e-3)])
def test_no_map_depends_on_the_portions(method, request):
    starts = [[0.0, 0.0], [0.01, -1.0], [0.2, 0.5]]
    whole = periods(CAM, method, starts, 40, drop=25)
    request.getfixturevalue("small_portions")
    found = periods(CAM, method, starts, 40, drop=25)
    for name, value in vars(whole).items():
        assert getattr(found, name).tobytes() == value.tobytes(), name


def test_a_cycle_that_ends_the_transient_is_found_in_small_portions_too(request):
    scene = scenes.cam_follower(rpm=700.0)
    whole = periods(scene, EventDriven(), [0.0, 0.0], 2000, drop=1990)
    request.getfixturevalue("small_portions")
    found = periods(scene, EventDriven(), [0.0, 0.0], 2000, drop=1990)
    assert found.states.tobytes() == whole.states.tobytes()


def test_no_hybrid_run_depends_on_the_portions(request):
    scene = scenes.hybrid_abs(t_end=0.4)

    def found():
        run = simulate(scene, EventDriven())
        end = Follower(scene, EventDriven(), 0.2, 100)(scene.x0, scene.mode)
        return [x.tobytes() for x in (run.t, run.x, run.switches.time, end.x, end.times)]

    whole = found()
    request.getfixturevalue("small_portions")
    assert found() == whole


def test_portions_grow_to_the_time_that_is_wanted(monkeypatch):
    now = [1.0]
    monkeypatch.setattr(pace.time, "perf_counter", lambda: now[0])
    steady, done = pace.Pace(10**9), 0
    for _ in range(12):
        goal = steady.goal(done)
        now[0] += 1e-5 * (goal - done)
        done = goal
    assert steady.goal(done) - done == pytest.approx(pace.SECONDS / 1e-5, abs=1)
    now[0] += 100.0  # something else took the time: the compiler, or another process
    assert 1 <= steady.goal(done + 1) - done - 1 < 10


def test_a_portion_is_no_longer_than_the_buffers_and_short_where_a_step_is_large():
    fast = pace.Pace(64)
    assert [fast.goal(64 * k) - 64 * k for k in range(4)] == [64] * 4
    assert pace.Pace(4096, 100).goal(0) == pace.FIRST // 100
    assert pace.Pace(4096, 10**6).goal(0) == 1


def test_work_that_is_given_up_ends():
    event = threading.Event()
    scene = Scene(LinearSystem(M=1.0, K=1.0), 1.0, 0.0, (0.0, 1e3))

    def stop(t):
        event.set()

    with pytest.raises(KeyboardInterrupt):
        pace.until_given_up(event, lambda: simulate(scene, Moreau(1e-4), keep="impacts", progress=stop))
    assert not pace.given_up()
    assert simulate(scene, Moreau(1.0)).status.name == "DONE"
