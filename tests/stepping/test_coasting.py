"""Steps of one coordinate and contact are those of the general step, to the last bit."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, scenes
from lcpstep import Located, Moreau, simulate

SCENES = [
    scenes.bouncing_ball(),
    scenes.impact_oscillator(t_end=20.0),
    scenes.cam_follower(t_end=0.5),
    scenes.cam_follower(rpm=120.0, q0=0.0, v0=0.0, t_end=0.5),
    Scene(
        name="stopped, held and let go",  # by a spring at a stop that it leaves again
        system=LinearSystem(2.0, C=0.3, K=90.0, force=-1.0), q0=0.3, v0=-2.0, t_span=(0.0, 2.0),
        contacts=LinearContacts(-3.0, offset=1.2, restitution=0.2),
    ),
]  # fmt: skip


@pytest.mark.parametrize("scene", SCENES, ids=lambda s: s.name)
@pytest.mark.parametrize("every", [1, 7, 10**6])
def test_coasting_changes_no_bit(scene, every):
    # a state asked for at the end of every step leaves no step to coast through
    start, end = scene.t_span
    steps = round((end - start) / 1e-3)
    times = start + (end - start) / steps * np.arange(steps + 1)
    slow, fast = (simulate(scene, Moreau(h=1e-3), keep=k) for k in (times, every))
    rows = np.searchsorted(slow.t, fast.t)
    np.testing.assert_array_equal(slow.t[rows], fast.t)
    np.testing.assert_array_equal(slow.q[rows], fast.q)
    np.testing.assert_array_equal(slow.v[rows], fast.v)
    np.testing.assert_array_equal(slow.impacts, fast.impacts)
    assert slow.counts == fast.counts
    np.testing.assert_allclose(fast.impulse.sum(axis=0), slow.impulse.sum(axis=0), rtol=1e-12)


@pytest.mark.parametrize("scene", SCENES, ids=lambda s: s.name)
@pytest.mark.parametrize("method", [Moreau(1e-3), Located(1e-3)], ids=["moreau", "located"])
@pytest.mark.parametrize("shift", [0.0, 0.5, 1e-12])
def test_states_asked_for_now_and_then_are_those_asked_for_in_every_step(scene, method, shift):
    times = scene.t_span[0] + 1e-3 * (np.arange(round((scene.t_span[1] - scene.t_span[0]) / 1e-3)) + shift)
    slow, fast = (simulate(scene, method, keep=kept) for kept in (times, times[3::41]))
    np.testing.assert_array_equal(fast.t, slow.t[3::41])
    np.testing.assert_array_equal(fast.q, slow.q[3::41])
    np.testing.assert_array_equal(fast.v, slow.v[3::41])
    np.testing.assert_array_equal(fast.impacts, slow.impacts)


@pytest.mark.parametrize("every", [1, 3, "impacts", [20.0]])
def test_a_log_that_fills_up_in_between_changes_no_bit(every):
    scene = Scene(
        system=LinearSystem(1.0, force=-9.81), q0=0.0, v0=3e-3, t_span=(0.0, 20.0),
        contacts=LinearContacts(1.0, restitution=1.0),
    )  # fmt: skip
    slow, fast = (simulate(scene, Moreau(1e-3), keep=k) for k in (np.linspace(0.0, 20.0, 20_001), every))
    assert len(slow.impacts) == 10_000  # a hop of two steps each
    np.testing.assert_array_equal(slow.impacts, fast.impacts)
    np.testing.assert_array_equal(slow.q[np.searchsorted(slow.t, fast.t)], fast.q)
    assert slow.counts == fast.counts
