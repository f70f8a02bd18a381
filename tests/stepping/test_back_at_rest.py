"""A lift goes far away, comes back to where it began and stops: what it carries has been rounded as far away."""

import numpy as np
import pytest
from scipy import sparse

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import Kind, Moreau, simulate

G, STEP = 9.81, 0.01


def lift(t, q, v, p, out):
    """There with p and -p, back with -p and p, for p[1] each; then at rest."""
    a, T = p[0], p[1]
    s, ds, dds = 0.0, 0.0, 0.0
    if t < T:
        s, ds, dds = 0.5 * a * t * t, a * t, a
    elif t < 3.0 * T:
        r = t - 2.0 * T
        s, ds, dds = a * T * T - 0.5 * a * r * r, -a * r, -a
    elif t < 4.0 * T:
        r = 4.0 * T - t
        s, ds, dds = 0.5 * a * r * r, -a * r, a
    out[0, 0], out[0, 1], out[0, 2] = s, ds, dds


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.parametrize(
    ("speeding", "made"),
    [
        (0.7, np.asarray),
        (1.3, np.asarray),
        (4.7, np.asarray),
        pytest.param(1.3, sparse.csr_array, marks=pytest.mark.slow),
    ],
)
def test_what_a_lift_carries_stays_on_it_where_it_stops(speeding, made):
    """It was let go by 1e-12 m, and sank 3e-4 m into it."""
    quarter = 100.0
    scene = Scene(
        LinearSystem(made(np.eye(1)), force=[-G]), [0.0], [0.0], (0.0, 5.0 * quarter),
        LinearContacts(made(np.eye(1)), 0.0, 0.8, motion=lift), p=[speeding, quarter],
        corners=quarter * np.arange(1.0, 5.0),
    )  # fmt: skip
    run = simulate(scene, Moreau(STEP))
    assert np.all(run.impacts.kind != Kind.RELEASE)
    at_rest = run.t > 4.0 * quarter + 2.0 * STEP
    np.testing.assert_allclose(run.impulse[at_rest, 0], STEP * G, rtol=1e-9)
