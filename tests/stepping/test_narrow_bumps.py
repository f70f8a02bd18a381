"""Gaps that are no parabolas over a step: where a step ends within a narrow bump, that is struck, not lifted over."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Scene, System
from lcpstep import Located, simulate


def gap(t, q, v, p, out):
    """A floor with one bump of height 1 and width p[0] at p[1]."""
    out[0] = q[1] - math.exp(-(((q[0] - p[1]) / p[0]) ** 2))


def jacobian(t, q, v, p, out):
    x = (q[0] - p[1]) / p[0]
    out[0, 0] = 2.0 * x / p[0] * math.exp(-x * x)
    out[0, 1] = 1.0


def nothing(t, q, v, p, out):
    out[0] = out[1] = 0.0


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("r", [0.5, 1.0])
def test_a_step_that_ends_within_a_bump_finds_its_impact(order, r):
    rng = np.random.default_rng(3)
    for _ in range(20):
        width, height = 10.0 ** rng.uniform(-3.0, -2.5), rng.uniform(0.2, 0.8)
        place = 0.5 + rng.uniform(-0.3, 0.3) * width  # a step ends at 0.5, within it
        scene = Scene(
            System(n_q=2, mass=np.eye(2), force=nothing), (0.0, height), (1.0, 0.0), (0.0, 0.7),
            Contacts(1, gap, jacobian, restitution=r), p=[width, place],
        )  # fmt: skip
        m = simulate(scene, Located(0.01, order))
        struck = place - width * math.sqrt(-math.log(height))
        assert m.impacts.time[0] == pytest.approx(struck, abs=1e-12)
        slope = 2.0 * (place - struck) / width**2 * height
        normal = np.array([-slope, 1.0]) / math.hypot(slope, 1.0)
        after = np.array([1.0, 0.0]) - (1.0 + r) * normal[0] * normal
        np.testing.assert_allclose(m.v[-1], after, rtol=0, atol=1e-9)


def still(t, q, v, p, out):
    out[0] = 0.0


def bent(t, q, v, p, out):
    """A gap p[0] + p[1] x + p[2] x^2 - p[3] x^2 (x - 0.1), the last term unseen at 0.1; a wall."""
    x = q[0]
    out[0] = p[0] + x * (p[1] + x * (p[2] - p[3] * (x - 0.1)))
    out[1] = p[4] - x


def bent_rows(t, q, v, p, out):
    x = q[0]
    out[0, 0] = p[1] + x * (2.0 * p[2] - p[3] * (3.0 * x - 0.2))
    out[1, 0] = -1.0


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize(
    "p",
    [(2.5e-3 - 1e-8, -0.1, 1.0, 1.0, 0.08), (2.5e-3, -0.03, 0.0, 2.0, 0.086)],
    ids=["never", "later"],
)
def test_a_gap_that_seems_to_close_hides_no_other_that_closes_before_it(order, p):
    contacts = Contacts(2, bent, bent_rows, restitution=1.0)
    scene = Scene(System(1, 1.0, still), 0.0, 1.0, (0.0, 0.1), contacts, p=p)
    run = simulate(scene, Located(0.1, order=order))
    np.testing.assert_allclose(run.impacts.time, [p[4]], rtol=1e-12)
    assert run.impacts.contact.tolist() == [1]
    np.testing.assert_allclose([run.q[-1, 0], run.v[-1, 0]], [2.0 * p[4] - 0.1, -1.0], rtol=1e-12)
