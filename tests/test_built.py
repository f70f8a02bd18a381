"""Functions of ready scenes built ahead of time: the same numbers as compiled when they are used, and no numba."""

from types import FunctionType

import numpy as np
import pytest

from lagrangian import profiles, scenes
from lagrangian.scenes import pendulum
from lcpstep.callbacks import built, compiling
from lcpstep.kernels.function import Function
from lcpstep.kernels.model import shapes
from tests.marks import compiled_only
from tests.processes import python

SCENES = [name for name, entry in scenes.CATALOGUE.items() if entry.make().n_q < 10]


def functions(scene):
    """Name, function, shape and number of arguments of what a scene is made of."""
    n_q, n_c, n_j = scene.n_q, scene.n_c, scene.n_j
    for part, n in ((scene.system, n_c), (scene.contacts, n_c), (scene.joints, n_j)):
        for name, f in (vars(part) if part is not None else {}).items():
            if isinstance(f, FunctionType) and name in shapes(n_q, n):
                yield f, shapes(n_q, n)[name]


@compiled_only
@pytest.mark.parametrize("name", SCENES)
def test_what_is_built_gives_the_numbers_of_what_is_compiled_to_the_last_bit(name, monkeypatch):
    scene = scenes.CATALOGUE[name].make()
    p, n, rng = np.array(scene.p), scene.n_q, np.random.default_rng(0)
    for f, shape in functions(scene):
        address = built.address(f)
        if address == 0:
            continue
        monkeypatch.setattr(compiling.built, "address", lambda f: 0)
        compiled = Function(compiling.address(f, len(shape)), p, n, n, shape)
        monkeypatch.undo()
        times = rng.uniform(0.0, 3.0, 50)
        for _ in range(5):
            out = np.zeros((2, len(times), *shape))
            q, v = rng.normal(size=(2, n))
            Function(address, p, n, n, shape).sample(times, q, v, out[0])
            compiled.sample(times, q, v, out[1])
            np.testing.assert_array_equal(*out)


def functions_with_modes(scene):
    """Fields, guards, resets and surfaces of a system with modes, and how many numbers each fills in."""
    for mode in scene.system.modes.values():
        yield mode.field, scene.system.n_x
        for guard in mode.guards:
            yield guard.value, 1
            if guard.reset is not None:
                yield guard.reset, scene.system.n_x
    yield from ((surface.value, 1) for surface in scene.system.surfaces)


@compiled_only
@pytest.mark.parametrize("model", ["slip", "constant", "full", None])
def test_what_is_built_of_systems_with_modes_gives_the_numbers_of_python(model):
    made = [e.make() for n, e in scenes.WITH_MODES.items() if n != "hybrid-abs"]
    rng = np.random.default_rng(1)
    for scene in made if model is None else [scenes.hybrid_abs(model=model)]:
        p, n = np.array(scene.p), scene.system.n_x
        for f, size in functions_with_modes(scene):
            assert built.address(f), f
            x, out, mine = rng.uniform(0.1, 2.0, n), np.zeros((1, size)), np.zeros(size)
            Function(built.address(f), p, n, 0, (size,)).sample(np.array([0.3]), x, np.zeros(0), out)
            f(0.3, x, p, mine)
            np.testing.assert_allclose(out[0], mine, rtol=1e-15, atol=0)


@pytest.mark.parametrize("name", list(scenes.CATALOGUE))
def test_every_function_of_the_ready_scenes_is_built(name):
    for f, _ in functions(scenes.CATALOGUE[name].make()):
        assert built.address(f), f


def test_a_function_whose_helper_has_changed_is_not_taken_for_the_one_that_was_built(monkeypatch):
    field = scenes.hybrid_abs().system.modes["0"].field
    assert built.address(field)
    monkeypatch.setitem(field.__globals__, "friction", lambda slip, p: 0.0)  # of a helper of a helper
    assert not built.address(field)


def test_functions_of_the_ready_scenes_are_built():
    assert built.address(profiles.rotating_cam)
    assert built.address(pendulum.pendulum_force)
    assert len(built.FUNCTIONS) > 25


def test_a_function_that_has_changed_is_not_taken_for_the_one_that_was_built(monkeypatch):
    def other(t, q, v, p, out):
        out[0] = -p[0]

    other.__module__, other.__name__ = pendulum.__name__, "pendulum_force"
    assert not built.address(other)
    monkeypatch.setattr(profiles, "HEAD", 6)
    assert not built.address(profiles.rotating_cam)


def test_only_what_was_given_is_read():
    """A cam of a hundred arcs that has the numbers of four: what it would read beyond them is not a number."""
    p = profiles.CamProfile((profiles.Arc(np.pi, 0.0, 0.0, 1.0),)).pack(1.0, 0.0)
    p[4], p[5] = 100.0, -1.0
    f = Function(built.address(profiles.rotating_cam), p, 1, 1, (1, 3))
    out = np.zeros((1, 1, 3))
    f.sample(np.array([0.5]), np.zeros(1), np.zeros(1), out)
    assert np.isnan(out).any()


def test_a_run_of_a_ready_scene_needs_no_numba():
    program = (
        "import sys; from lagrangian import scenes; from lcpstep import EventDriven, simulate; "
        "run = simulate(scenes.cam_follower(), EventDriven()); print(len(run.impacts), 'numba' in sys.modules)"
    )
    assert python(program).split()[-1] == "False"
