"""What calls of `simulate` share, and what each costs besides its steps."""

import pickle
import sys
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import LinearJoints, scenes
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.callbacks import hearing

SHORT = (0.0, 2e-3)


@pytest.mark.parametrize(
    "method", [Moreau(1e-2), Located(1e-2), EventDriven()], ids=lambda x: type(x).__name__
)
def test_a_run_leaves_the_scene_to_the_next_one_as_it_was(method):
    scene = scenes.bouncing_ball(t_end=2.0)
    before = simulate(scene, method)
    simulate(scene, Moreau(1e-1, tolerance=1e-3))  # which takes the restitution from its own slow contacts
    after = simulate(scene, method)
    np.testing.assert_array_equal(before.q, after.q)
    np.testing.assert_array_equal(before.impacts, after.impacts)


def test_joints_have_numbers_of_their_own():
    G = np.array([[1.0, 1.0]])
    joints = LinearJoints(G, 0.5)
    G[:] = 7.0
    gap, _ = joints.as_contacts().state(0.0, np.array([1.0, 2.0]), np.zeros(2), np.zeros(0))
    assert gap == 3.5
    assert (
        joints.as_contacts() is joints.as_contacts()
    )  # checked once, and not whenever somebody asks for n_j
    assert pickle.loads(pickle.dumps(joints)).n_j == 1


# Functions called in Python or C, whose number the load of a machine does not change
@pytest.mark.parametrize(
    ("method", "most"),
    [(Moreau(1e-3), 400), (Located(1e-3), 410), (Located(1e-3, order=4), 440), (EventDriven(), 540)],
    ids=["moreau", "located", "located-4", "event-driven"],
)
@pytest.mark.parametrize("make", [scenes.bouncing_ball, scenes.cam_follower, scenes.newtons_cradle])
def test_a_short_run_is_hardly_more_than_its_steps(make, method, most, monkeypatch):
    monkeypatch.setattr(hearing, "EXPECTED", False)  # by functions of other tests that are not compiled
    scene = replace(make(), t_span=SHORT)
    simulate(scene, method)
    calls = 0

    def count(frame, event, argument):
        nonlocal calls
        calls += event in ("call", "c_call")

    sys.setprofile(count)
    try:
        simulate(scene, method)
    finally:
        sys.setprofile(None)
    assert calls <= most
