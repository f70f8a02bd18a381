"""Contacts that depend on each other: forces and impulses of several that do the same."""

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System
from lcpstep import Located, Status, simulate

SPAN = (0.0, 1.0)
FEET = np.array([[1.0, -0.5], [1.0, -0.2], [1.0, 0.1], [1.0, 0.4], [1.0, 0.5]])


def swing(t, q, v, p, out):
    out[0], out[1] = -9.81, 0.3 * np.sin(7.0 * t)


def gaps(t, q, v, p, out):
    for k in range(5):
        out[k] = q[0] + p[k] * q[1]


def normals(t, q, v, p, out):
    for k in range(5):
        out[k, 0], out[k, 1] = 1.0, p[k]


def table(general):
    """A table on five feet in a row, turned to and fro by a moment that no foot lets it follow."""
    x = FEET[:, 1]
    inertia = np.diag([1.0, 0.1])
    named = {f"x{k}": x[k] for k in range(5)}
    if general:
        return Scene(
            System(2, inertia, swing),
            [0.0, 0.0],
            [0.0, 0.0],
            SPAN,
            contacts=Contacts(5, gaps, normals),
            parameters=named,
        )
    return Scene(
        LinearSystem(M=inertia, force=swing), [0.0, 0.0], [0.0, 0.0], SPAN, contacts=LinearContacts(G=FEET)
    )


@pytest.mark.parametrize("general", [False, True])
@pytest.mark.parametrize(
    ("order", "tolerance", "error"), [(2, None, 1e-4), (4, None, 1e-7), (2, 1e-4, 2e-3), (4, 1e-6, 1e-7)]
)
def test_no_more_feet_bear_than_carry_the_table(general, order, tolerance, error):
    """A tolerance holds positions and velocities; forces that move nothing are as exact as steps are short."""
    m = simulate(table(general), Located(0.01 if tolerance is None else 0.2, order, tolerance=tolerance))
    assert m.message == "reached the end of the span"
    np.testing.assert_allclose(m.q, 0.0, rtol=0, atol=1e-15)
    pressed = m.impulse[1:] > 0.0
    assert np.max(np.sum(pressed, axis=1)) <= 3  # two at a time, and one in its turn within a step
    assert m.counts.steps < 300
    given = np.sum(m.impulse, axis=0) @ FEET
    truth = [9.81, -0.3 * (1.0 - np.cos(7.0)) / 7.0]
    np.testing.assert_allclose(given, truth, rtol=0, atol=error)


def test_steps_by_a_tolerance_do_not_depend_on_what_is_kept():
    scene = table(general=False)
    at = np.linspace(*SPAN, 23)
    method = Located(0.2, tolerance=1e-5)
    full, some = simulate(scene, method), simulate(scene, method, keep=at)
    assert full.counts.steps == some.counts.steps
    np.testing.assert_allclose(np.sum(some.impulse, axis=0), np.sum(full.impulse, axis=0), rtol=0, atol=1e-13)


def test_thousands_of_elastic_impacts_at_one_instant_keep_the_energy():
    """Seven walls that leave a point no room: it is thrown to and fro for ever, and no faster."""
    G = [
        [0.371, 0.751, -2.18], [0.661, -0.726, -0.664], [-0.555, 2.41, 0.938], [-0.398, -0.986, 0.584],
        [0.225, -0.263, -1.13], [-0.79, 0.748, -0.327], [0.223, -1.09, 0.706],
    ]  # fmt: skip
    walls = LinearContacts(G=G, restitution=1.0)
    scene = Scene(LinearSystem(M=np.eye(3)), np.zeros(3), [0.455, -1.04, -0.151], (0.0, 0.1), contacts=walls)
    for order in (2, 4, "exact"):
        m = simulate(scene, Located(0.1, order, max_events=5000))
        assert m.status == Status.TOO_MANY_EVENTS
        assert m.impacts.time[-1] == 0.0
        assert m.v[-1] @ m.v[-1] == pytest.approx(m.v[0] @ m.v[0], rel=1e-12)


BETWEEN_WALLS = np.array([[-1.0, 1, 0, 0], [0, -1, 1, 0], [0, 0, -1, 1], [1, 0, 0, 0], [0, 0, 0, -1]])


def shaken(t, q, v, p, out):
    s, c = np.sin(3.4 * t), np.cos(3.4 * t)
    for i in range(4):
        out[i, 0], out[i, 1], out[i, 2] = p[i] * s, 3.4 * p[i] * c, -3.4 * 3.4 * p[i] * s


def wedged_beads(seed):
    """Beads that touch each other and both walls, coupled by springs, each shaken by itself and the first pushed."""
    rng = np.random.default_rng(seed)
    root, places = rng.normal(size=(4, 4)), 1e-3 * rng.uniform(size=4)
    beads = LinearSystem(M=np.eye(4), K=root @ root.T, force=(-9.81, 0.0, 0.0, 0.0), frame=shaken)
    walls = LinearContacts(BETWEEN_WALLS)
    named = {f"a{i}": x for i, x in enumerate(places)}
    return Scene(beads, np.zeros(4), np.zeros(4), (0.0, 3.0), contacts=walls, parameters=named)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(
    "method",
    [Located(0.016), Located(0.016, 4), Located(0.1, tolerance=1e-4), Located(0.1, 4, tolerance=1e-6)],
    ids=str,
)
def test_what_is_held_from_all_sides_rests_though_rounding_asks_for_what_cannot_be(method, seed):
    """All normals add up to zero: no forces hold accelerations, or speeds, whose sum is below it by a rounding."""
    m = simulate(wedged_beads(seed), method)
    assert m.status == Status.DONE
    np.testing.assert_allclose(m.q, 0.0, rtol=0, atol=1e-13)
