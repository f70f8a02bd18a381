"""Random scenes with friction, and what may be wrong with their runs.

    particles between walls, discs, blocks on two feet, coupled systems, one coordinate that meets walls obliquely;
    1 to 4 contacts, belts, walls that shake, springs, dampers, harmonic forces, any restitution

`complaints(seed)` is empty where all is well. `python -m tests.random_friction 0 2000` looks at many.
"""

import collections
import itertools
import math
import sys
from dataclasses import replace

import numpy as np

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Moreau, SimulationError, Status, energy, simulate

G0 = 9.81
STEP = 1e-4
FINEST = STEP / 64.0
MOST = 3e6  # steps
ONCE = 1e-9  # s
PARADOX = (Status.PAINLEVE_INCONSISTENT, Status.PAINLEVE_INDETERMINATE)


def shaking(t, q, v, p, out):
    """Walls that move by p[3 c] sin(p[3 c + 1] t + p[3 c + 2]), from where they are at t = 0."""
    for c in range(out.shape[0]):
        a, w, phase = p[3 * c], p[3 * c + 1], p[3 * c + 2]
        out[c, 0] = a * (math.sin(w * t + phase) - math.sin(phase))
        out[c, 1] = a * w * math.cos(w * t + phase)
        out[c, 2] = -a * w * w * math.sin(w * t + phase)


def bodies(g):
    """Mass matrix, normals, tangents, gaps at the start, and velocities of a drawn system."""
    kind = g.integers(5)
    if kind == 0:  # a particle between walls
        k = int(g.integers(1, 5))
        a = g.uniform(-2.2, 2.2, k)
        rows, tangents = np.stack([np.sin(a), np.cos(a)], 1), np.stack([np.cos(a), -np.sin(a)], 1)
        return np.diag(g.uniform(0.5, 3.0, 2)), rows, tangents, g.uniform(0.1, 0.6, k), 1.5 * g.normal(size=2)
    if kind == 1:  # a disc on a floor, between walls
        R, chosen = 0.3, [True, g.random() < 0.6, g.random() < 0.5, g.random() < 0.3]
        rows = np.array([[0, 1, 0], [1, 0, 0], [-1, 0, 0], [0, -1, 0]], dtype=float)[chosen]
        tangents = np.array([[1, 0, R], [0, 1, -R], [0, 1, R], [1, 0, -R]])[chosen]
        v = g.normal(size=3) * [1.5, 1.0, 6.0]
        return np.diag([1.0, 1.0, 0.5 * R * R]), rows, tangents, np.array([0.2, 0.5, 0.7, 1.0])[chosen], v
    if kind == 2:  # a block on two feet, a wall beside it
        w, height, wall = 0.3, g.uniform(0.05, 0.5), g.random() < 0.4
        rows, tangents = [[0, 1, w], [0, 1, -w]], [[1, 0, height]] * 2
        if wall:
            rows, tangents = [*rows, [-1, 0, 0.1]], [*tangents, [0, 1, w]]
        v = [g.normal(), abs(g.normal()) * 0.5 * (g.random() < 0.6), 0.5 * g.normal() * (g.random() < 0.6)]
        gaps = np.array([0.0, 0.0, 0.4])[: len(rows)]
        return np.diag([1.0, 1.0, 0.1]), np.array(rows, float), np.array(tangents, float), gaps, np.array(v)
    if kind == 3:  # any system
        n = int(g.integers(2, 6))
        A, k = g.normal(size=(n, n)), min(int(g.integers(1, 3)), n // 2)
        M, rows, tangents = 0.2 * A @ A.T + np.eye(n), g.normal(size=(k, n)), g.normal(size=(k, n))
        return M, rows, tangents, g.uniform(0.0, 0.5, k), g.normal(size=n)
    k = int(g.integers(1, 3))  # one coordinate
    slope = g.uniform(-0.8, 0.8, (k, 1)) * (g.random() < 0.8)
    return (
        np.eye(1) * g.uniform(0.5, 2.0),
        np.array([[1.0], [-1.0]])[:k],
        slope,
        g.uniform(0.1, 0.4, k),
        g.normal(size=1),
    )


def draw(seed, law="moreau"):
    """A scene; the same for the same seed."""
    g = np.random.default_rng(seed)
    M, rows, tangents, gaps, v0 = bodies(g)
    k, n = rows.shape
    f = -rows.sum(0) * g.uniform(1.0, 5.0) + g.normal(size=n)
    if n in (2, 3) and M[0, 1] == 0.0:
        f[:2] = 3.0 * g.normal(), -G0 * M[1, 1]
        f[2:] = 0.0
    shaken = 3.0 * g.normal(size=n) * (np.arange(n) < 2) * (g.random() < 0.5)
    force = Harmonic(constant=f, cosine=shaken, omega=g.uniform(2.0, 12.0))
    K, C = (np.diag(g.uniform(0.0, most, n) * (g.random(n) < 0.3)) for most in (40.0, 1.0))
    shakes = g.random() < 0.25
    p = np.stack([0.02 * g.random(k), g.uniform(5.0, 20.0, k), g.uniform(0.0, 6.3, k)], 1).ravel()
    mu, slip = g.uniform(0.0, 1.2, k) * (g.random(k) < 0.9), g.normal(size=k) * (g.random() < 0.4)
    return Scene(
        system=LinearSystem(M, K=K, C=C, force=force), q0=np.zeros(n), v0=v0, t_span=(0.0, g.uniform(0.3, 2.0)), p=p,
        contacts=LinearContacts(
            rows, offset=gaps, restitution=g.choice([0.0, 0.0, 0.3, 0.5, 0.8]), motion=shaking if shakes else None,
            friction=Coulomb(mu, tangents, slip=slip, law=law),
        ),
    )  # fmt: skip


def nowhere_to_go(scene, t, q, v):
    """Whether belts and walls may drive the closed contacts against each other: impulses that cancel take work.

    A linear programme: p_N >= 0, |p_T| <= mu p_N with G^T p_N + T^T p_T = 0 and p_N g_t + p_T slip < 0. Without such
    impulses the complementarity problem has a solution (a copositive matrix).
    """
    from scipy.optimize import linprog

    g, u = scene.gap(t, q, v)
    closed = np.flatnonzero(g < 1e-6)
    c, friction = scene.contacts, scene.contacts.friction
    G, T, mu, m = c.G[closed], friction.tangent[closed], friction.mu[closed], len(closed)
    cost = np.concatenate([u - c.G @ v, friction.slip])[np.concatenate([closed, closed + scene.n_c])]
    cone = np.block([[-np.diag(mu), np.eye(m)], [-np.diag(mu), -np.eye(m)]])
    found = linprog(
        cost, A_ub=cone, b_ub=np.zeros(2 * m), A_eq=np.vstack([G, T]).T, b_eq=np.zeros(scene.n_q),
        bounds=[(0.0, 1.0)] * m + [(None, None)] * m,
    )  # fmt: skip
    return found.status == 0 and found.fun < -1e-9


def answers(W, b, mu, sliding):
    """All solutions of the problem of contacts, as velocities or accelerations of the rows, (m, 2 n).

    sliding : sign of the sliding velocity of each contact, 0 of those that may stick
    """
    n, found = len(mu), []
    for modes in itertools.product(range(4), repeat=n):  # open, stick, slide either way
        if any(s != 0.0 and k not in (0, 2 if s > 0.0 else 3) for k, s in zip(modes, sliding, strict=True)):
            continue
        A, rhs = np.eye(2 * n), np.zeros(2 * n)
        for c, k in enumerate(modes):
            if k > 0:
                A[c], rhs[c] = W[c], -b[c]
            if k == 1:
                A[n + c], rhs[n + c] = W[n + c], -b[n + c]
            elif k > 1:
                A[n + c, c] = mu[c] if k == 2 else -mu[c]
        if abs(np.linalg.det(A)) < 1e-12:
            continue
        p = np.linalg.solve(A, rhs)
        u = W @ p + b
        near = 1e-9 * (1.0 + np.max(np.abs(p)) + np.max(np.abs(u)))
        fits = np.all(p[:n] >= -near) and np.all(u[:n] >= -near)
        fits = fits and np.all(np.abs(p[n:]) <= mu * p[:n] + near)
        for c, k in enumerate(modes):
            if k > 1 and sliding[c] == 0.0:
                fits = fits and (u[n + c] >= -near if k == 2 else u[n + c] <= near)
        if fits and not any(np.max(np.abs(u - other)) < 1e-6 * (1.0 + np.max(np.abs(u))) for other in found):
            found.append(u)
    return found


def left_open(scene, run, end):
    """Whether the law has several answers, or none, at an impact or in the forces of the run up to a time.

    Two contacts that meet at once, up to rounding, strike together or one after the other.
    """
    c, f, S = scene.contacts, scene.contacts.friction, scene.system
    impacts = np.unique(run.impacts.time[run.impacts.kind == Kind.IMPACT])
    if np.any(np.diff(impacts[impacts < end]) < ONCE):
        return True
    times = [(t, True) for t in impacts] + [(t, False) for t in np.linspace(0.0, run.t[-1], 400)]
    for t, strikes in times:
        if t > end:
            continue
        before = strikes and t <= scene.t_span[0] + ONCE
        at = t - ONCE if strikes and not before else t
        q, v = (scene.q0, scene.v0) if before else (x[0] for x in run.at(np.array([at])))
        g, u = scene.gap(t, q, v)
        closed = np.flatnonzero(g < 1e-6)
        D, mu = np.vstack([c.G[closed], f.tangent[closed]]), f.mu[closed]
        W = D @ np.linalg.solve(S.M, D.T)
        slip = f.tangent[closed] @ v + f.slip[closed]
        if strikes:
            b, sliding = (
                (1.0 + c.restitution[0]) * np.concatenate([np.minimum(u[closed], 0.0), slip]),
                0.0 * slip,
            )
        else:
            F = np.array(S.force.constant) + np.array(S.force.cosine) * math.cos(S.force.omega * t)
            motion = np.zeros((scene.n_c, 3))
            if c.motion is not None:
                c.motion(t, q, v, np.asarray(scene.p), motion)
            b = D @ np.linalg.solve(S.M, F - S.K @ q - S.C @ v) - np.concatenate(
                [motion[closed, 2], 0.0 * slip]
            )
            sliding = np.where(np.abs(slip) > 1e-9, np.sign(slip), 0.0)
        if len(closed) and len(answers(W, b, mu, sliding)) != 1:
            return True
    return False


def complaints(seed, law="moreau"):
    """What is wrong with the runs of a scene, and how its event-driven run has ended."""
    scene = draw(seed, law)
    try:
        run = simulate(scene, EventDriven(1e-10, 1e-10, max_events=20000))
    except SimulationError as error:
        return [f"failed: {error}"], "FAILED"
    said = []
    stuck = run.status == Status.LCP_FAILED and nowhere_to_go(scene, run.t[-1], run.q[-1], run.v[-1])
    if not stuck and run.status not in (Status.DONE, *PARADOX):
        said.append(run.message)
    if not (np.all(np.isfinite(run.q)) and np.all(np.isfinite(run.v))):
        said.append("not finite")
    if np.max(run.penetration, initial=0.0) > 1e-7:
        said.append(f"penetrates by {np.max(run.penetration):.3g}")
    balance = energy(run)
    most = np.max(balance.kinetic + np.abs(balance.potential))
    # what ends a chattering is counted later, when the contact presses, and so is what a belt does then
    if np.any(balance.created.energy > (1e-5 if np.any(scene.contacts.friction.slip) else 1e-7) * most):
        said.append(f"creates energy {balance.created.energy.max():.3g} of {most:.3g}")
    apart = parting(scene, run)
    if apart is not None and not left_open(scene, run, apart[0]):
        said.append(f"{apart[1]:.3g} from small steps at t = {apart[0]:.6g}")
    return said, run.status.name if apart is None else "LEFT_OPEN"


def parting(scene, run):
    """When, and how far, steps of `Moreau` are elsewhere though smaller ones agree with each other; None if never."""
    t = np.linspace(scene.t_span[0], run.t[-1], 30)[1:-1]
    if len(run.t) < 2 or run.t[-1] < 10.0 * STEP:
        return None
    q, size = run.at(t)[0], np.max(np.abs(run.q)) + 1e-3
    coarse, fine = (simulate(scene, Moreau(h), keep=t) for h in (4.0 * STEP, STEP))
    reached = min(len(coarse.t), len(fine.t))
    own, off = (
        np.max(np.abs(a - b[:reached]), axis=1)
        for a, b in ((coarse.q[:reached], fine.q), (fine.q[:reached], q))
    )
    together = np.cumprod(own < 1e-2 * size).astype(bool)  # up to where steps part from one another
    apart = together & (off > 1e-3 * size) & (off > 3.0 * np.maximum.accumulate(own))
    if not np.any(apart):
        return None
    last = t[: np.argmax(apart) + 1]
    for step in (STEP / 16.0, FINEST):  # the second where an impact falls into hops shorter than the first
        finest = simulate(scene, Moreau(step), keep=last)
        left = np.max(np.abs(finest.q[-1] - q[len(last) - 1])) if len(finest.t) == len(last) else math.inf
        if left < 0.5 * off[len(last) - 1]:
            return None
    if np.max(np.abs(resolved(scene, run, last[-1]) - q[len(last) - 1])) < 0.5 * off[len(last) - 1]:
        return None
    return last[-1], off[len(last) - 1]


def close_impacts(run, end):
    """Where impacts of different contacts follow closer on one another than small steps resolve: begin, end, step."""
    log = run.impacts[(run.impacts.kind == Kind.IMPACT) & (run.impacts.time < end)]
    found = []
    for one, two in itertools.pairwise(log):
        apart = two.time - one.time
        if one.contact == two.contact or not ONCE < apart < 10.0 * FINEST:
            continue
        begin = max(one.time - FINEST, run.t[0])
        if found and begin <= found[-1][1]:
            begin, _, step = found.pop()
            apart = min(apart, 5.0 * step)
        found.append((begin, min(two.time + FINEST, end), 0.2 * apart))
    return found


def resolved(scene, run, end):
    """Where `Moreau` comes to by the smallest steps, and smaller ones where impacts of a run are closer than these.

    A contact that hops by less than a step is as good as closed to it, and struck together with another one.
    """
    q, v, now = scene.q0, scene.v0, scene.t_span[0]
    for begin, stop, step in [*close_impacts(run, end), (end, end, FINEST)]:
        for goal, h in ((begin, FINEST), (stop, step)):
            if goal > now and (goal - now) / h < MOST:
                deep = np.maximum(
                    -scene.gap(now, q, v)[0], 0.0
                )  # what steps have passed a surface by is no gap
                surfaces = replace(scene.contacts, offset=scene.contacts.offset + 2.0 * deep)
                part = replace(scene, q0=q, v0=v, t_span=(now, goal), contacts=surfaces)
                done = simulate(part, Moreau((goal - now) / math.ceil((goal - now) / h)), keep=[goal])
                q, v, now = done.q[-1], done.v[-1], done.t[-1]
    return q if now == end else np.full(scene.n_q, math.inf)


if __name__ == "__main__":
    ends = collections.Counter()
    for seed in range(int(sys.argv[1]), int(sys.argv[2])):
        wrong, end = complaints(seed, *sys.argv[3:])
        ends[end] += 1
        for words in wrong:
            print(seed, words, flush=True)
    print(dict(ends))
