"""What users have compiled is taken with its indices checked, and nothing writes into what is read-only."""

import warnings

import numpy as np
import pytest

from lcpstep import EventDriven, Located, Moreau, SimulationError, Status, simulate
from lcpstep.model import UncompiledCallback
from tests import compiled_helpers
from tests.compiled_helpers import down
from tests.falling import falling
from tests.marks import compiled_only, slow

METHODS = [Moreau(1e-2), Located(1e-2), EventDriven()]
CALLS = []


def by_module(t, q, v, p, out):
    out[0] = -compiled_helpers.item(p, 0 if t < 0.3 else 10**7)


def by_module_uncompiled(t, q, v, p, out):
    CALLS.append(t)
    out[0] = -compiled_helpers.item(p, 0 if t < 0.3 else 10**7)


def recursive(t, q, v, p, out):
    out[0] = -down(p, 0 if t < 0.3 else 10**7, 3)


def plain_helper(x, k):
    return compiled_helpers.item(x, k) + 0.0 * down(x, 0, 1)


def by_a_plain_helper(t, q, v, p, out):
    CALLS.append(t)
    out[0] = -plain_helper(p, 0 if t < 0.3 else 10**7)


@pytest.mark.filterwarnings("ignore::lcpstep.callbacks.UncompiledCallback")
@pytest.mark.parametrize("method", METHODS, ids=repr)
@pytest.mark.parametrize("force", [by_module, by_module_uncompiled, recursive, by_a_plain_helper])
def test_indices_are_checked_however_a_compiled_function_is_reached(force, method):
    with pytest.raises(
        SimulationError, match=r"^system\.force: .*IndexError: index 10000000 is out of bounds"
    ):
        simulate(falling(force), method)


def right_by_module(t, q, v, p, out):
    out[0] = -compiled_helpers.item(p, 0)


def right_recursive(t, q, v, p, out):
    out[0] = -down(p, 0, 3)


@compiled_only
def test_a_compiled_function_of_a_module_is_compiled_again():
    with warnings.catch_warnings():
        warnings.simplefilter("error", UncompiledCallback)
        run = simulate(falling(right_by_module), Moreau(1e-2))
    assert run.q[-1, 0] == pytest.approx(0.0, abs=1e-12)  # 1 - 4 t^2


@compiled_only
def test_a_compiled_function_that_calls_itself_runs_in_plain_python():
    with pytest.warns(UncompiledCallback, match=r"down calls itself \(compiled_helpers\.py, line \d+\)$"):
        run = simulate(falling(right_recursive), Moreau(1e-2))
    assert run.status is Status.DONE
    assert run.q[-1, 0] == pytest.approx(0.0, abs=1e-12)


# --- numba's holes in read-only arrays: at the start plain Python refuses them, and so these wait


def made_contiguous(t, q, v, p, out):
    out[0] = -8.0
    if t > 0.3:
        np.ascontiguousarray(q)[0] = 3.0


def made_by_columns(t, q, v, p, out):
    out[0] = -8.0
    if t > 0.3:
        np.asfortranarray(v)[0] = 3.0


def walked_through(t, q, v, p, out):
    out[0] = -8.0
    if t > 0.3:
        for x, _ in np.nditer((q, v)):
            x[...] = 3.0


def filled_diagonal(t, q, v, p, out):
    out[0] = -8.0
    if t > 0.3:
        np.fill_diagonal(q.reshape(1, 1), 3.0)


def product_into(t, q, v, p, out):
    out[0] = -8.0
    if t > 0.3:
        np.dot(np.eye(1), np.full(1, 3.0), out=q)


def put(x):
    np.ascontiguousarray(x)[0] = 3.0


def by_a_helper(t, q, v, p, out):
    out[0] = -8.0
    if t > 0.3:
        put(p)


HOLES = {
    "ascontiguousarray": made_contiguous, "asfortranarray": made_by_columns, "nditer": walked_through,
    "fill_diagonal": filled_diagonal, "dot": product_into,
}  # fmt: skip


@compiled_only
@pytest.mark.parametrize("name", slow([*HOLES, "helper"], longest=["fill_diagonal"]))
def test_nothing_is_written_into_the_state_through_a_hole(name):
    hole = name if name in HOLES else "ascontiguousarray"
    said = f"through np.{hole} it could write into an array that it may only read"
    with (
        pytest.warns(UncompiledCallback, match=said),
        pytest.raises(SimulationError, match=r"^system\.force: .*(read-only|not acceptable)"),
    ):
        simulate(falling(HOLES.get(name, by_a_helper)), Moreau(1e-2))


def fills(t, q, v, p, out):
    q.fill(3.0) if t > 0.3 else out.fill(-8.0)


@compiled_only
def test_a_method_that_writes_is_named_as_writing():
    with (
        pytest.warns(UncompiledCallback, match="it writes into an array that it may only read"),
        pytest.raises(SimulationError, match="read-only"),
    ):
        simulate(falling(fills), Moreau(1e-2))


@pytest.mark.slow
@compiled_only
def test_the_same_functions_on_arrays_of_its_own_are_compiled():
    def force(t, q, v, p, out):
        matrix = np.ascontiguousarray(np.eye(2)[:, :1])
        np.fill_diagonal(matrix, -8.0)
        np.dot(matrix, np.ones(1))
        np.dot(matrix[:1], np.ones(1), out=out)

    with warnings.catch_warnings():
        warnings.simplefilter("error", UncompiledCallback)
        assert simulate(falling(force), Moreau(1e-2)).q[-1, 0] == pytest.approx(0.0, abs=1e-12)
