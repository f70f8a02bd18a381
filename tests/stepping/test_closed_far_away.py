"""What is pressed stays closed far from where it began: rounding of its coordinates lets no contact go."""

from itertools import permutations

import numpy as np
import pytest
from scipy import sparse

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import Moreau, simulate
from lcpstep.trajectory import Kind

MASSES = np.array([2.26, 0.744, 2.53])
PUSH, DRIFT = -24.8, -0.089375
GAPS = np.array([[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]])


def test_beads_that_are_pushed_along_stay_together():
    """A slow start at zero has but small lengths: gaps are rounded by more than these tell."""
    h = 0.0561
    scene = Scene(
        LinearSystem(np.diag(MASSES), force=[0.0, 0.0, PUSH]), q0=np.zeros(3), v0=np.full(3, DRIFT),
        t_span=(0.0, 200 * h), contacts=LinearContacts(GAPS, 0.0, [0.091, 0.31]),
    )  # fmt: skip
    run = simulate(scene, Moreau(h))
    t, a = run.t[:, None], PUSH / MASSES.sum()
    assert np.max(np.abs(run.q - (DRIFT + 0.5 * a * t) * t)) < 1e-12 * np.max(np.abs(run.q))
    assert np.all(run.impacts.kind != Kind.RELEASE)
    assert np.all(run.impulse[1:] > 0.0)


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.parametrize(
    ("lcp", "made", "steps"),
    [
        ("lemke", np.asarray, 20_000),
        pytest.param("qp", np.asarray, 800, marks=pytest.mark.slow),
        ("lemke", sparse.csr_array, 800),
    ],
)
def test_a_body_that_slides_for_long_stays_on_its_plane(lcp, made, steps):
    """Each step rounds the coordinates alike, so that what opens the gap by rounding adds up."""
    slope, g, h = np.array([0.6, 0.8]), 9.81, 1e-3
    along = np.array([0.8, -0.6])
    scene = Scene(
        LinearSystem(made(np.eye(2)), force=-g * slope), q0=np.zeros(2), v0=3.7 * along, t_span=(0.0, steps * h),
        contacts=LinearContacts(made(slope[None]), 0.0, 0.8),
    )  # fmt: skip
    run = simulate(scene, Moreau(h, lcp=lcp), keep=np.linspace(0.0, steps * h, 11))
    assert run.counts.steps == steps
    assert np.max(np.abs(run.q - 3.7 * run.t[:, None] * along)) < 1e-10
    assert np.all(run.impacts.kind != Kind.RELEASE)


def test_rounding_holds_nothing_that_is_let_go():
    """The push turns round at 1 s: the beads part at the end of that step, as far from the start as they are."""

    def turns_round(t, q, v, p, out):
        out[0], out[1], out[2] = 0.0, 0.0, PUSH if t < 1.0 - 1e-9 else -PUSH

    h = 0.01
    scene = Scene(
        LinearSystem(np.diag(MASSES), force=turns_round), q0=np.zeros(3), v0=np.full(3, -1e3), t_span=(0.0, 1.5),
        contacts=LinearContacts(GAPS, 0.0, 0.0),
    )  # fmt: skip
    run = simulate(scene, Moreau(h))
    away = run.t > 1.0 + 0.5 * h
    assert np.all(run.impulse[away][:, 1] == 0.0)
    assert np.all(np.diff(run.q[away] @ GAPS[1]) > 0.0)
    assert run.impacts.time[run.impacts.kind == Kind.RELEASE][0] == pytest.approx(1.0, abs=1.5 * h)


LIGHT = np.array([2.49, 5.22e-4, 1.05, 96.3])
WALLS = np.array([
    [0.766, -1.85, -0.191, 0.749], [-2.28, -1.47, -0.474, 1.06],
    [-0.72, 0.273, -1.11, 0.00225], [0.248, 0.297, 0.574, 0.13],
])  # fmt: skip
HELD_AT, LOAD = np.array([-1.42, -1.08, 2.13, 1.05]), np.array([3.77, -0.00551, -11.6, -791.0])


@pytest.mark.parametrize("order", list(permutations(range(4))))
def test_a_light_part_under_load_is_not_let_go_by_the_rounding_of_its_velocity(order):
    """Impulses of 36 N s cancel on half a gram: what is left of them opens a gap by rounding, step by step."""
    G = WALLS[list(order)]
    scene = Scene(
        LinearSystem(np.diag(LIGHT), force=LOAD), q0=HELD_AT, v0=np.zeros(4), t_span=(0.0, 0.87),
        contacts=LinearContacts(G, -G @ HELD_AT, 0.0),
    )  # fmt: skip
    run = simulate(scene, Moreau(0.0087))
    assert np.max(np.abs(run.q - HELD_AT)) < 1e-10
    assert np.all(run.impulse[1:] > 0.0)
