"""What a user writes into a callback: taken as it is, or in plain Python with a word on the line and why."""

import functools
import warnings

import numba
import numpy as np
import pytest

from lcpstep import Moreau, simulate
from lcpstep.model import UncompiledCallback
from tests.falling import falling, falls
from tests.marks import compiled_only, slow
from tests.processes import python

CONSTANTS = {"g": 8.0}
GRAVITY = 8.0
PAIR = ([4.0], 1)  # what numba does not freeze


# --- what is written, and how it is taken


def with_default(t, q, v, p, out, g=8.0):
    out[0] = -g


def by_keyword(t, q, v, p, out, *, g=8.0):
    out[0] = -g


def with_g_first(g, t, q, v, p, out):
    out[0] = -g


def with_two_more(t, q, v, p, out, a, b=1.0):
    out[0] = -a * b


def lists(t, q, v, p, out):
    x = [-8.0, t]
    out[0] = x[0]


def solves(t, q, v, p, out):
    out[0] = -8.0 * np.linalg.solve(np.eye(2), np.ones(2))[0]


def stars(*arguments):
    arguments[4][0] = -8.0


def around(g, f):
    values = np.array([0.0, g])

    def inner(t, q, v, p, out):
        out[0] = -f(values[1])

    return inner


class Field:
    g = 8.0

    def method(self, t, q, v, p, out):
        out[0] = -self.g

    def __call__(self, t, q, v, p, out):
        out[0] = -self.g

    @staticmethod
    def static(t, q, v, p, out):
        out[0] = -8.0


def reads_a_dictionary(t, q, v, p, out):
    out[0] = -CONSTANTS["g"]


def imports(t, q, v, p, out):
    import math as m

    out[0] = -m.sqrt(64.0)


def as_it_is(f):
    @functools.wraps(f)
    def wrapper(*arguments, **named):
        return f(*arguments, **named)

    return wrapper


@as_it_is
def decorated(t, q, v, p, out):
    out[0] = -8.0


def factorial(n):
    return 1 if n < 2 else n * factorial(n - 1)


def recurses(t, q, v, p, out):
    out[0] = -8.0 * factorial(1)


COMPILED = {
    "default": with_default, "keyword": by_keyword, "partial": functools.partial(with_g_first, 8.0),
    "partial by keyword": functools.partial(with_two_more, a=4.0, b=2.0), "lists": lists, "solve": solves,
    "stars": stars, "closure": around(8.0, lambda x: x), "static": Field.static, "njit": numba.njit(falls),
    "lambda": lambda t, q, v, p, out: out.fill(-8.0),
    "partial of njit": functools.partial(numba.njit(with_g_first), 8.0),
}  # fmt: skip


def beside(numbers):
    def force(t, q, v, p, out):
        out[0] = numbers[0]

    return force


def beside_with_default(numbers):
    def force(t, q, v, p, out, scale=1.0):
        out[0] = scale * numbers[0]

    return force


PLAIN = {
    "list around it": (beside([-8.0]), "it reads 'numbers' from the function around it"),
    "list around it, and a default": (beside_with_default([-8.0]), "it reads 'numbers' from the function around it"),
    "dictionary": (reads_a_dictionary, "'CONSTANTS'"), "import": (imports, "IMPORT_NAME"),
    "method": (Field().method, "is a method"), "object": (Field(), "an object of class Field"),
    "recursion": (recurses, "factorial calls itself"),
    "decorated": (decorated, "decorated takes any arguments by keyword"),
}  # fmt: skip


@pytest.mark.parametrize("name", slow(COMPILED, longest=("solve",)))
def test_a_callback_of_any_make_is_compiled(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error", UncompiledCallback)
        m = simulate(falling(COMPILED[name]), Moreau(1e-2))
    assert m.q[-1, 0] == pytest.approx(0.0, abs=1e-12)  # 1 - 4 t^2


READ_BACK = """
import warnings
from lcpstep import Moreau, simulate
from lcpstep.model import UncompiledCallback
from tests.falling import falling
from tests.test_callbacks import COMPILED

warnings.simplefilter("error", UncompiledCallback)
for name in ("default", "partial by keyword"):
    simulate(falling(COMPILED[name], t_end=0.1), Moreau(1e-2))
"""


@pytest.mark.slow
@compiled_only
def test_callbacks_with_more_arguments_are_read_back_from_where_they_were_kept():
    for _ in range(2):
        assert python(READ_BACK) == ""


@compiled_only
@pytest.mark.parametrize("name", PLAIN)
def test_what_cannot_be_compiled_says_once_which_line_and_why(name):
    force, why = PLAIN[name]
    scene = falling(force, t_end=0.1)
    with pytest.warns(
        UncompiledCallback, match=rf"^force of scene .*{why}.* \(test_callbacks\.py, line \d+\)$"
    ):
        m = simulate(scene, Moreau(1e-2))
    assert m.q[-1, 0] == pytest.approx(1.0 - 4.0 * 0.01, abs=1e-12)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate(scene, Moreau(1e-2))


def test_a_default_that_changes_is_another_function():
    for g in (8.0, 2.0):

        def force(t, q, v, p, out, g=g):
            out[0] = -g

        assert simulate(falling(force), Moreau(1e-2)).v[-1, 0] == pytest.approx(-0.5 * g)


def reads_gravity(t, q, v, p, out):
    out[0] = -GRAVITY


def test_new_code_of_a_function_is_heard_with_what_it_reads(monkeypatch):
    """As IPython's autoreload gives it, where a module has been edited."""

    def force(t, q, v, p, out):
        out[0] = -8.0

    assert simulate(falling(force), Moreau(1e-2)).v[-1, 0] == pytest.approx(-4.0)
    monkeypatch.setattr(force, "__code__", reads_gravity.__code__, raising=False)
    for g in (2.0, 6.0):
        monkeypatch.setitem(globals(), "GRAVITY", g)
        assert simulate(falling(force), Moreau(1e-2)).v[-1, 0] == pytest.approx(-0.5 * g)


def looked_up():
    return CONSTANTS["g"]


def between():
    return looked_up()


def calls_two_deep(t, q, v, p, out):
    out[0] = -between() - PAIR[0][0]


@compiled_only
def test_what_could_not_be_compiled_is_tried_again_where_it_reads_or_calls_something_else(monkeypatch):
    from lcpstep.callbacks import NotCompiled, compiling

    for name, other in (("looked_up", lambda: 4.0), ("PAIR", ((4.0,), 1))):
        with pytest.raises(NotCompiled):
            compiling.address(calls_two_deep, 1)
        monkeypatch.setitem(globals(), name, other)
    assert compiling.address(calls_two_deep, 1) != 0


PRINTING = """
from lagrangian import Scene, System
from lcpstep import EventDriven, Moreau, simulate

def told(t):
    if t == 0.0:
        print("nested", t)
    return 8.0

def force(t, q, v, p, out):
    out[0] = -told(t)
    if t == 0.0:
        print("at", t, q[0], p)

for method in Moreau(0.1), EventDriven():
    print(simulate(Scene(System(1, 1.0, force), 1.0, 0.0, (0.0, 0.5), p=[3.0]), method).status.name)
"""


@pytest.mark.slow
def test_a_callback_may_print(tmp_path):
    (tmp_path / "printing.py").write_text(PRINTING)
    for _ in range(2):  # the second process finds the machine code on disk
        lines = python(f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import printing").split("\n")
        assert lines.count("DONE") == 2
        assert lines.count("at 0.0 1.0 [3.]") >= 3
        assert lines.count("nested 0.0") >= 3
