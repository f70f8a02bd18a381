"""The kernels of Moreau's steps as the plain Python that they are: the same motions, to the last bit."""

import numpy as np
import pytest

from lagrangian import scenes
from lcpstep import Moreau, model, simulate
from lcpstep.doubts import normals, room, sides
from lcpstep.kernels import looks, outrun, record, states, surplus, turned
from lcpstep.stepping import moreau_run
from tests.marks import slow
from tests.uncompiled import kernels

STEPS = 40
plain = kernels()


@pytest.fixture
def uncompiled(monkeypatch):
    """A function after which runs of `Moreau` take uncompiled kernels."""

    def start():
        monkeypatch.setattr(model, "kernels", plain.model)
        monkeypatch.setattr(model, "Coefficients", plain.coefficients.Coefficients)
        monkeypatch.setattr(model, "_empty", model._empty.__wrapped__)
        monkeypatch.setattr(room, "gaps_at", plain.states.gaps_at)
        monkeypatch.setattr(normals, "gradients_at", plain.states.gradients_at)
        for module in (states, sides):
            monkeypatch.setattr(module, "gaps_at", plain.states.gaps_at)
            monkeypatch.setattr(module, "gradients_at", plain.states.gradients_at)
        monkeypatch.setattr(states, "power", plain.states.power)
        for name in ("at_most", "highest", "lies_inside"):
            monkeypatch.setattr(looks, name, getattr(plain.looks, name))
        monkeypatch.setattr(room, "lies_inside", plain.looks.lies_inside)
        monkeypatch.setattr(surplus, "surplus", plain.surplus.surplus)
        monkeypatch.setattr(turned, "farthest_turn", plain.turned.farthest_turn)
        monkeypatch.setattr(outrun, "steepest", plain.outrun.steepest)
        monkeypatch.setattr(record, "Record", plain.record.Record)
        monkeypatch.setattr(moreau_run, "loop", plain.theta_loop)
        monkeypatch.setattr(moreau_run, "ContactProblem", plain.coulomb.ContactProblem)
        monkeypatch.setattr(moreau_run, "Rows", plain.moving.Rows)
        monkeypatch.setattr(moreau_run, "State", plain.moving.State)
        monkeypatch.setattr(moreau_run, "Plan", plain.moving.Plan)
        monkeypatch.setattr(moreau_run, "places", plain.extent.places)
        monkeypatch.setattr(moreau_run, "own_places", plain.extent.own_places)
        monkeypatch.setattr(moreau_run, "ways", plain.extent.ways)
        monkeypatch.setattr(moreau_run, "is_stiff", plain.extent.is_stiff)
        monkeypatch.setattr(moreau_run, "constant_rows", plain.responses.constant_rows)

    return start


@pytest.mark.parametrize("keep", slow([1, 7, "times", "impacts"], longest=[7, "impacts"]))
@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("bouncing_ball", {}),
        ("cam_follower", {"theta": 0.7}),
        ("newtons_cradle", {}),
        ("newtons_cradle", {"lcp": "qp"}),
        ("coulomb_oscillator", {}),
        ("slider_crank", {}),
        ("slider_crank", {"projected": True}),
        ("double_pendulum", {"projected": True}),
    ],
)
def test_uncompiled_kernels_take_the_same_steps(name, options, keep, uncompiled):
    scene = getattr(scenes, name)()
    start, end = scene.t_span
    method = Moreau((end - start) / STEPS, **options)
    keep = np.linspace(start, end, 5) if keep == "times" else keep
    built = simulate(scene, method, keep=keep)
    uncompiled()
    motion = simulate(scene, method, keep=keep)
    assert motion.counts == built.counts
    for one, other in ((motion.t, built.t), (motion.q, built.q), (motion.v, built.v)):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(motion.impulse, built.impulse)
    np.testing.assert_array_equal(motion.impacts, built.impacts)
