"""Lengths at the start of a run by steps, against the formulas written out."""

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep.model import model
from lcpstep.stepping.extent import extent, is_stiff, places, sizes

M = np.array([[2.0, 0.5], [0.5, 1.0]])
C = np.array([[0.1, 0.0], [0.0, 0.2]])
K = np.array([[300.0, -10.0], [-10.0, 200.0]])
PIECE, STEP = 0.05, 0.1
T = 0.3


def frame(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 7.0 * t, 7.0, 0.0
    out[1, 0], out[1, 1], out[1, 2] = 0.0, 0.0, 0.0


def motion(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = -0.5 * 5000.0 * t * t, -5000.0 * t, -5000.0


def scene(**parts):
    system = LinearSystem(M, parts.get("C"), parts.get("K"), parts.get("force"), parts.get("frame"))
    contacts = LinearContacts([[1.0, 0.0]], parts.get("offset", 2000.0), motion=parts.get("motion"))
    return Scene(system=system, contacts=contacts, q0=[0.1, -0.2], v0=[0.3, -8.0], t_span=(T, 1.0))


def found(of, carried=False, pushed=True):
    """The extent of a scene, and its model."""
    m = model(of)
    m.carried = carried
    inverse = np.linalg.inv(M + 0.5 * PIECE * m.arrays["C"] + 0.25 * PIECE**2 * m.arrays["K"])
    return extent(m, T, of.q0, of.v0, STEP, PIECE, inverse, pushed), inverse


@pytest.mark.parametrize(("offset", "largest"), [(2000.0, 2000.0), (0.0, 0.8)])
def test_places_offsets_and_the_way_within_a_step_count(offset, largest):
    of = scene(offset=offset)
    assert found(of)[0] == pytest.approx(largest)
    assert places(model(of), of.q0, of.v0, STEP) == pytest.approx(largest)


def test_obstacles_count_with_how_far_they_go_in_a_piece():
    assert found(scene(offset=0.0, motion=motion))[0] == pytest.approx(
        max(0.5 * 5000 * T * T, 5000 * T * PIECE)
    )


def test_a_frame_counts_where_it_is_carried():
    assert found(scene(offset=0.0, frame=frame), carried=True)[0] == pytest.approx(7.0 * T)


def test_forces_count_as_stiff_springs_let_them():
    force = np.array([1e4, -2e4])
    pushed, inverse = found(scene(offset=0.0, C=C, K=K, force=force))
    assert pushed == pytest.approx(PIECE**2 * np.max(np.abs(inverse) @ np.abs(force)))
    assert found(scene(offset=0.0, C=C, K=K, force=force), pushed=False)[0] == pytest.approx(0.8)


def test_damping_or_a_spring_makes_a_system_stiff():
    assert [is_stiff(model(scene(**x))) for x in ({}, {"C": C}, {"K": K})] == [False, True, True]


def test_sizes_are_of_the_energy_that_a_motion_has_and_comes_to():
    constant, sine = np.array([3.0, -5.0]), np.array([0.5, 0.0])
    of = scene(K=K, C=C, force=Harmonic(constant=constant, sine=sine, omega=2.0))
    q, v, time = np.array(of.q0), np.array(of.v0), 0.25
    far, fast, longest = sizes(model(of), T, of.q0, of.v0, time)
    net = np.abs(constant + sine * np.sin(2.0 * T) - K @ q - C @ v)
    f = net + np.abs(K) @ np.abs(q) + np.abs(C) @ np.abs(v) + np.abs(constant) + np.abs(sine)
    speed = np.sqrt(v @ M @ v) + time * np.sqrt(np.sum(f**2 / M.diagonal()))
    assert (far, fast) == pytest.approx((np.sqrt(q @ M @ q) + time * speed, speed), rel=1e-14)
    assert longest == pytest.approx(0.2 + time * (8.0 + time * np.max(f / M.diagonal())), rel=1e-14)


def test_of_what_rests_without_forces_no_size_is_known():
    of = Scene(LinearSystem(M), [0.1, -0.2], [0.0, 0.0], (0.0, 1.0))
    assert sizes(model(of), 0.0, of.q0, of.v0, 1.0) == (np.inf, np.inf, np.inf)


def rising(t, q, v, p, out):
    out[0], out[1] = np.sin(t), 0.1 + 0.2 - 0.3


def test_forces_by_a_function_tell_no_size_of_what_rests():
    """They may begin at zero, or be what rounding leaves of terms that cancel."""
    of = Scene(LinearSystem(M, force=rising), [0.0, 0.0], [0.0, 0.0], (0.0, 1.0))
    assert sizes(model(of), 0.0, of.q0, of.v0, 1.0) == (np.inf, np.inf, np.inf)
