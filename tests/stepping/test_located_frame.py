"""Located in a moving frame: steps are taken where the frame rests; states come back in the scene's coordinates."""

import math

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Located, simulate
from lcpstep.accuracy.errors import Difference
from lcpstep.trajectory import Kind


def shaken(t, q, v, p, out):
    for i in range(2):
        w = 5.0 + 2.0 * i
        out[i, 0], out[i, 1] = 0.1 * math.sin(w * t), 0.1 * w * math.cos(w * t)
        out[i, 2] = -0.1 * w * w * math.sin(w * t)


def lifting(t, q, v, p, out):
    out[0, 0], out[0, 1] = 0.05 * math.cos(7.0 * t), -0.35 * math.sin(7.0 * t)
    out[0, 2] = -2.45 * math.cos(7.0 * t)
    out[1, 0], out[1, 1], out[1, 2] = -1.0, 0.0, 0.0


def two_masses():
    """Two damped masses in a frame that shakes, over a stop that moves; their chattering ends in rest on it."""
    K, C = [[90.0, -40.0], [-40.0, 40.0]], 0.1 * np.eye(2)
    system = LinearSystem(M=np.diag([1.0, 2.0]), C=C, K=K, force=[-9.81, -19.62], frame=shaken)
    G, offset = [[-1.0, 1.0], [1.0, 0.0]], [0.1, 0.0]
    contacts = LinearContacts(G=G, offset=offset, restitution=[0.6, 0.7], motion=lifting)
    return Scene(system=system, contacts=contacts, q0=[0.2, 0.5], v0=[0.0, 0.0], t_span=(0.0, 1.5))


@pytest.mark.parametrize("rpm", [125.0, 358.0])
@pytest.mark.parametrize("h", [1e-3, 1e-4])
def test_the_cam_follower_moves_the_same_in_both_coordinates(rpm, h):
    runs = [
        simulate(scenes.cam_follower(rpm=rpm, t_end=0.5, coordinates=c), Located(h))
        for c in ("relative", "absolute")
    ]
    relative, absolute = runs
    states = zip(absolute.t, absolute.q, absolute.v, strict=True)
    gap = np.array([np.ravel(absolute.scene.gap(t, q, v))[0] for t, q, v in states])
    np.testing.assert_allclose(relative.t, absolute.t, rtol=0, atol=1e-12)
    np.testing.assert_allclose(relative.q[:, 0], gap, rtol=0, atol=1e-11)
    assert np.min(relative.q) > -1e-12


@pytest.mark.slow
def test_order_two_in_a_frame_that_shakes_beside_a_stop_that_moves():
    scene = two_masses()
    reference = simulate(scene, EventDriven())
    assert len(reference.impacts) > 5
    assert reference.impacts.kind[-1] == Kind.RELEASE
    steps = 1e-3 * 0.5 ** np.arange(6)
    errors = [
        np.mean(
            [Difference(simulate(scene, Located(h * f)), reference).sup_position for f in (0.93, 1.0, 1.07)]
        )
        for h in steps
    ]
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] > 1.9
    assert errors[-1] < 1e-7


def test_states_asked_for_and_those_of_an_adaptive_run_are_in_the_frame_too():
    scene = scenes.cam_follower(t_end=0.2)
    times = np.linspace(0.0, 0.2, 37)
    reference = simulate(scene, EventDriven(), keep=times)
    for method in (Located(1e-4), Located(1e-3, tolerance=1e-7)):
        run = simulate(scene, method, keep=times)
        np.testing.assert_allclose(run.q, reference.q, rtol=0, atol=1e-5)
        np.testing.assert_allclose(run.v[:-1], reference.v[:-1], rtol=0, atol=1e-3)
