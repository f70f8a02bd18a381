"""What Python and C read differently, in the sources of kernels; and what a `.pxd` says once more than the `.py`."""

import ast
import importlib.util
import itertools
import math
import re

import numpy as np
import pytest

from lcpstep.kernels import one_row, quadratic, vectors
from lcpstep.stepping.pieces import codes, times
from tests.uncompiled import BUILT, HEADERS, ROOT


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


@pytest.mark.parametrize("name", sorted(BUILT))
def test_a_header_cimports_what_it_names_and_no_more(name):
    lines = header(name).split("\n")
    cimports = [re.match(r"from \S+ cimport (.+)", line) for line in lines]
    rest = "\n".join(line for line in lines if " cimport " not in line)
    names = [x.split()[-1] for found in cimports if found for x in found[1].split(",")]
    assert [x for x in names if not re.search(rf"\b{x}\b", rest)] == []


# --- modules that are merged into others: their functions are written in both files ------------------------------

INLINE = re.compile(r"cdef inline (?:\w+\*? )+(\w+)\((.*)\) noexcept(?: nogil)?:")
NUMBER = re.compile(r"(?:[:,]|double) ([A-Z_]+) (?:= (-?\d+)|\"(.+)\")")
VALUES = [0.0, -0.0, 1.0, -1.0, 0.3, -0.7, 2.5e3, -1e-300, math.inf, -math.inf, math.nan]
IN_C = {"pointers": {"abs", "max", "min", "bits", "double_of"}}  # C's own; "max(a, b)" has no other arguments


def header(name):
    return BUILT[name].with_suffix(".pxd").read_text()


def arguments_in_c(name):
    """Names of the arguments of each function of a `.pxd` file."""
    found = dict(INLINE.findall(header(name)))
    return {f: [re.split(r"[ *]+", x.strip())[-1] for x in given.split(",")] for f, given in found.items()}


def arguments_in_python(name):
    functions = [
        node for node in ast.parse(BUILT[name].read_text()).body if isinstance(node, ast.FunctionDef)
    ]
    return {f.name: [x.arg for x in f.args.args] for f in functions}


def as_python(name):
    """The functions of a `.pxd` file, which are Python but for their types."""
    text = INLINE.sub(lambda m: f"def {m[1]}({', '.join(arguments_in_c(name)[m[1]])}):", header(name))
    text = re.sub(r"^(from .* cimport .*|)$", "", text, flags=re.M)
    text = re.sub(r"cdef (?:double|Py_ssize_t) (\w+ =)", r"\1", text)
    known = {"sqrt": math.sqrt, "abs": abs, "max": max, "min": min, "inf": math.inf, "range": range}
    known |= {x: getattr(codes, x) for x in ("EPS", "LATE")}
    exec(text, known)
    return known


@pytest.mark.parametrize("name", sorted(HEADERS))
def test_functions_have_the_same_arguments_in_both_files(name):
    own = IN_C.get(name.rpartition(".")[2], set())
    in_c, in_python = arguments_in_c(name), arguments_in_python(name)
    assert {f: x for f, x in in_c.items() if f not in own} == {
        f: x for f, x in in_python.items() if f not in own
    }


def test_numbers_of_located_are_the_same_in_both_files():
    found = {
        name: int(whole) if whole else float.fromhex(x) if "x" in x else float(x)
        for name, whole, x in NUMBER.findall(header(codes.__name__))
    }
    names = {name for name in vars(codes) if name.isupper()}
    assert found == {name: getattr(codes, name) for name in names}


def same(a, b):
    return a == b or (math.isnan(a) and math.isnan(b))


@pytest.mark.parametrize("f", [quadratic.first_zero, quadratic.may_reach_zero])
def test_quadratics_are_the_same_in_both_files(f):
    other = as_python(quadratic.__name__)[f.__name__]
    n = len(arguments_in_python(quadratic.__name__)[f.__name__])
    finite = [x for x in VALUES if math.isfinite(x)]
    for given in itertools.product(finite, repeat=n):
        assert same(f(*given), other(*given)), given


@pytest.mark.parametrize("name", sorted(arguments_in_python(vectors.__name__)))
def test_short_loops_are_the_same_in_both_files(name):
    rng = np.random.default_rng(4)
    for size, factor in itertools.product((0, 1, 5), VALUES):
        given = {"n": size, "c": 1, "factor": factor, "least": abs(factor)}
        given |= {x: rng.normal(size=2 * size) for x in ("x", "y", "v")} | {"G": rng.normal(size=2 * size)}
        answers = []
        for f in (getattr(vectors, name), as_python(vectors.__name__)[name]):
            arrays = {k: x.copy() if isinstance(x, np.ndarray) else x for k, x in given.items()}
            arguments = [arrays[k] for k in arguments_in_python(vectors.__name__)[name]]
            with np.errstate(invalid="ignore"):
                answers.append([f(*arguments), *arguments])
        for mine, other in zip(*answers, strict=True):
            np.testing.assert_array_equal(mine, other)


class Written:
    """What a record has written: two rows, and one that is to come."""

    def __init__(self):
        self.row, self.t, self.q, self.v = 2, np.ones(3), np.ones(3), np.ones(3)
        self.length, self.impulse = np.zeros(3), np.zeros(3)


@pytest.mark.parametrize("x", VALUES)
def test_a_kept_state_is_the_same_in_both_files(x):
    answers = []
    for f in (one_row.keep_one, as_python(one_row.__name__)["keep_one"]):
        record, impulse = Written(), np.array([x])
        f(record, x, x, 2.0 * x, 3.0 * x, impulse)
        answers.append([*vars(record).values(), impulse])
    for mine, other in zip(*answers, strict=True):
        np.testing.assert_array_equal(mine, other)


class Piece:
    """A plan, and the work at hand."""

    h, margin, plain, low, high = 0.1, 1e-9, False, 0.2, 0.7


@pytest.mark.parametrize("t", [-1.0, 0.0, 0.2, 0.2 + 1e-9, 0.5, 0.7 - 2e-9, 0.7 - 1e-10, 0.7, 1e9])
def test_times_are_the_same_in_both_files(t):
    piece, other = Piece(), as_python(times.__name__)
    assert times.within(piece, t) == other["within"](piece, t)
    assert times.at_corner(piece, piece, t) == other["at_corner"](piece, piece, t)
    assert times.just_after(piece, t) == other["just_after"](piece, t)
