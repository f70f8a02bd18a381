"""`Located` "exact" where gaps are as small as the rounding of positions: chattering, and a wall just touched."""

import mpmath
import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Located, simulate

MASS, STIFFNESS = (0.75, 0.674, 1.84), ((11.0, -11.1, -35.8), (-11.1, 26.3, 20.2), (-35.8, 20.2, 206.0))
WEIGHT, WALLS = (0.0, 0.0, -18.1), ((0.0996, 0.0555, 0.993), (-0.48, 0.861, 0.171), (-0.788, -0.439, 0.431))
OFFSETS, RESTITUTION = (-2.4007030000000005, 2.289078, 0.9804380000000001), 0.68
PLACE, VELOCITY = (2.52, -0.838, 2.24), (0.887, 0.322, -0.204)


@pytest.fixture(scope="module")
def corner():
    """Three coordinates between three walls: they chatter at the first one, 2.5 m from where they are measured."""
    system = LinearSystem(M=np.diag(MASS), K=STIFFNESS, force=Harmonic(constant=WEIGHT))
    walls = LinearContacts(G=WALLS, offset=OFFSETS, restitution=RESTITUTION)
    return Scene(system=system, contacts=walls, q0=PLACE, v0=VELOCITY, t_span=(0.0, 0.1097))


@pytest.fixture(scope="module")
def impulses(corner):
    """Those of the sequence of contacts that the event-driven run names, to forty digits."""
    struck = simulate(corner, EventDriven()).impacts
    with mpmath.workdps(40):
        K, G, f = (mpmath.matrix(x) for x in (STIFFNESS, WALLS, WEIGHT))
        G_M = G * mpmath.diag([1 / mpmath.mpf(m) for m in MASS])
        q, v, t, found = mpmath.matrix(PLACE), mpmath.matrix(VELOCITY), mpmath.mpf(0), []
        for row in struck:
            c = int(row.contact)
            terms = taylor(q, v, K, f)
            tau = mpmath.findroot(lambda x, z=terms, c=c: (G[c, :] * at(z, x))[0] + OFFSETS[c], row.time - t)
            q, v, t = at(terms, tau), velocity(terms, tau), t + tau
            p = -(1 + mpmath.mpf(RESTITUTION)) * (G[c, :] * v)[0] / (G_M[c, :] * G[c, :].T)[0]
            v += G_M[c, :].T * p
            found.append(float(p))
    return np.array(found)


def taylor(q, v, K, f):
    """Coefficients of the free motion."""
    terms = [q, v]
    for k in range(38):
        force = -K * terms[k] + (f if k == 0 else mpmath.zeros(3, 1))
        terms.append(mpmath.diag([1 / mpmath.mpf(m) for m in MASS]) * force / ((k + 1) * (k + 2)))
    return terms


def at(terms, tau):
    """The place at a time."""
    return sum((z * tau**k for k, z in enumerate(terms)), mpmath.zeros(3, 1))


def velocity(terms, tau):
    """The velocity at a time."""
    return sum((k * z * tau ** (k - 1) for k, z in enumerate(terms) if k), mpmath.zeros(3, 1))


@pytest.mark.parametrize("h", [0.0024834285714285713, 0.0034, 0.00656])
def test_hops_that_steps_divide_keep_the_digits_of_their_speed(corner, impulses, h):
    run = simulate(corner, Located(h, "exact"))
    assert len(run.impacts) == len(impulses) == 24
    np.testing.assert_allclose(run.impacts.impulse[-8:], impulses[-8:], rtol=2e-11)


@pytest.mark.parametrize("parts", [3, 10, 19, 27, 40, 57])
def test_a_wall_that_is_touched_after_a_whole_period_is_not_struck(parts):
    # without damping, from rest at the wall, it comes back to it at rest
    system = LinearSystem(M=1.0, K=0.0969, force=Harmonic(constant=-0.0129))
    scene = Scene(
        system=system, contacts=LinearContacts(G=-1.0, offset=0.2744, restitution=0.0), q0=0.249, v0=-0.0505,
        t_span=(-1.08, 46.672),
    )  # fmt: skip
    run = simulate(scene, Located(47.752 / parts, "exact"))
    struck = run.impacts[run.impacts.kind == Kind.IMPACT]
    assert len(struck) == 1
    t, omega, rest = np.linspace(struck.time[0] + 1e-6, 46.672, 500), np.sqrt(0.0969), -0.0129 / 0.0969
    circling = rest + (0.2744 - rest) * np.cos(omega * (t - struck.time[0]))
    np.testing.assert_allclose(run.at(t)[0][:, 0], circling, rtol=0, atol=1e-13)


def shaken(t, q, v, p, out):
    """A table."""
    out[0, 0], out[0, 1], out[0, 2] = 1e-3 * np.sin(3.0 * t), 3e-3 * np.cos(3.0 * t), -9e-3 * np.sin(3.0 * t)


@pytest.mark.parametrize("h", [1e-2, 2.5e-3])
def test_elastic_hops_within_a_step_of_order_two_on_a_moving_table_stay_as_high_as_they_are(h):
    u, most = 1e-6, 20_000
    table = LinearContacts(G=1.0, motion=shaken, restitution=1.0)
    scene = Scene(LinearSystem(M=1.0, force=-9.81), contacts=table, q0=0.0, v0=3e-3 + u, t_span=(0.0, 0.01))
    hops = simulate(scene, Located(h, max_events=most), keep="impacts").impacts
    assert len(hops) > most
    assert np.allclose(hops.before, -u, rtol=1e-4)
