"""What is compiled when a scene is run: its own functions, once, and nothing else."""

import pytest

from lcpstep.callbacks import disabled
from tests.processes import python

pytestmark = pytest.mark.skipif(disabled(), reason="nothing is compiled")
AHEAD_OF_TIME = """
import sys
from lagrangian import scenes
from lcpstep import EventDriven, Located, Moreau, simulate
methods = Moreau(1e-3), Moreau(1e-3, tolerance=1e-4), Located(1e-3), Located(1e-3, order=4), EventDriven()
for scene in (scenes.bouncing_ball(t_end=0.1), scenes.cam_follower(t_end=0.1), scenes.pendulum_stop(t_end=0.1)):
    for method in methods:
        for keep in (1, 7, [0.01, 0.02], "impacts"):
            simulate(scene, method, keep=keep)
print("numba" in sys.modules)
"""


def test_ready_scenes_compile_nothing():
    assert python(AHEAD_OF_TIME).split("\n")[-1] == "False"


SCENE_FILE = """
from lagrangian import Scene, System
import numpy as np
import os
NUMBER = float(os.environ["NUMBER"])
ARRAY = np.array([NUMBER])

def helper(x):
    return NUMBER * x

def force(t, q, v, p, out):
    out[0] = {expression}

scene = Scene(system=System(1, 1.0, force), q0=1.0, v0=0.0, t_span=(0.0, 1.0))
"""


@pytest.mark.parametrize("expression", ["NUMBER", "helper(1.0)", "ARRAY[0]"])
def test_a_callback_kept_on_disk_is_not_taken_for_another(tmp_path, expression):
    (tmp_path / "scene.py").write_text(SCENE_FILE.replace("{expression}", expression))
    run = (
        f"import sys; sys.path.insert(0, {str(tmp_path)!r}); from scene import scene; "
        "from lcpstep import Moreau, simulate; print(simulate(scene, Moreau(0.5)).v[-1, 0])"
    )
    for number in ("2.0", "3.0", "2.0"):
        assert float(python(run, NUMBER=number).split("\n")[-1]) == float(number)
