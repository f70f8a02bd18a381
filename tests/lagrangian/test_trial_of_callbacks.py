"""Every callback of a scene is tried at the start: one that does not fit is named."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, HybridScene, HybridSystem, LinearContacts, LinearSystem, Mode, Scene, System
from tests.lagrangian.ball import height, scene, upward


def returns(t, q, v, p, out):
    out.fill(1.0)
    return out


def not_a_number(t, q, v, p, out):
    out.fill(math.nan)


def forgets(t, q, v, p, out):
    pass


def too_many(t, q, v, p, out):
    out.fill(1.0)
    out.flat[out.size] = 1.0


def wrong_shape(t, q, v, p, out):
    out[:] = np.ones(out.size + 1)


def wrong_dimension(t, q, v, p, out):
    out[0, 0, 0] = 1.0


def reads_too_far(t, q, v, p, out):
    out.fill(q[len(q)])


def reads_missing_parameter(t, q, v, p, out):
    out.fill(p[0])


def wrong_signature(t, q):
    pass


def divides_by_zero(t, q, v, p, out):
    out.fill(1.0 / (t * 0.0))


BAD = [
    returns, not_a_number, forgets, too_many, wrong_shape, wrong_dimension, reads_too_far, reads_missing_parameter,
    wrong_signature, divides_by_zero,
]  # fmt: skip


def one(t, q, v, p, out):
    out.fill(1.0)


PLACES = {
    "system.force": lambda f: {"system": LinearSystem(M=1.0, force=f)},
    "system.frame": lambda f: {"system": LinearSystem(M=1.0, frame=f)},
    "contacts.motion": lambda f: {"contacts": LinearContacts(G=1.0, motion=f)},
    "contacts.gap": lambda f: {"contacts": Contacts(n_c=1, gap=f, jacobian=upward)},
    "contacts.jacobian": lambda f: {"contacts": Contacts(n_c=1, gap=height, jacobian=f)},
    "contacts.gap_t": lambda f: {"contacts": Contacts(n_c=1, gap=height, jacobian=upward, gap_t=f)},
    "contacts.bias": lambda f: {"contacts": Contacts(n_c=1, gap=height, jacobian=upward, bias=f)},
    "system.mass": lambda f: {"system": System(n_q=1, mass=f, force=one)},
    "system.force_q": lambda f: {"system": System(n_q=1, mass=1.0, force=one, force_q=f)},
    "system.force_v": lambda f: {"system": System(n_q=1, mass=1.0, force=one, force_v=f)},
}


@pytest.mark.parametrize("bad", BAD, ids=lambda f: f.__name__)
@pytest.mark.parametrize("place", PLACES)
def test_a_callback_that_does_not_fit_is_named(place, bad):
    with pytest.raises(ValueError, match=rf"^{place}: "):
        scene(**PLACES[place](bad))


def test_a_callback_of_a_general_system_is_named():
    with pytest.raises(ValueError, match=r"^system\.force: "):
        scene(system=System(n_q=1, mass=1.0, force=returns))


def test_errors_of_callbacks_say_time_and_state():
    with pytest.raises(ValueError, match=r"^system\.force: .*t = 0, q = \[1\.0\], v = \[0\.0\]"):
        scene(system=LinearSystem(M=1.0, force=not_a_number))


def test_a_mass_function_must_be_definite_at_the_start():
    def negative(t, q, v, p, out):
        out[0, 0] = -1.0

    with pytest.raises(ValueError, match=r"^system\.mass: .*positive definite"):
        scene(system=System(n_q=1, mass=negative, force=one))


@pytest.mark.parametrize("k", range(3))
def test_a_callback_that_writes_into_what_it_is_shown_is_refused(k):
    def careless(t, q, v, p, out):
        (q, v, p)[k][0] = -5.0
        out[0] = 0.0

    with pytest.raises(ValueError, match=r"^system\.force: .*read-only; q, v and p are not the callback's"):
        scene(system=LinearSystem(M=1.0, force=careless), p=[1.0])


def swapped(t, v, q, p, out):
    out.fill(-9.81 - 5.0 * q[0])


def field(x, t, p, out):
    out[0] = 1.0


@pytest.mark.parametrize("place", PLACES)
def test_arguments_of_the_right_names_in_another_order_are_refused(place):
    """Coordinates and velocities have one shape: each was taken for the other, in silence."""
    with pytest.raises(
        ValueError, match=rf"^{place}: expected f\(t, q, v, p, out\), got f\(t, v, q, p, out\)$"
    ):
        scene(**PLACES[place](swapped))


def test_those_of_a_mode_too():
    system = HybridSystem(n_x=1, modes={"on": Mode(field)})
    with pytest.raises(
        ValueError, match=r"^field of mode 'on': expected f\(t, x, p, out\), got f\(x, t, p, out\)$"
    ):
        HybridScene(system, [0.0], "on", (0.0, 1.0))


def of_two(t, q, v, p, out):
    out[0, 0] = out[1, 1] = 1.0


def test_zeros_that_are_not_filled_are_asked_for():
    with pytest.raises(
        ValueError,
        match=r"^system\.mass: .*nan.*; every entry is to be set, as out\[0\] = \.\.\., zeros too$",
    ):
        Scene(System(n_q=2, mass=of_two, force=one), [0.0, 0.0], [0.0, 0.0], (0.0, 1.0))


def by_name(t, q, v, p, out):
    out[0] = -p["g"]


def test_parameters_asked_for_by_name_are_told_to_have_places():
    with pytest.raises(ValueError, match=r"^system\.force: .*; p holds numbers by their places"):
        Scene(System(n_q=1, mass=1.0, force=by_name), [0.0], [0.0], (0.0, 1.0), parameters={"g": 9.81})
