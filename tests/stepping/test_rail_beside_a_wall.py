"""A point on a rail, held by two walls of which one is nearly parallel to it.

Along the rail the point has one coordinate: x = 0 where the walls or the force hold it there, and f t^2 / (2 m)
where they do not.
"""

from dataclasses import replace

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearJoints, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Moreau, Status, simulate
from tests.marks import slow

SLOPES = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8]  # of the flat wall on the rail; at 1e-11 it counts as the rail


def drawn(slope, seed):
    """Scene, direction of the rail, mass and force along it, and the sides to which the walls let it go."""
    rng = np.random.default_rng(seed)
    angle, sides = rng.uniform(0.0, 2.0 * np.pi), rng.choice([-1.0, 1.0], 2)
    along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    flat = sides[0] * slope * along + rng.choice([-1.0, 1.0]) * across
    steep = sides[1] * rng.choice([0.3, 1.0]) * along + rng.uniform(-1.0, 1.0) * across
    masses, force = 10.0 ** rng.uniform(-2.0, 2.0, 2), rng.normal(size=2)
    scene = Scene(
        LinearSystem(M=np.diag(masses), force=force),
        q0=np.zeros(2),
        v0=np.zeros(2),
        t_span=(0.0, 1.0),
        contacts=LinearContacts([flat, steep], offset=[0.0, 0.0], restitution=0.5),
        joints=LinearJoints([across], [0.0]),
    )
    return scene, along, float(masses @ along**2), float(force @ along), sides


def with_functions(scene):
    """The same, its force a function of which nobody knows that it is constant."""
    constant, _, _ = scene.system.force.terms(2)

    def force(t, q, v, p, out):
        out[0], out[1] = constant[0], constant[1]

    return replace(scene, system=System(2, scene.system.M, force))


def off(scene, along, mass, force, sides, slope, m):
    """How far a run is off, by what may be: the row itself is known to 1e-16 / slope."""
    free = np.all(sides * force > 0.0)
    exact = 0.5 * force / mass * m.t**2 if free else np.zeros_like(m.t)
    return np.max(np.abs(m.q @ along - exact)) / ((1e-12 + 1e-15 / slope) * 0.5 * abs(force) / mass)


@pytest.mark.parametrize("slope", slow(SLOPES, longest=SLOPES[::2]))
@pytest.mark.parametrize(
    ("method", "general"),
    [
        (Located(1e-2, order=4), False),
        (Located(1e-2, tolerance=1e-6), False),
        (EventDriven(max_events=100), False),
        (EventDriven(max_events=100), True),
    ],
)
def test_a_wall_that_is_nearly_the_rail_s_own_holds_the_point_or_lets_it_go(slope, method, general):
    for seed in range(12):
        drawn_so = drawn(slope, seed)
        m = simulate(with_functions(drawn_so[0]) if general else drawn_so[0], method)
        assert m.status == Status.DONE, (seed, m.message)
        assert off(*drawn_so, slope, m) <= 1.0, seed


@pytest.mark.parametrize("slope", slow(SLOPES, longest=SLOPES[1::2]))
@pytest.mark.parametrize("general", [False, True])
def test_where_rounding_leaves_nothing_of_the_wall_a_run_says_so(slope, general):
    """Steps of one size put positions back onto both rows."""
    for seed in range(24):
        drawn_so = drawn(slope, seed)
        scene = with_functions(drawn_so[0]) if general else drawn_so[0]
        m = simulate(scene, Located(1e-2))
        if slope > 3e-7:
            assert m.status == Status.DONE, (seed, m.message)
        if m.status == Status.DONE:
            assert off(*drawn_so, slope, m) <= 2.0, seed
        else:
            assert m.status in (Status.LCP_FAILED, Status.PROJECTION_FAILED)


@pytest.mark.parametrize("slope", SLOPES)
def test_moreau_s_steps_hold_it_as_far_as_positions_do(slope):
    """Steps keep velocities on the rail and not positions, of whose rounding the flat wall sees 1 / slope."""
    for seed in range(24):
        drawn_so = drawn(slope, seed)
        m = simulate(drawn_so[0], Moreau(1e-2))
        if slope > 3e-7:
            assert m.status == Status.DONE, (seed, m.message)
            assert off(*drawn_so, slope, m) <= 1.0 / slope, seed
        else:
            assert m.status in (Status.DONE, Status.LCP_FAILED)
            assert m.status == Status.LCP_FAILED or off(*drawn_so, slope, m) <= 1.0 / slope, seed
