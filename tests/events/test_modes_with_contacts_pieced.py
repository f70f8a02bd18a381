"""Random systems with modes and contacts against runs without modes, pieced together where a root finder says.

One to three masses in linear springs that change with the mode, driven, between walls; guards are linear in the
state, velocities included, so that impacts carry some of them through zero; some switches slow the motion down.
"""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq

from lagrangian import Guard, HybridScene, HybridSystem, LinearContacts, Mode, Scene, System
from lcpstep import EventDriven, Kind, Status, simulate
from tests.marks import shared

END, SWITCHES = 6.0, 10
SLOWER = 0.7


def linear(t, x, p, out, mode):
    """Of each mode p has n constants, n x 2n coefficients, amplitude and frequency of the drive."""
    n = len(x) // 2
    at = mode * (n + 2 * n * n + 2)
    for i in range(n):
        a = p[at + i]
        for j in range(2 * n):
            a += p[at + n + i * 2 * n + j] * x[j]
        out[i], out[n + i] = x[n + i], a
    out[n] += p[at + n + 2 * n * n] * math.cos(p[at + n + 2 * n * n + 1] * t)


def plane(t, x, p, out, mode):
    """After those, 2 n coefficients and a constant for the guard of each mode."""
    n = len(x) // 2
    at = 3 * (n + 2 * n * n + 2) + mode * (2 * n + 1)
    out[0] = p[at + 2 * n]
    for j in range(2 * n):
        out[0] += p[at + j] * x[j]


def field_0(t, x, p, out):
    linear(t, x, p, out, 0)


def field_1(t, x, p, out):
    linear(t, x, p, out, 1)


def field_2(t, x, p, out):
    linear(t, x, p, out, 2)


def guard_0(t, x, p, out):
    plane(t, x, p, out, 0)


def guard_1(t, x, p, out):
    plane(t, x, p, out, 1)


def guard_2(t, x, p, out):
    plane(t, x, p, out, 2)


def slowed(t, x, p, out):
    n = len(x) // 2
    for i in range(n):
        out[i], out[n + i] = x[i], SLOWER * x[n + i]


FIELDS, GUARDS = (field_0, field_1, field_2), (guard_0, guard_1, guard_2)


def random_scene(seed):
    """A scene, the coefficients of its guards, and whether they slow the motion."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 4))
    mixed = rng.normal(size=(n, n)) * 0.2
    M = np.diag(rng.uniform(0.5, 2.0, n)) + mixed @ mixed.T
    p = []
    for _ in range(3):
        K, C = np.diag(rng.uniform(1.0, 20.0, n)), np.diag(rng.uniform(0.0, 1.0, n))
        A = -np.hstack([np.linalg.solve(M, K), np.linalg.solve(M, C)])
        p += [*(3.0 * rng.normal(size=n)), *A.ravel(), rng.uniform(0.0, 4.0), rng.uniform(0.5, 3.0)]
    planes = rng.normal(size=(3, 2 * n + 1))
    planes[:, -1] *= 0.3
    slow = rng.random(3) < 0.3
    rows = np.vstack([np.eye(n), -np.eye(n)])[: int(rng.integers(1, 2 * n + 1))]
    walls = LinearContacts(
        rows, rng.uniform(0.2, 0.8, len(rows)), rng.choice([0.0, 0.3, 0.6, 0.9], len(rows))
    )
    modes = {
        f"mode {k}": Mode(
            FIELDS[k],
            [Guard(GUARDS[k], f"mode {(k + 1) % 3}", reset=slowed if slow[k] else None, at_once=False)],
        )
        for k in range(3)
    }
    x0 = np.concatenate([rng.uniform(-0.15, 0.15, n), rng.normal(size=n)])
    scene = HybridScene(
        HybridSystem(2 * n, modes, mass=M), x0, "mode 0", (0.0, END), p=[*p, *planes.ravel()], contacts=walls
    )
    return scene, planes, slow


def first_passage(run, w):
    """When w x rises through zero in a run, right after an impact that carries it there; None if it does not."""
    before = np.nextafter(run.impacts.time, -1.0)
    times = np.concatenate([np.linspace(run.t[0], run.t[-1], 3000), run.impacts.time, before])
    times = np.unique(times[(times >= run.t[0]) & (times <= run.t[-1])])
    values = np.hstack(run.at(times)) @ w[:-1] + w[-1]
    armed = False
    for (a, b), (left, right) in zip(pairwise(times), pairwise(values), strict=True):
        armed = armed or left < -1e-9
        if armed and left < 0.0 <= right:
            if b - a < 1e-12:
                return float(b)
            return float(
                brentq(lambda t: np.hstack(run.at(t)) @ w[:-1] + w[-1], a, b, xtol=1e-14, rtol=1e-14)
            )
    return None


def pieced(scene, planes, slow):
    """Times of the first switches, by one run without modes after another."""
    n, t, x, mode, found = scene.n_x // 2, 0.0, np.array(scene.x0), 0, []
    M, walls = np.array(scene.system.mass), scene.contacts
    while len(found) < SWITCHES:
        field = FIELDS[mode]

        def force(t, q, v, p, out, field=field):
            rates = np.zeros(2 * n)
            field(t, np.concatenate([q, v]), p, rates)
            out[:] = M @ rates[n:]

        run = simulate(Scene(System(n, M, force), x[:n], x[n:], (t, END), walls, p=scene.p), EventDriven())
        at = first_passage(run, planes[mode])
        if at is None:
            return found
        q, v = run.at(at)
        g = np.asarray(walls.G) @ q + walls.offset
        q = q - np.asarray(walls.G).T @ np.minimum(g, 0.0)  # what rounding has left
        x = np.concatenate([q, SLOWER * v if slow[mode] else v])
        t, mode = at, (mode + 1) % 3
        found.append(at)
    return found


@pytest.mark.filterwarnings("ignore::lcpstep.callbacks.UncompiledCallback")
@pytest.mark.parametrize("seed", shared([1, 0, *range(2, 12)], 4))
def test_a_run_with_modes_is_its_runs_without_them_in_turn(seed):
    scene, planes, slow = random_scene(seed)
    run, known = simulate(scene, EventDriven()), pieced(scene, planes, slow)
    assert run.status == Status.DONE
    assert len(run.switches) == len(known) or len(known) == SWITCHES
    np.testing.assert_allclose(run.switches.time[: len(known)], known, rtol=0, atol=1e-9)
    n = scene.n_x // 2
    gaps = run.x[:, :n] @ np.asarray(scene.contacts.G).T + scene.contacts.offset
    assert np.min(gaps) > -1e-11
    impacts = run.impacts[run.impacts.kind == Kind.IMPACT]
    r = np.asarray(scene.contacts.restitution)[impacts.contact]
    np.testing.assert_allclose(impacts.after, -r * impacts.before, rtol=0, atol=1e-12)
