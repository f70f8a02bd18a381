"""Importing is quick: nothing heavy is loaded before it is needed."""

import pytest

from tests.processes import python

HEAVY = ("numba", "llvmlite", "scipy", "qpsolvers", "osqp", "matplotlib", "tqdm", "xarray", "pandas", "PIL")


@pytest.mark.parametrize("package", ["lcpstep", "lagrangian"])
def test_a_fresh_import_loads_no_heavy_package(package):
    loaded = python(
        f"import sys, {package}; print(*sorted({{m.split('.')[0] for m in sys.modules}}))"
    ).split()
    assert not set(HEAVY) & set(loaded)


def test_models_know_no_solver():
    assert python("import sys, lagrangian; print('lcpstep' in sys.modules)") == "False"


def test_making_scenes_and_methods_loads_no_heavy_package():
    program = """
import sys
from lagrangian import scenes
from lcpstep import EventDriven, Moreau
scenes.cam_follower(), scenes.bouncing_ball(), scenes.impact_oscillator(), Moreau(1e-3), EventDriven()
print(*sorted({m.split('.')[0] for m in sys.modules}))
"""
    assert not set(HEAVY) & set(python(program).split())
