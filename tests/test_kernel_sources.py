"""What Python and C read differently, in the sources of kernels; and where C says a thing by itself."""

import ast
import importlib.util
import re

import pytest

import kernel_sources
from lcpstep.kernels import roundings
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


# --- how modules are linked ----------------------------------------------------------------------------------------


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


@pytest.mark.parametrize("module", [codes, roundings])
def test_numbers_are_the_same_in_both_files(module):
    found = {
        name: int(whole) if whole else float.fromhex(x) if "x" in x else float(x)
        for name, whole, x in NUMBER.findall(header(module.__name__))
    }
    names = {
        name
        for name in vars(module)
        if name.isupper() and (module is roundings or name not in vars(roundings))
    }
    assert found == {name: getattr(module, name) for name in names}
