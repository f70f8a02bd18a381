"""Whatever numba has made of a user's functions, and however a callback comes to it: checked or refused by name."""

import pickle
import threading
import warnings

import numpy as np
import pytest
from numba import typed

from lagrangian.plain import REPLACED, InPython, python
from lcpstep import Moreau, SimulationError, simulate
from tests import numba_made
from tests.falling import falling
from tests.marks import compiled_only
from tests.numba_made import CHECKED, REFUSED

pytestmark = [
    compiled_only,
    pytest.mark.filterwarnings("ignore::lcpstep.callbacks.UncompiledCallback"),
    pytest.mark.filterwarnings("ignore:First-class function type"),
]


@pytest.mark.parametrize("name", CHECKED)
def test_an_index_out_of_bounds_is_told(name):
    with pytest.raises(
        SimulationError, match=r"^system\.force: .*t = 0\.3.*IndexError: index 10000000 is out of bounds"
    ):
        simulate(falling(CHECKED[name]), Moreau(1e-2))


@pytest.mark.parametrize("name", CHECKED)
def test_the_right_indices_give_the_right_motion(name):
    run = simulate(falling(CHECKED[name], t_end=0.25), Moreau(1e-2))
    assert run.q[-1, 0] == pytest.approx(0.75, abs=1e-12)  # 1 - 4 t^2


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_checked_is_refused_by_name(name):
    force, said = REFUSED[name]
    with pytest.raises((ValueError, SimulationError), match=rf"^system\.force: .*{said}"):
        simulate(falling(force), Moreau(1e-2))


@pytest.mark.slow
def test_a_typed_list_is_read_and_its_indices_are_checked():
    heavy = typed.List([8.0])

    def from_list(t, q, v, p, out):
        out[0] = -heavy[0 if t < 0.3 else 10**7]

    assert simulate(falling(from_list, t_end=0.25), Moreau(1e-2)).q[-1, 0] == pytest.approx(0.75, abs=1e-12)
    with pytest.raises(
        SimulationError, match=r"^system\.force: .*t = 0\.3.*IndexError: list index out of range"
    ):
        simulate(falling(from_list), Moreau(1e-2))


def test_outside_of_callbacks_all_is_as_numba_has_made_it():
    with pytest.raises(ValueError, match="is made by"):
        falling(REFUSED["method"][0])
    assert numba_made.FIELD.item(1) == 8.0
    assert numba_made.generalized(np.array([5.0]), 0) == 5.0


def test_nothing_of_numba_is_changed_when_the_last_callback_is_gone():
    users = [x.users for x in REPLACED]
    run = python(CHECKED["class"])
    out = np.zeros(1)
    run(0.0, None, None, np.array([8.0]), out)
    assert out[0] == -8.0
    assert [x.users for x in REPLACED] == [n + 1 for n in users]
    del run
    assert [x.users for x in REPLACED] == users


def test_other_threads_go_on_with_machine_code():
    found = []

    def elsewhere():
        found.append(numba_made.FIELD.item(2))

    with InPython():
        other = threading.Thread(target=elsewhere)
        other.start()
        other.join()
    assert found == [8.0]


def test_a_vectorized_function_takes_numbers_arrays_and_one_to_fill():
    with InPython():
        filled = np.zeros(2)
        assert numba_made.from_table(1) == 8.0
        np.testing.assert_array_equal(numba_made.from_table(np.array([0, 2])), [8.0, 8.0])
        assert numba_made.from_table(np.array([0, 2]), filled) is filled
    np.testing.assert_array_equal(filled, [8.0, 8.0])


def test_so_does_one_that_has_been_pickled():
    f = pickle.loads(pickle.dumps(numba_made.typed_from_table))
    with InPython():
        assert f(1) == 8.0


# --- arithmetic


def beyond(make):
    """A force that is 8 down, and after 0.3 s what an expression makes of numbers that it is not meant for."""

    def force(t, q, v, p, out):
        out[0] = -8.0 - make(1 if t < 0.3 else 0)

    return force


def quotient(n):
    return 1.0 - 1 // n


def remainder(n):
    return 1 % n


def both(n):
    return 1.0 - divmod(1, n)[0]


def fraction(n):
    return 1e-300 / (1 / n)


def in_place(n):
    k = 1
    k //= n
    return 1.0 - k


@pytest.mark.parametrize("make", [quotient, remainder, both, fraction, in_place])
def test_integers_are_not_divided_by_zero(make):
    with pytest.raises(SimulationError, match=r"^system\.force: .*t = 0\.3.*ZeroDivisionError"):
        simulate(falling(beyond(make)), Moreau(1e-2))


def caught(t, q, v, p, out):
    n = 1 if t < 0.1 else 0
    try:
        k = 8 // n
    except Exception:
        k = 8
    out[0] = -k


def test_what_is_caught_in_the_callback_goes_on():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = simulate(falling(caught, t_end=0.25), Moreau(1e-2))
    assert run.q[-1, 0] == pytest.approx(0.75, abs=1e-12)


def power(n):
    return 2.0 ** (1 - 1) - 2 ** (n - 1)


def product(n):
    return 0.0 * ((2**62 if n == 0 else 1) * 4)


def total(n):
    return 0.0 * ((2**63 - 1 if n == 0 else 1) + 1)


def moved(n):
    return 0.0 * (1 << (70 if n == 0 else 1))


def large_power(n):
    return 0.0 * 10 ** (19 if n == 0 else 18)


def large_negative_power(n):
    return 0.0 * (-2) ** (65 if n == 0 else 63)


@pytest.mark.parametrize("make", [power, product, total, moved, large_power, large_negative_power])
def test_where_machine_code_has_no_such_integer_it_is_told(make):
    with pytest.raises(
        SimulationError, match=r"t = 0\.3.*in machine code only \(integers have 64 bits there\)"
    ):
        simulate(falling(beyond(make)), Moreau(1e-2))


def harmless(n):
    k = 3
    k -= 1
    return (
        0.0 * ((-1) ** k + k**2 + 7 // 2 + (-7) % 3 + (1 << 5) + 2 ** (n + 3))
        + (-7) // 2
        + 4
        + ((-7) % 3 - 2)
    )


def test_other_integers_are_those_of_python_and_compiled():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = simulate(falling(beyond(harmless), t_end=0.25), Moreau(1e-2))
    assert run.q[-1, 0] == pytest.approx(0.75, abs=1e-12)


def never_assigned(t, q, v, p, out):
    if t < 0.3:
        g = 8.0
    out[0] = -g


def test_a_variable_that_was_never_assigned_is_not_zero():
    with pytest.raises(SimulationError, match=r"^system\.force: .*UnboundLocalError"):
        simulate(falling(never_assigned), Moreau(1e-2))
