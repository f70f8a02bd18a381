"""What Python and C read differently, in the sources of kernels."""

import ast

import pytest

from tests.uncompiled import BUILT


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
