"""Steps with located impacts where nothing is built: the kernels as plain Python move everything alike."""

import pytest

from tests.uncompiled import both_ways

# Impacts and forces of several contacts, more events in a step than may be, joints, a mass that changes; all orders
MOTIONS = """
import hashlib
import numpy as np
from lagrangian import LinearContacts, LinearSystem, Scene, scenes
from lcpstep import Located, simulate

angles = np.array([0.1, 0.2, 0.3])
planes = np.stack([-np.sin(angles), np.cos(angles)], axis=1)
groove = Scene(
    LinearSystem(M=np.eye(2), force=[1.0, -10.0]), [0.0, 0.1], [0.3, -1.0], (0.0, 0.6),
    contacts=LinearContacts(G=np.vstack([planes, planes * [-1.0, 1.0]]), restitution=0.5),
)
for scene, n, order in (
    (groove, 20, 2), (scenes.pendulum_stop(form="rod", t_end=1.0), 30, 2), (scenes.double_pendulum(t_end=0.5), 20, 2),
    (scenes.stack(t_end=0.3), 20, 2), (scenes.bowl(t_end=0.5), 20, 2), (groove, 20, 4), (groove, 20, "exact"),
    (scenes.double_pendulum(t_end=0.5), 10, 4), (scenes.cam_follower(t_end=1.0), 20, "exact"),
):
    m = simulate(scene, Located(scene.t_span[1] / n, order=order, max_per_step=3))
    numbers = b"".join(x.tobytes() for x in (m.t, m.q, m.v, m.impulse, m.joint_impulse))
    print(scene.name, len(m.impacts), m.message, hashlib.sha256(numbers).hexdigest())
"""


@pytest.mark.slow
def test_kernels_of_located_move_alike_where_they_are_not_built():
    built, plain = both_ways(MOTIONS)
    assert plain == built
    assert len(plain) == 9
    assert "plastic impact" in plain[0]
