"""Mechanisms from a Lagrangian: what is refused by name, and the module that is written."""

import importlib
import linecache
import math
import subprocess
import sys

import numpy as np
import pytest

from tests.lagrangian.mechanisms import T, derive, double_pendulum, dynamicsymbols, pendulum, sympy
from tests.processes import python

# --- what is refused


def refused():
    x, y, (k, m) = *dynamicsymbols("x y"), sympy.symbols("k m")
    a, b = sympy.symbols("a b")
    both, two = {"coordinates": (x, y)}, {"parameters": {"k": 2.0}}
    T_x, T_y = x.diff() ** 2 / 2, y.diff() ** 2 / 2
    given = {"lagrangian": T_x, "coordinates": x, "parameters": {"m": 1.0}}
    return [
        (given | {"lagrangian": T_x - k * x * a}, r"^lagrangian: unknown a, k;"),
        (given | {"lagrangian": T_x - y}, r"^lagrangian: unknown y\(t\)"),
        (given | {"lagrangian": T_x * x.diff(T, 2)}, r"^lagrangian: unknown Derivative\(x\(t\), \(t, 2\)\)"),
        (given | {"lagrangian": "x**2"}, r"^lagrangian: expected a sympy expression, got 'x\*\*2'"),
        (given | {"lagrangian": sympy.Matrix([x])}, r"^lagrangian: expected a sympy expression"),
        (given | {"lagrangian": sympy.Eq(x, 1)}, r"^lagrangian: expected a sympy expression"),
        (given | {"lagrangian": T_x + sympy.I * x}, r"^lagrangian: expected a real, finite"),
        (given | {"lagrangian": T_x + sympy.sqrt(-1 - x**2)}, r"^lagrangian: expected a real, finite"),
        (given | {"lagrangian": T_x + sympy.oo}, r"^lagrangian: expected a real, finite"),
        (given | {"lagrangian": T_x + sympy.besselj(0, x)}, r"^lagrangian: cannot be written .* besselj"),
        (given | {"lagrangian": T_x + sympy.Piecewise((x, x > 0))}, r"^lagrangian: cannot be written"),
        (given | {"lagrangian": -m * sympy.sqrt(1 - x.diff() ** 2)}, r"^lagrangian: .*quadratic.*Derivative\(x"),
        (given | {"lagrangian": sympy.Abs(x.diff())}, r"^lagrangian: .*quadratic"),
        (given | {"coordinates": (x, y)}, r"^lagrangian: singular mass matrix: no kinetic energy in y\(t\)"),
        (given | both | {"lagrangian": (x.diff() + y.diff()) ** 2}, r"^lagrangian: singular or indefinite mass"),
        (given | {"lagrangian": -T_x}, r"^lagrangian: singular or indefinite mass"),
        (given | both | two | {"lagrangian": T_x + (k - 2) * T_y}, r"^lagrangian: singular or indefinite mass"),
        (given | {"coordinates": ()}, r"^coordinates: "),
        (given | {"coordinates": "x"}, r"^coordinates: expected symbols or functions of time"),
        (given | {"coordinates": 2 * x}, r"^coordinates: expected symbols"),
        (given | {"coordinates": (x, sympy.Function("y")(a))}, r"^coordinates: .*same time"),
        (given | {"coordinates": (x, x)}, r"x\(t\) given twice"),
        (given | {"coordinates": a}, r"^velocities: expected one symbol"),
        (given | {"coordinates": a, "velocities": (b, k)}, r"^velocities: expected 1, one for each .* got 2"),
        (given | {"coordinates": a, "velocities": 2 * b}, r"^velocities: expected symbols"),
        (given | {"coordinates": (x, y), "velocities": (y.diff(), x.diff())}, r"^velocities: .*in the order"),
        (given | {"parameters": {"m": "heavy"}}, r"^parameters\['m'\]: expected a number, got 'heavy'"),
        (given | {"parameters": {"m": math.nan}}, r"^parameters\['m'\]: expected a finite"),
        (given | {"parameters": [1.0]}, r"^parameters: expected a mapping"),
        (given | {"parameters": {"t": 1.0}}, r"t given twice"),
        (given | {"dissipation": k * x.diff() ** 2}, r"^dissipation: unknown k"),
        (given | {"forces": [1, 2]}, r"^forces: expected 1, one a coordinate, got 2"),
        (given | {"forces": {y: 1}}, r"^forces: y\(t\) is no coordinate"),
        (given | {"forces": [a]}, r"^forces\[0\]: unknown a"),
        (given | {"gaps": [x, x - k]}, r"^gaps\[1\]: unknown k"),
        (given | {"gaps": x.diff()}, r"^gaps\[0\]: expected no velocities, got Derivative\(x\(t\), t\)"),
        (given | {"gaps": sympy.floor(x)}, r"^gaps: \w+ ?: cannot be written"),
        (given | {"gaps": sympy.Mod(x, 2)}, r"^gaps: \w+ ?: cannot be written"),
        (given | {"gaps": x, "restitution": 1.5}, r"^restitution: "),
        (given | {"gaps": x, "restitution": [0.5, 0.5]}, r"^restitution: "),
    ]  # fmt: skip


@pytest.mark.parametrize("case", range(len(refused())), ids=lambda i: refused()[i][1][:40])
def test_what_does_not_make_a_mechanism_is_refused_by_name(case):
    arguments, message = refused()[case]
    with pytest.raises(ValueError, match=message):
        derive(**arguments)


def test_states_of_another_size_have_no_energy():
    with pytest.raises(ValueError, match=r"^q: expected shape \(2, 2\)"):
        double_pendulum().energy([0.0, 1.0], np.zeros((2, 1)), np.zeros((2, 2)))


# --- the module


def test_the_source_of_callbacks_is_shown_by_tracebacks():
    f = pendulum().system.force
    assert vars(sys.modules[f.__module__]) is f.__globals__
    assert linecache.getlines(f.__code__.co_filename) == pendulum().source.splitlines(keepends=True)


@pytest.mark.slow
def test_the_next_process_finds_the_machine_code_of_callbacks(tmp_path):
    program = """
import sympy
from sympy.physics.mechanics import dynamicsymbols
from lagrangian.symbolic import derive
from lcpstep import Moreau, simulate
from lcpstep.callbacks import compiling
x = dynamicsymbols("x")
fall = derive(x.diff() ** 2 / 2 - 1.625 * x, x)
print(simulate(fall.scene([0.0], [0.0], (0.0, 1.0)), Moreau(0.5)).q[-1, 0])
print(len(compiling.MADE))
"""
    folder = {"NUMBA_CACHE_DIR": str(tmp_path)}
    first = python(program, **folder)
    kept = {file.name: file.stat().st_mtime_ns for file in tmp_path.iterdir()}
    assert any("force" in name for name in kept)
    assert python(program, **folder) == first
    assert {file.name: file.stat().st_mtime_ns for file in tmp_path.iterdir()} == kept


def test_models_need_no_sympy():
    code = "import lagrangian, lcpstep, sys; assert 'sympy' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_without_sympy_the_error_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "sympy", None)
    monkeypatch.delitem(sys.modules, "lagrangian.symbolic")
    with pytest.raises(ImportError, match=r'pip install "lcpstep\[symbolic\]"'):
        importlib.import_module("lagrangian.symbolic")
