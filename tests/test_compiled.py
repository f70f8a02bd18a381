"""What is compiled when a scene is run: its own functions, once, and nothing else."""

import pytest

from tests.marks import compiled_only
from tests.processes import python

pytestmark = compiled_only
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


EXPRESSIONS = ["NUMBER", "helper(1.0)", "ARRAY[0]"]


@pytest.fixture(scope="module")
def three_processes(tmp_path_factory):
    """The number that each process was given, and what scenes with these expressions came to in it."""
    folder = tmp_path_factory.mktemp("scenes")
    for k, expression in enumerate(EXPRESSIONS):
        (folder / f"scene{k}.py").write_text(SCENE_FILE.replace("{expression}", expression))
    run = f"import sys; sys.path.insert(0, {str(folder)!r}); from lcpstep import Moreau, simulate\n"
    for k in range(len(EXPRESSIONS)):
        run += f"import scene{k}; print(simulate(scene{k}.scene, Moreau(0.5)).v[-1, 0])\n"
    said = {}
    for nth, number in enumerate(("2.0", "3.0", "2.0")):
        lines = python(run, NUMBER=number).split("\n")[-len(EXPRESSIONS) :]
        said[nth] = (float(number), dict(zip(EXPRESSIONS, map(float, lines), strict=True)))
    return said


@pytest.mark.slow
@pytest.mark.parametrize("expression", EXPRESSIONS)
def test_a_callback_kept_on_disk_is_not_taken_for_another(three_processes, expression):
    for number, found in three_processes.values():
        assert found[expression] == number
