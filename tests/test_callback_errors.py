"""Callbacks that reach beyond their arrays or raise: told as they are, and never a danger to the process."""

import numba
import numpy as np
import pytest

from lagrangian import Guard, HybridScene, HybridSystem, Mode
from lcpstep import EventDriven, Located, Moreau, SimulationError, simulate
from lcpstep.model import UncompiledCallback
from lcpstep.trajectory import Status
from tests.falling import falling, falls

METHODS = [Moreau(1e-2), Located(1e-2), EventDriven()]
IDS = ["moreau", "located", "event-driven"]
TABLE = np.arange(4.0)


# --- indices


def reads_beyond(t, q, v, p, out):
    out[0] = -p[1] if t > 0.3 else -8.0


def writes_far_before(t, q, v, p, out):
    out[0] = -8.0
    if t > 0.3:
        out[-5] = 7.0


def writes_far_beyond(t, q, v, p, out):
    out[0] = -8.0
    if t > 0.3:
        out[10**7] = 7.0


def table_of_positions(t, q, v, p, out):
    out[0] = -8.0 + 0.0 * TABLE[int(10.0 * (1.0 - q[0]))]


def helper(x, k):
    return x[k]


def helper_reads_beyond(t, q, v, p, out):
    out[0] = -helper(p, 1 if t > 0.3 else 0)


@numba.njit
def users_own(x, k):
    return x[k]


def compiled_helper_reads_beyond(t, q, v, p, out):
    out[0] = -users_own(p, 1 if t > 0.3 else 0)


BEYOND = {
    "read": (reads_beyond, 1), "before": (writes_far_before, -5), "beyond": (writes_far_beyond, 10**7),
    "table": (table_of_positions, 4), "helper": (helper_reads_beyond, 1),
    "compiled helper": (compiled_helper_reads_beyond, 1),
}  # fmt: skip


@pytest.mark.parametrize("method", METHODS, ids=IDS)
@pytest.mark.parametrize("name", BEYOND)
def test_an_index_out_of_bounds_is_named_with_callback_and_state(name, method):
    force, index = BEYOND[name]
    said = rf"^system\.force: .*t = 0\.3\d*, q = \[0\.\d+\], v = \[-\d.*: IndexError: index {index} is out of bounds"
    with pytest.raises(SimulationError, match=said) as caught:
        simulate(falling(force), method)
    assert caught.value.trajectory.status is Status.NOT_FINITE
    assert 0.25 <= caught.value.trajectory.t[-1] <= 0.35


def test_an_index_out_of_bounds_at_the_start_is_named_when_the_scene_is_made():
    with pytest.raises(ValueError, match=r"^system\.force: .*IndexError: index 4 is out of bounds"):
        falling(lambda t, q, v, p, out: out.fill(p[4]))


def test_indices_from_the_end_are_those_of_python():
    def last(t, q, v, p, out):
        out[-1] = -p[-1]

    assert simulate(falling(last), Moreau(1e-2)).q[-1, 0] == pytest.approx(0.0, abs=1e-12)


def beyond_flat(t, q, v, p, out):
    out.flat[0 if t < 0.3 else 10**7] = -8.0


def counts_negatives(t, q, v, p, out):
    out[0] = -8.0 * np.bincount(np.array([0 if t < 0.3 else -5, 1]))[1]


def deletes_beyond(t, q, v, p, out):
    out[0] = -8.0 + 0.0 * np.delete(q, np.array([0 if t < 0.3 else 10**7])).size


remove = np.delete


def deletes_by_another_name(t, q, v, p, out):
    out[0] = -8.0 + 0.0 * remove(q, np.array([0 if t < 0.3 else 10**7])).size


def strides_beyond(t, q, v, p, out):
    out[0] = -8.0 + 0.0 * np.lib.stride_tricks.as_strided(q, (1,), (8,))[0 if t < 0.3 else 10**7]


UNCHECKED = {
    "flat": [beyond_flat], "bincount": [counts_negatives], "delete": [deletes_beyond, deletes_by_another_name],
    "as_strided": [strides_beyond],
}  # fmt: skip


@pytest.mark.parametrize(("name", "force"), [(name, f) for name, forces in UNCHECKED.items() for f in forces])
def test_what_numba_does_not_check_runs_in_plain_python(name, force):
    said = rf"does not check the indices of '{name}' \(test_callback_errors.py, line"
    with (
        pytest.warns(UncompiledCallback, match=said),
        pytest.raises(SimulationError, match=r"^system\.force: .*(IndexError|ValueError)"),
    ):
        simulate(falling(force), Moreau(1e-2))


def writes_into_the_state(t, q, v, p, out):
    out[0] = -8.0
    if t > 0.3:
        q[0] = 3.0


def test_writing_into_the_state_is_refused_where_it_happens():
    with (
        pytest.warns(UncompiledCallback, match="may only read"),
        pytest.raises(SimulationError, match=r"^system\.force: .*read-only"),
    ):
        simulate(falling(writes_into_the_state), Moreau(1e-2))


# --- exceptions


def raises_once(t, q, v, p, out):
    out[0] = -8.0
    if 0.3 < t < 0.302:
        raise KeyError("only here")


def asserts(t, q, v, p, out):
    assert t < 0.3, "too late"
    out[0] = -8.0


def tells_the_time(t, q, v, p, out):
    out[0] = -8.0
    if t > 0.3:
        raise ValueError("late", t)


@pytest.mark.parametrize("method", METHODS, ids=IDS)
@pytest.mark.parametrize(
    ("force", "said"), [(asserts, "AssertionError"), (tells_the_time, r"ValueError: \('late', 0\.3")]
)
def test_exceptions_of_callbacks_are_told_as_they_are(force, said, method):
    with pytest.raises(SimulationError, match=rf"^system\.force: .*{said}"):
        simulate(falling(force), method)


def test_an_exception_is_not_passed_over_where_the_method_could_have_gone_on():
    with pytest.raises(SimulationError, match="only here"):
        simulate(falling(raises_once, t_end=0.301), EventDriven())
    assert simulate(falling(raises_once), Moreau(1e-2)).status is Status.DONE  # it is never asked there


def test_an_exception_of_one_run_is_not_that_of_the_next():
    with pytest.raises(SimulationError):
        simulate(falling(reads_beyond), Moreau(1e-2))
    assert simulate(falling(falls), Moreau(1e-2)).status is Status.DONE


@pytest.mark.parametrize("method", METHODS, ids=IDS)
def test_an_exception_of_a_run_that_a_callback_makes_is_that_run_s_alone(method):
    tried = []

    class Foresees:
        def __call__(self, t, q, v, p, out):
            out[0] = -8.0
            if len(tried) < 3:
                tried.append(t)
                with pytest.raises(SimulationError):
                    simulate(falling(tells_the_time), method)

    foreseen, fallen = simulate(falling(Foresees()), method), simulate(falling(falls), method)
    assert foreseen.status is Status.DONE
    np.testing.assert_array_equal(foreseen.q, fallen.q)


def test_a_function_of_a_system_with_modes_that_raises_is_named():
    def decays(t, x, p, out):
        out[0] = -x[0] * p[0 if t < 0.3 else 7]

    def far(t, x, p, out):
        out[0] = x[0] - 10.0

    system = HybridSystem(1, {"on": Mode(decays, [Guard(far, "on")])})
    said = r"field of mode 'on': f\(t, x, p, out\) with x of shape \(1,\), .*, x = \[0\.\d+\]: IndexError: index 7"
    with pytest.raises(SimulationError, match=said):
        simulate(HybridScene(system, 1.0, "on", (0.0, 1.0), p=[1.0]), EventDriven())
