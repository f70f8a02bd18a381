"""Kernels as Cython reads them: types from annotations, and from what is assigned; what C knows is cimported."""

import re

import pytest

import declarations
import kernel_sources
from tests.uncompiled import BUILT, ROOT

NUMBERS = "ROUNDS, LEAST = 3, 1e-9\n"
STATE = """import cython

from lcpstep.pointers import Doubles, Indices


def as_table(given: dict[str, float]) -> list[float]:
    return list(given.values())


class Base:
    def size(self) -> float:
        return 1.0


class State(Base):
    def __init__(self, n: int) -> None:
        self.n = n

    def open(self, c: int) -> bool:
        return self.g[c] > 0.0

    def names(self) -> list[str]:
        return []
"""
FIELDS = """cdef class State

cdef class Base:
    cdef readonly double h

cdef class State(Base):
    cdef public Py_ssize_t n
    cdef Doubles g
    cdef Indices mode
"""
KERNEL = """import cython

from lcpstep.numbers import LEAST, ROUNDS
from lcpstep.pointers import Doubles, abs
from lcpstep.state import State, as_table
"""
POINTERS = "cdef inline double abs(double x) noexcept nogil\nctypedef double* Doubles\nctypedef Py_ssize_t* Indices\n"


def declared(folder, source, name="kernel"):
    """The lines that declare a kernel which takes `State` from another one."""
    (folder / "lcpstep").mkdir(exist_ok=True)
    others = {"state.py": STATE, "state.pxd": FIELDS, "numbers.py": NUMBERS, "pointers.pxd": POINTERS}
    for file, text in (others | {"pointers.py": "", f"{name}.py": source}).items():
        (folder / "lcpstep" / file).write_text(text)
    return declarations.declarations(folder, f"lcpstep.{name}").splitlines()


def test_what_c_knows_of_an_import_is_cimported_and_lines_stay_where_they_are(tmp_path):
    source = """import cython

from math import pow as power

from lcpstep.pointers import (
    Doubles,
    abs,
)
from lcpstep.state import State, as_table
from lcpstep.numbers import LEAST

if not cython.compiled:
    ONE = [0.0]

@cython.ccall
def f(x: float) -> float:
    return x

"""
    numpys = "@cython.ufunc\n@cython.cfunc\ndef g(x: cython.double) -> cython.double:\n    return x"
    declared(tmp_path, source + numpys)
    read = declarations.source(tmp_path, "lcpstep.kernel").split("\n")
    pointers = ["from cython.cimports.lcpstep.pointers import Doubles, abs"]
    assert read == [
        *("import cython", "", "from cython.cimports.libc.math import pow as power", ""),
        *("; ".join(pointers), "", "", ""),
        "from cython.cimports.lcpstep.state import State; from lcpstep.state import as_table",
        *("from lcpstep.numbers import LEAST", "", "if not cython.compiled:", "    ONE = [0.0]", ""),
        *("", "def f(x: float) -> float:", "    return x", "", *numpys.split("\n")),
    ]


def types(folder, body):
    """The types of the variables of a kernel f(s: State, x: Doubles, n: int)."""
    source = f"{KERNEL}\n\ndef pair(x: Doubles) -> tuple[int, float]:\n    return 0, x[0]\n\n\n"
    source += "def f(s: State, x: Doubles, n: int) -> None:\n" + "".join(f"    {line}\n" for line in body)
    lines = declared(folder, source)
    place = lines.index("cdef void f(State s, Doubles x, Py_ssize_t n) noexcept nogil")
    told = re.match(r"@cython.locals\((.*)\)", lines[place - 1])
    return dict(x.split("=") for x in told[1].split(", ")) if told else {}


def test_functions_are_declared_by_their_annotations(tmp_path):
    source = (
        KERNEL
        + """

def f(s: State, x: Doubles, c: int, t: float) -> tuple[int, bool]:
    return c, t > 0.0


@cython.ccall
def g(s: State, given: Any, least: float = 0.0) -> Any:
    return given


@cython.cfunc
def h(given: Any) -> float:
    return LEAST


@cython.ccall
@cython.nogil
def k(s: State) -> bool:
    return s.open(0)


def of_python(given: Any) -> int:
    return ROUNDS
"""
    )
    assert declared(tmp_path, source) == [
        "cimport cython",
        "from lcpstep.pointers cimport Doubles",
        "from lcpstep.state cimport State",
        "cdef double LEAST",
        "cdef Py_ssize_t ROUNDS",
        "cdef (Py_ssize_t, bint) f(State s, Doubles x, Py_ssize_t c, double t) noexcept nogil",
        "cpdef object g(State s, object given, double least=*)",
        "cdef double h(object given)",
        "cpdef bint k(State s) noexcept nogil",
    ]


def test_methods_stand_with_the_fields_of_their_class(tmp_path):
    lines = declared(tmp_path, KERNEL, "other") and declarations.declarations(tmp_path, "lcpstep.state")
    begin = lines.index("cdef class Base:")
    assert lines[begin:].splitlines() == [
        "cdef class Base:",
        "    cdef readonly double h",
        "    cdef double size(self) noexcept nogil",
        "",
        "cdef class State(Base):",
        "    cdef public Py_ssize_t n",
        "    cdef Doubles g",
        "    cdef Indices mode",
        "    cdef bint open(self, Py_ssize_t c) noexcept nogil",
    ]


def test_a_class_without_relatives_is_final(tmp_path):
    (tmp_path / "lcpstep").mkdir()
    (tmp_path / "lcpstep" / "alone.pxd").write_text("cdef class Alone:\n    cdef double x\n")
    lines = declared(tmp_path, "import cython\n\n\nclass Alone:\n    pass\n", "alone")
    assert lines == ["cimport cython", "@cython.final", "cdef class Alone:", "    cdef double x"]


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (["found, most = False, 1.0"], {"found": "bint", "most": "double"}),
        (["c = s.mode[n] + 2", "u = s.g[c]"], {"c": "Py_ssize_t", "u": "double"}),
        (["k, y = pair(x)"], {"k": "Py_ssize_t", "y": "double"}),
        (["is_open = s.open(n) and not n == 2"], {"is_open": "bint"}),
        (["size = s.size() if s.h > 0.0 else 0"], {"size": "double"}),  # of the class it is derived from
        (["for c in range(n):", "    x[c] = 0.0"], {"c": "Py_ssize_t"}),
        (["total = 0", "total += x[0]"], {"total": "double"}),
        (["a = 0.0", "b = a", "a = b * n"], {"a": "double", "b": "double"}),
        (["share = x[0] / 2", "whole = n // 2"], {"share": "double", "whole": "Py_ssize_t"}),
        (["share = n / 2"], {}),  # which C reads otherwise than Python
        (["small = unknown(x) < 1.0"], {}),  # of arrays it would be an array
        (["none = s is None or x[0] < n"], {"none": "bint"}),
        (["most = ROUNDS if n > 0 else LEAST"], {"most": "double"}),
        (["off: float = unknown(x)"], {"off": "double"}),
        (["off = unknown(x)", "again = off"], {}),
        (["y = x"], {}),  # pointers are left to Cython
        (["m = 1", "m = unknown(x)"], {}),
    ],
)
def test_variables_are_what_is_assigned_to_them(tmp_path, body, expected):
    assert types(tmp_path, body) == expected


def test_what_is_merged_into_others_is_declared_with_its_body(tmp_path, monkeypatch):
    monkeypatch.setattr(declarations, "MERGED", {"lcpstep.short"})
    source = (
        KERNEL
        + """

def total(x: Doubles, n: int) -> float:
    \"\"\"Sum.\"\"\"
    s = 0.0
    for i in range(n):
        s += abs(x[i])
    return s
"""
    )
    lines = declared(tmp_path, source, "short")
    assert lines[1] == "from lcpstep.pointers cimport Doubles, abs"
    assert lines[lines.index("cdef inline double total(Doubles x, Py_ssize_t n) noexcept nogil:") + 1 :] == [
        *("    cdef double s", "    cdef Py_ssize_t i", "    s = 0.0", "    for i in range(n):"),
        *("        s += abs(x[i])", "    return s", ""),
    ]


@pytest.mark.parametrize("name", sorted(set(BUILT) - kernel_sources.IN_C))
def test_a_function_of_numbers_has_no_argument_that_only_python_knows(name):
    """It would be Python's in silence, and slow."""
    k = kernel_sources.Kernel(ROOT.parent, name)
    for f in k.functions.values():
        kinds = [k.type_of(argument.annotation) for argument in f.args.args]
        if any(kind in ("Doubles", "Indices", "Flags") for kind in kinds):
            assert None not in kinds, f.name
