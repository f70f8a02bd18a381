"""Forces that no step size can follow: the run ends with a status that says so, and soon."""

import math
import random
import warnings

import numpy as np
import pytest

from lagrangian import HybridSystem, LinearContacts, LinearSystem, Mode, Scene, System
from lagrangian.hybrid import HybridScene
from lcpstep import EventDriven, Status, simulate

CONTACTS = {
    "none": None,
    "one": LinearContacts(G=1.0, restitution=0.5),
    "several": LinearContacts(G=[[1.0], [-1.0]], offset=[0.0, 10.0], restitution=0.5),
}
every_run = pytest.mark.parametrize("contacts", CONTACTS.values(), ids=CONTACTS)


def noise(t, q, v, p, out):
    out[0] = -9.81 + random.random()


def small_noise(t, q, v, p, out):
    out[0] = -9.81 + 1e-6 * random.random()


def counter():
    calls = []

    def count(t, q, v, p, out):
        calls.append(t)
        out[0] = -9.81 - 1e-3 * len(calls)

    return count


def much_too_fast(t, q, v, p, out):
    out[0] = -9.81 + math.sin(1e14 * t)


def scene(force, contacts, linear=False):
    system = LinearSystem(M=1.0, force=force) if linear else System(1, np.eye(1), force)
    return Scene(system, 1.0, 0.0, (0.0, 2.0), contacts, name="noise")


@every_run
@pytest.mark.parametrize("linear", [False, True], ids=["general", "linear"])
@pytest.mark.parametrize("force", [noise, small_noise, counter()], ids=["noise", "small noise", "counter"])
def test_a_force_that_is_no_function_of_the_state_is_named(force, contacts, linear):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a counter cannot be compiled
        m = simulate(scene(force, contacts, linear), EventDriven())
    assert m.status is Status.STEP_TOO_SMALL
    assert "force must be functions of time and state" in m.message
    assert m.counts.force_evaluations < 1000


@every_run
def test_a_force_that_no_step_resolves_ends_the_run_too(contacts):
    m = simulate(scene(much_too_fast, contacts), EventDriven())
    assert m.status is Status.STEP_TOO_SMALL
    assert "cannot be met" in m.message
    assert "functions" not in m.message
    assert m.counts.force_evaluations < 1_000_000


def noisy_field(t, x, p, out):
    out[0] = random.random()


def test_a_field_that_is_no_function_of_the_state_ends_a_run_of_modes():
    run = simulate(
        HybridScene(HybridSystem(1, {"a": Mode(noisy_field)}), [0.0], "a", (0.0, 1.0)), EventDriven()
    )
    assert run.status is Status.STEP_TOO_SMALL


def square_wave(t, q, v, p, out):
    out[0] = 1.0 if math.sin(2.0 * math.pi * 20.0 * t) > 0.0 else -1.0


@pytest.mark.parametrize("contacts", [None, CONTACTS["several"]], ids=["none", "several"])
def test_jumps_that_nobody_names_are_still_stepped_over(contacts):
    # 400 of them; the motion of each half period is a parabola
    m = simulate(Scene(System(1, np.eye(1), square_wave), 1.0, 0.0, (0.0, 10.0), contacts), EventDriven())
    assert m.status is Status.DONE
    assert m.q[-1, 0] == pytest.approx(1.0 + 10.0 * 0.5 * 0.025, abs=1e-8)
    assert m.v[-1, 0] == pytest.approx(0.0, abs=1e-8)
