"""States between the kept ones: no body lies inside a moving obstacle at any time, however its run ends."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Status, simulate
from tests.marks import shared
from tests.models import RISING_CIRCLE

TOLERANCE = 1e-10


def walls(t, q, v, p, out):
    """Obstacles A (sin(w t + phase) - sin(phase)); p = (A, w, phase) of each."""
    for c in range(len(out)):
        a, w, phase = p[3 * c], p[3 * c + 1], p[3 * c + 2]
        out[c, 0] = a * math.sin(w * t + phase) - a * math.sin(phase)
        out[c, 1] = a * w * math.cos(w * t + phase)
        out[c, 2] = -a * w * w * math.sin(w * t + phase)


def before_moving_walls(seed):
    random = np.random.default_rng(seed)
    n, m = int(random.integers(1, 4)), int(random.integers(1, 4))
    G, q0 = random.normal(size=(m, n)), random.normal(size=n)
    motion = [random.exponential(0.2, size=m), random.uniform(0.5, 20.0, m), random.uniform(0.0, 6.0, m)]
    force, K = 3.0 * random.normal(size=n), None
    if random.random() < 0.5:
        force = Harmonic(constant=force, cosine=random.normal(size=n), omega=random.uniform(0.5, 5.0))
    if random.random() < 0.5:
        A = random.normal(size=(n, n))
        K = 3.0 * A @ A.T
    contacts = LinearContacts(
        G=G, offset=-G @ q0 + random.exponential(size=m) * (random.random(m) < 0.7),
        restitution=random.choice([0.0, 0.3, 0.6, 0.9], size=m), motion=walls,
    )  # fmt: skip
    return Scene(
        LinearSystem(M=np.diag(10.0 ** random.uniform(-1.0, 1.0, size=n)), K=K, force=force), q0,
        random.normal(size=n), (0.0, 5.0), contacts, p=np.stack(motion, 1).ravel(), name=f"moving walls {seed}",
    )  # fmt: skip


def check(scene, seed=0):
    m = simulate(scene, EventDriven(max_events=20_000))
    times = np.random.default_rng(seed).uniform(m.t[0], m.t[-1], 1000)
    states = zip(times, *m.at(times), strict=True)
    gaps = np.array([scene.gap(t, q, v)[0] for t, q, v in states])
    assert gaps.min() > -TOLERANCE
    return m


@pytest.mark.parametrize("seed", range(15))
def test_nothing_lies_inside_a_moving_wall_at_any_time(seed):
    check(before_moving_walls(seed), seed)


@pytest.mark.parametrize("seed", shared(range(15, 500), 30))
def test_nothing_lies_inside_many_more_moving_walls(seed):
    check(before_moving_walls(seed), seed)


def closing(t, q, v, p, out):
    for c in range(2):
        out[c, 0], out[c, 1], out[c, 2] = 0.1 * t * t + (0.0, -0.9)[c], 0.2 * t, 0.2


@pytest.mark.parametrize("spring", [0.0, 3.0])
def test_the_last_step_of_a_run_that_ends_at_an_event_is_known_too(spring):
    # squeezed between two walls: carried along by the lower one until the upper one comes
    scene = Scene(
        LinearSystem(M=1.0, K=spring, force=-1.0), 0.5, 0.0, (0.0, 6.0),
        LinearContacts(G=[[1.0], [-1.0]], restitution=0.0, motion=closing), name="press",
    )  # fmt: skip
    m = check(scene)
    assert m.status is Status.LCP_FAILED
    assert m.t[-1] == pytest.approx(math.sqrt(4.5), abs=1e-9)
    assert m.t[-1] - m.t[-2] > 1e-3
    times = np.linspace(m.t[-2], m.t[-1], 20)
    np.testing.assert_allclose(m.at(times)[0][:, 0], 0.1 * times**2, rtol=0, atol=TOLERANCE)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.9])
def test_nothing_lies_inside_a_moving_circle(restitution):
    contacts = Contacts(
        n_c=1, gap=RISING_CIRCLE.gap, jacobian=RISING_CIRCLE.jacobian, gap_t=RISING_CIRCLE.gap_t,
        restitution=restitution,
    )  # fmt: skip
    check(Scene(LinearSystem(M=np.eye(2), force=[0.0, -9.81]), [0.3, 1.9], [0.0, 0.0], (0.0, 2.0), contacts))
