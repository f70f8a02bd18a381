"""What Python and C read differently, in the sources of kernels; and how these are declared for Cython."""

import ast
import importlib.util
import re

import pytest

import declarations
import kernel_sources
from lcpstep.stepping.pieces import codes
from tests.uncompiled import BUILT, ROOT


def whole(node, integers):
    """Whether an expression is an integer at a glance: a literal, or an argument said to be one."""
    if isinstance(node, ast.Constant):
        return isinstance(node.value, int)
    return isinstance(node, ast.Name) and node.id in integers


def arguments(tree):
    """Names of the arguments that are integers, of all functions of a file."""
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    given = [argument for f in functions for argument in f.args.args if argument.annotation is not None]
    return {argument.arg for argument in given if ast.unparse(argument.annotation) == "int"}


def divisions(source):
    """Lines on which an integer is divided by an integer: 1 / 16 is 0 in C."""
    tree = ast.parse(source)
    integers = arguments(tree)
    found = [node for node in ast.walk(tree) if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div)]
    return [d.lineno for d in found if whole(d.left, integers) and whole(d.right, integers)]


@pytest.mark.parametrize("name", sorted(BUILT))
def test_no_kernel_divides_integers(name):
    assert divisions(BUILT[name].read_text()) == []


def test_a_division_of_integers_is_found():
    assert divisions("EARLY = 1 / 16\n\ndef f(n: int, m: int, x: float):\n    return n / m + x / n") == [1, 4]


# --- what a kernel takes from others: said once, in the `.py` -----------------------------------------------------


def setup_module_of_project():
    spec = importlib.util.spec_from_file_location("setup_of_lcpstep", ROOT.parent / "setup.py")
    setup = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(setup)
    return setup


def test_the_linker_gets_no_words_of_debians_that_zigs_does_not_know(monkeypatch):
    setup, debian = (
        setup_module_of_project(),
        "x86_64-linux-gnu-gcc -shared -Wl,-O1 -Wl,-Bsymbolic-functions -g",
    )
    for words, kept in (
        (debian, ["-shared", "-g"]),
        ("gcc -pthread -shared", ["-pthread", "-shared"]),
        ("clang -bundle -undefined dynamic_lookup", ["-bundle", "-undefined", "dynamic_lookup"]),
    ):
        monkeypatch.setattr(setup.sysconfig, "get_config_var", lambda _, words=words: words)
        assert setup.linking() == kept


def test_what_a_kernel_imports_is_cimported_on_the_line_on_which_it_stood():
    setup = setup_module_of_project()
    source = "import cython\n\nif not cython.compiled:\n    from math import pow as power\n\n"
    source += "    from lcpstep.pointers import (\n        abs,\n        max,\n    )\n\n"
    source += "if not cython.compiled:\n    ONE = [0.0]\n"
    read = ["import cython", "", "", "from cython.cimports.libc.math import pow as power", ""]
    read += ["from cython.cimports.lcpstep.pointers import abs, max", "", "", "", ""]
    assert setup.cimporting(source).split("\n") == [*read, "if not cython.compiled:", "    ONE = [0.0]", ""]


@pytest.mark.parametrize("mark", ["cython.ccall", "cython.cfunc", "cython.final"])
def test_what_is_declared_is_not_said_to_cython_again(mark):
    source = f"import cython\n\n@{mark}\ndef f(x: float) -> float:\n    return x\n"
    assert setup_module_of_project().cimporting(source) == source.replace(f"@{mark}", "")
    numpys = "@cython.ufunc\n@cython.cfunc\ndef f(x: cython.double) -> cython.double:\n    return x\n"
    assert setup_module_of_project().cimporting(numpys) == numpys


# --- what is declared: types from annotations, and from what is assigned -----------------------------------------

STATE = """import cython

ROUNDS, LEAST = 3, 1e-9


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
FIELDS = """cdef class Base:
    cdef readonly double h

cdef class State(Base):
    cdef public Py_ssize_t n
    cdef Doubles g
    cdef Indices mode
"""
KERNEL = """import cython

from lcpstep.state import LEAST, ROUNDS

if not cython.compiled:
    from lcpstep.pointers import Doubles, abs
    from lcpstep.state import State
"""


def declared(folder, source, name="kernel"):
    """The lines that declare a kernel which takes `State` from another one."""
    (folder / "lcpstep").mkdir(exist_ok=True)
    for file, text in (("state.py", STATE), ("state.pxd", FIELDS), (f"{name}.py", source)):
        (folder / "lcpstep" / file).write_text(text)
    return declarations.declarations(folder, f"lcpstep.{name}").splitlines()


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
        "cdef double h(object given) noexcept",
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
        (["share = n / 2", "whole = n // 2"], {"share": "double", "whole": "Py_ssize_t"}),
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
    assert lines[:3] == [
        "cimport cython",
        *[f"from lcpstep.pointers cimport {x}" for x in ("Doubles", "abs")],
    ]
    assert lines[lines.index("cdef inline double total(Doubles x, Py_ssize_t n) noexcept nogil:") + 1 :] == [
        *("    cdef double s", "    cdef Py_ssize_t i", "    s = 0.0", "    for i in range(n):"),
        *("        s += abs(x[i])", "    return s", ""),
    ]


@pytest.mark.parametrize("name", sorted(set(BUILT) - kernel_sources.IN_C))
def test_every_variable_of_a_kernel_is_a_number_or_a_kind_of_kernels(name):
    """A function with a word that is no type would be Python's in silence, and slow."""
    k = kernel_sources.Kernel(ROOT.parent, name)
    for f in k.functions.values():
        kinds = [k.type_of(argument.annotation) for argument in f.args.args]
        if any(kind in ("Doubles", "Indices", "Flags") for kind in kinds):
            assert None not in kinds, f.name


# --- what C says by itself: `lcpstep/pointers.pxd` and others ----------------------------------------------------

INLINE = re.compile(r"cdef inline (?:\w+ )*(?:\w+\*? )(\w+)\((.*)\) noexcept(?: nogil)?:")
NUMBER = re.compile(r"(?:[:,]|double) ([A-Z_]+) (?:= (-?\d+)|\"(.+)\")")


def header(name):
    return BUILT[name].with_suffix(".pxd").read_text()


@pytest.mark.parametrize("name", sorted(kernel_sources.IN_C))
def test_functions_of_c_have_the_arguments_of_pythons(name):
    functions = kernel_sources.Kernel(ROOT.parent, name).functions
    for f, given in INLINE.findall(header(name)):
        if f in functions:  # `max` and `min` are Python's own
            own = [re.split(r"[ *]+", x.strip())[-1] for x in given.split(",")]
            assert own == [argument.arg for argument in functions[f].args.args]


def test_numbers_of_located_are_the_same_in_both_files():
    found = {
        name: int(whole) if whole else float.fromhex(x) if "x" in x else float(x)
        for name, whole, x in NUMBER.findall(header(codes.__name__))
    }
    names = {name for name in vars(codes) if name.isupper()}
    assert found == {name: getattr(codes, name) for name in names}
