"""Importing is quick: nothing heavy is loaded before it is needed."""

from types import ModuleType

import pytest

import lagrangian
import lcpstep
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


@pytest.mark.parametrize("package", ["lcpstep", "lagrangian"])
def test_a_fresh_import_loads_no_module_of_its_own_before_it_is_used(package):
    program = (
        f"import sys, {package}; print(*sorted(m for m in sys.modules if m.startswith(('lcpstep', 'lagr'))))"
    )
    assert set(python(program).split()) <= {"lcpstep", "lagrangian", "lagrangian.lazy"}


def test_a_method_loads_the_kernels_of_its_own_run_alone():
    program = """
import sys
from lagrangian import scenes
from lcpstep import EventDriven, Located, Moreau, simulate

def built():
    return {name for name, m in sys.modules.items() if name.startswith("lcpstep") and hasattr(m, "__pyx_capi__")}

scene = scenes.bouncing_ball(t_end=0.1)
Located(1e-2), EventDriven()
print(len(built()))
simulate(scene, Moreau(1e-2))
print(any(name.startswith(("lcpstep.events", "lcpstep.stepping.pieces")) for name in built()))
"""
    assert python(program).split() == ["0", "False"]


@pytest.mark.parametrize("package", [lcpstep, lagrangian])
def test_every_public_name_is_what_its_module_defines(package):
    for name in package.__all__:
        assert name in dir(package)
        found = getattr(package, name)
        assert isinstance(found, ModuleType) == (name == "scenes")
        assert getattr(found, "__name__", name).rpartition(".")[2] == name


def test_names_that_are_not_there_are_said():
    with pytest.raises(AttributeError, match="'lcpstep' has no attribute 'Moraeu'"):
        _ = lcpstep.Moraeu
    with pytest.raises(ImportError, match="Moraeu"):
        exec("from lcpstep import Moraeu")


def test_functions_keep_their_names_when_modules_have_been_imported():
    program = """
import lcpstep.simulation, lcpstep.accuracy.study, lcpstep.continuing, lcpstep.diagnostics
from lcpstep import continued, energy, simulate, study
print(*(callable(f) and f is getattr(lcpstep, f.__name__) for f in (continued, energy, simulate, study)))
"""
    assert set(python(program).split()) == {"True"}
