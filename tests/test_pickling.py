"""Scenes, methods, trajectories and errors go to other processes and come back the same."""

import copy
import multiprocessing
import pickle
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from lagrangian import Contacts, Guard, LinearContacts, LinearSystem, Mode, Scene, System, scenes
from lagrangian.hybrid import HybridScene, HybridSystem
from lagrangian.scenes import CATALOGUE
from lagrangian.scenes.hybrid_oscillators import (
    bilinear_oscillator,
)
from lcpstep import EventDriven, LcpStepError, Located, Moreau, SimulationError, errors, simulate

HYBRIDS = [entry.make for entry in scenes.WITH_MODES.values()]
METHODS = [
    Moreau(0.01), Moreau(0.01, tolerance=1e-3), Located(0.01), Located(0.01, order=4), Located(0.01, order="exact"),
    EventDriven(1e-8, 1e-8),
]  # fmt: skip


def again(x):
    return pickle.loads(pickle.dumps(x))


def same(a, b):
    return all(np.array_equal(x, y) for x, y in zip(a, b, strict=True))


@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("way", [again, copy.deepcopy])
def test_every_ready_scene(name, way):
    scene = CATALOGUE[name].make()
    other = way(scene)
    assert same((scene.q0, scene.v0, scene.p, scene.corners), (other.q0, other.v0, other.p, other.corners))
    assert dict(other.parameters) == dict(scene.parameters)
    assert not any(x.flags.writeable for x in (other.q0, other.v0, other.p, other.corners))
    assert (other.exact is None) == (scene.exact is None)
    if scene.exact is not None:
        times = np.linspace(*scene.t_span, 5)
        assert same(other.exact(times), scene.exact(times))
    assert len(pickle.dumps(scene)) < 200_000


@pytest.mark.parametrize("make", HYBRIDS)
@pytest.mark.parametrize("way", [again, copy.deepcopy])
def test_every_ready_scene_with_modes(make, way):
    scene = make()
    other = way(scene)
    assert (other.mode, other.t_span, other.system.names) == (scene.mode, scene.t_span, scene.system.names)
    assert np.array_equal(other.x0, scene.x0)
    if scene.exact is not None:
        times = np.linspace(*scene.t_span, 5)
        assert np.array_equal(other.exact(times), scene.exact(times))


def asked(run):
    """What is asked of a run in another process: states between the kept ones, and the same run anew."""
    times = np.linspace(run.t[0], run.t[-1], 7)
    between, anew = run.at(times), simulate(run.scene, run.method)
    states = (anew.x,) if hasattr(anew, "x") else (anew.q, anew.v)
    return (between if isinstance(between, tuple) else (between,)), states


def sample():
    """Runs of every kind of smooth motion."""
    short = {"t_end": 0.3}
    ball, general = scenes.bouncing_ball(h0=0.1, **short), scenes.pendulum_stop(**short)
    several, stepped = scenes.newtons_cradle(**short), scenes.double_pendulum(**short)
    yield from ((ball, method) for method in METHODS)
    yield from (
        (x, EventDriven(1e-8, 1e-8)) for x in (general, several, stepped, bilinear_oscillator(t_end=3.0))
    )


@pytest.mark.slow
def test_trajectories_in_a_process_started_afresh():
    runs = [simulate(scene, method) for scene, method in sample()]
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        for run, (between, anew) in zip(runs, pool.map(asked, runs), strict=True):
            mine = asked(run)
            assert same(between, mine[0])
            assert same(anew, mine[1])


@pytest.mark.parametrize("way", [again, copy.deepcopy])
def test_a_trajectory_carries_what_it_is_asked_for_and_little_more(way):
    for scene, method in sample():
        run = simulate(scene, method)
        other = way(run)
        assert same(asked(other)[0], asked(run)[0])
        assert other.status is run.status
        assert np.array_equal(other.impacts if hasattr(run, "impacts") else other.switches,
                              run.impacts if hasattr(run, "impacts") else run.switches)  # fmt: skip
    ball = simulate(scenes.bouncing_ball(), Moreau(1e-3))
    arrays = sum(x.nbytes for x in (ball.t, ball.q, ball.v, ball.impulse, ball.impacts))
    assert len(pickle.dumps(ball)) < arrays + 10_000


@pytest.mark.slow
@pytest.mark.parametrize("name", [x for x in CATALOGUE if x != "block-on-feet"])
def test_every_ready_scene_by_every_method(name):
    scene = CATALOGUE[name].make()
    start, end = scene.t_span
    scene = replace(scene, t_span=(start, start + min(0.3, 0.25 * (end - start))))
    for method in METHODS:
        try:
            run = simulate(scene, method)
        except LcpStepError:  # the method does not treat the scene
            continue
        if run.status.name == "DONE":
            assert same(asked(again(run))[0], asked(run)[0])


def test_methods_are_equal_afterwards():
    for method in METHODS:
        assert again(method) == copy.deepcopy(method) == method


@pytest.mark.parametrize(
    "error",
    [
        errors.UnknownName("scene", "bal", ["ball"]),
        errors.NotWritten("a.nc", OSError(28, "No space left on device")),
        errors.StudyInterrupted(["a study"]),
        SimulationError("failed", ["a motion"]),
        errors.SimulationInterrupted(lambda: ["a motion"]),
    ],
    ids=lambda e: type(e).__name__,
)
def test_errors_keep_their_words_and_what_they_carry(error):
    other = again(error)
    assert type(other) is type(error)
    assert str(other) == str(error)
    assert vars(other) == vars(error)


# --- functions that no other process finds


def fall(t, q, v, p, out):
    out[0] = -9.81


def local(value=-9.81, slope=0.0):
    def inside(t, q, v, p, out):
        out[0] = value + slope * q[0]

    return inside


def rise(t, x, p, out):
    out[0] = 1.0


def scene(force=fall, **more):
    return Scene(System(1, 1.0, force), q0=1.0, v0=0.0, t_span=(0.0, 1.0), **more)


UNNAMED = {
    r"System\.force: 'local\.<locals>\.inside'": lambda: scene(local()),
    r"LinearSystem\.force: .*<lambda>": lambda: Scene(
        LinearSystem(1.0, force=lambda t, q, v, p, out: out.fill(0.0)), 1.0, 0.0, (0.0, 1.0)
    ),
    r"Contacts\.gap: 'local\.<locals>\.inside'": lambda: scene(contacts=Contacts(1, local(0.0, 1.0), unit)),
    r"LinearContacts\.motion: .*<lambda>": lambda: scene(
        contacts=LinearContacts(1.0, motion=lambda t, q, v, p, out: out.fill(0.0))
    ),
    r"Scene\.exact: .*<lambda>": lambda: scene(
        exact=lambda t: (1.0 - 4.905 * t[:, None] ** 2, -9.81 * t[:, None])
    ),
    r"Guard\.value: .*<lambda>": lambda: HybridScene(
        HybridSystem(1, {"a": Mode(rise, [Guard(lambda t, x, p, out: out.fill(-1.0), "a")])}), 0.0, "a", (0.0, 1.0)
    ),
}  # fmt: skip


def unit(t, q, v, p, out):
    out[0, 0] = 1.0


@pytest.mark.parametrize("said", UNNAMED)
def test_a_function_without_a_name_is_named_with_its_place(said):
    made = UNNAMED[said]()
    with pytest.raises(pickle.PicklingError, match=said) as caught:
        pickle.dumps(made)
    assert f"{__file__}, line" in str(caught.value)
    assert "top of a module" in str(caught.value)


def test_a_partial_of_a_function_without_a_name_is_named_too():
    made = scene(exact=partial(lambda t, g: (1.0 - 0.5 * g * t[:, None] ** 2, -g * t[:, None]), g=9.81))
    with pytest.raises(pickle.PicklingError, match=r"Scene\.exact"):
        pickle.dumps(made)


def test_those_who_take_functions_along_still_do():
    made = scene(local())
    assert copy.deepcopy(made).system.force is made.system.force
    assert copy.copy(made).system.force is made.system.force
    cloudpickle = pytest.importorskip("cloudpickle")
    other = pickle.loads(cloudpickle.dumps(made))
    assert simulate(other, Moreau(0.1)).q[-1] == simulate(made, Moreau(0.1)).q[-1]
    with pytest.raises(pickle.PicklingError):
        pickle.dumps(made)


def derived_end(scene):
    import sys

    return simulate(scene, Moreau(0.1)).q[-1], "sympy" in sys.modules


@pytest.mark.slow
def test_a_derived_scene_goes_to_a_process_without_sympy():
    sympy = pytest.importorskip("sympy")
    from lagrangian.symbolic import derive

    x = sympy.Function("x")(sympy.Symbol("t"))
    v = x.diff(sympy.Symbol("t"))
    made = derive(v**2 / 2 - 1.625 * x, x).scene([0.0], [0.0], (0.0, 1.0))
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        end, loaded = pool.apply(derived_end, (made,))
    assert end == simulate(made, Moreau(0.1)).q[-1]
    assert not loaded
