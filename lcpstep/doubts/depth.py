"""Whether a finished run lies deeper inside an obstacle than its steps explain.

    depth > share x size,   depth > steps x h (speed + h acceleration),      size = |G| (how far the coordinates went)

Time-stepping looks at a contact once a step and so lies up to a step's way inside of it, which is no error but its
order; and what rests moves by rounding only. A run that is through the wall lies inside by a good part of all that it
has moved, or, where a method finds the time of each impact, by a thousandth, and by more than a hundredth of a step's
way. Some of the kept states are looked at: what lasts is not missed.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Contacts, Harmonic, LinearContacts, Scene, System
from lcpstep.callbacks.faults import cause, forget
from lcpstep.callbacks.prepared import evaluate
from lcpstep.trajectory import Status, Trajectory

Array = NDArray[np.float64]
LOOKS = 64  # states that are looked at
# Of the size of the motion, of time-stepping, which drifts, and of methods that find the time of each impact.
# Coordinates that go the same way make that size large: links of a chain that flies off
SHARE, SHARE_LOCATED = 0.1, 1e-3
STEPS, STEPS_LOCATED = 2.0, 0.01  # that an impact may be noticed too late, of the same
ROUNDING = 1e-9  # of the coordinates, and of how far they could have gone: no depth
ROUNDING_BESIDE = 1e-12  # of how far others could have gone, in the metric of M: what couples them
MANY = 100  # contacts: of more it is not asked whether they squeeze what lies between
TOGETHER = 4096  # states whose energies are found at a time: they stay in the processor's caches
LONGEST = 10.0  # of the mean step: one of those that a tolerance has chosen


def too_deep(run: Trajectory) -> str:
    """Which contact is penetrated by as much as the motion is large, in words; "" where none is."""
    scene = run.scene
    if scene.contacts is None or run.status != Status.DONE or len(run.t) == 0:
        return ""
    drifts = hasattr(run.method, "theta")  # the theta method
    share, steps = (SHARE, STEPS) if drifts else (SHARE_LOCATED, STEPS_LOCATED)
    if _shallow(run, share):
        return ""
    k = spread(0, len(run.t) - 1, LOOKS)
    states = [(scene.t_span[0], np.asarray(scene.q0), np.asarray(scene.v0))]
    states += [(float(run.t[i]), run.q[i], run.v[i]) for i in k]
    try:
        g = gaps(scene, states)
        depth = max(0.0, -float(g.min()))
        if depth == 0.0:
            return ""
        row, c = np.unravel_index(int(np.argmin(g)), g.shape)
        G = np.abs(normal(scene, int(c), states[row]))
        q, v = (np.array([x[i] for x in states]) for i in (1, 2))
        size, speed, h = float(G @ np.ptp(q, axis=0)), float(G @ np.max(np.abs(v), axis=0)), _step(run)
        explained = depth <= steps * h * max(speed, _logged(run, int(c)))
        if depth <= share * size or (explained and not _squeezed(run, states[row], g[row], steps * h)):
            return ""
        (fastest, masses), span = _acceleration(scene, states), scene.t_span[1] - scene.t_span[0]
    except ValueError:  # a callback that fails at a state in between, which the run has not asked it for
        return ""
    a, most = float(G @ fastest), np.max(np.abs(q), axis=0)
    reach = float(G @ most) + span * (speed + span * a)
    most = most + span * (np.max(np.abs(v), axis=0) + span * fastest)
    with np.errstate(over="ignore"):  # motions of 1e160 m
        beside = float(np.sqrt((G @ (G / masses)) * (most @ (masses * most))))
    if depth <= max(ROUNDING * reach, ROUNDING_BESIDE * beside, steps * h * h * a):
        return ""
    return (
        f"contact {c} lies {depth:.3g} m inside of its obstacle at t = {states[row][0]:.9g} s, in a motion of "
        f"{size:.3g} m towards it: the run is wrong there"
    )


def _squeezed(run: Trajectory, at: tuple[float, Array, Array], g: Array, time: float) -> bool:
    """Whether a state lies inside of all obstacles together by more than the motion's energy moves it in that time.

    A light body that is thrown to and fro explains its own depth, but not that of a heavy one, which squeezes it.
    Both in the metric of M: z W z is the square of the smallest way back, and contacts add up.
    """
    from lcpstep.lcp import solve_lcp

    scene = run.scene
    if len(run.t) < LOOKS or scene.n_c > MANY or getattr(scene.system, "sparse", False):
        return False
    M, G = mass(scene, *at), np.array([normal(scene, c, at) for c in range(scene.n_c)])
    solution = solve_lcp(G @ np.linalg.solve(M, G.T), g)
    way = time * scene.n_c * np.sqrt(2.0 * largest_energy(run))
    return solution.status == 0 and -float(solution.z @ g) > way * way


def _shallow(run: Trajectory, share: float) -> bool:
    """Whether all the states lie inside by less than that share, where a model that tells is at hand, or soon made.

    The start was looked at when the scene was made.
    """
    from lcpstep.kernels.looks import lies_inside
    from lcpstep.model import at_hand, looked_at

    m = at_hand(run.scene)
    if m is None:
        if not isinstance(run.scene.contacts, Contacts):  # of many coordinates, perhaps sparse
            return False
        m = looked_at(run.scene)
    deep = lies_inside(m, run.t, run.q, LOOKS, share, True)
    cause()
    forget()
    return not deep


def gaps(scene: Scene, states: list[tuple[float, Array, Array]]) -> Array:
    """Gaps (states, n_c) at states (t, q, v)."""
    contacts: Any = scene.contacts
    n_c = scene.n_c
    if not isinstance(contacts, LinearContacts):
        return np.array([evaluate("contacts.gap", contacts.gap, scene, x, (n_c,)) for x in states])
    G: Any = contacts.G
    g = np.asarray((G @ np.array([q for _, q, _ in states]).T).T + np.asarray(contacts.offset))
    if contacts.motion is not None:
        for k, x in enumerate(states):
            g[k] -= evaluate("contacts.motion", contacts.motion, scene, x, (n_c, 3))[:, 0]
    return g


def normal(scene: Scene, c: int, at: tuple[float, Array, Array]) -> Array:
    """Row of the Jacobian."""
    contacts: Any = scene.contacts
    if isinstance(contacts, LinearContacts):
        G: Any = contacts.G
        return np.asarray(G[[c]].toarray() if contacts.sparse else G[c], dtype=float).ravel()
    shape = (scene.n_c, scene.n_q)
    return evaluate("contacts.jacobian", contacts.jacobian, scene, at, shape)[c]


def mass(scene: Scene, t: float, q: Array, v: Array) -> Any:
    """The mass matrix at a state, sparse where the scene's is."""
    M: Any = scene.system.mass if isinstance(scene.system, System) else scene.system.M
    shape = (scene.n_q, scene.n_q)
    return evaluate("system.mass", M, scene, (t, q, v), shape) if callable(M) else M


def largest_energy(run: Trajectory) -> float:
    """The largest kinetic energy of the kept states."""
    M: Any = getattr(run.scene.system, "M", None)
    if M is not None:
        parts = (run.v[k : k + TOGETHER] for k in range(0, len(run.v), TOGETHER))
        return 0.5 * max(float(np.max(np.sum(v * (M @ v.T).T, axis=1))) for v in parts)
    from lcpstep.kernels.states import power
    from lcpstep.model import looked_at

    kinetic, _ = power(looked_at(run.scene), run.t, run.q, run.v)
    cause()  # a callback that fails beside the motion, where the run has not asked it
    forget()
    return float(np.max(kinetic))


def spread(first: int, last: int, most: int) -> NDArray[np.intp]:
    """Whole numbers from the first to the last one, evenly spread, at most so many."""
    if last - first < most:
        return np.arange(first, last + 1)
    return np.unique(np.linspace(first, last, most).astype(np.intp))


def fixed_step(method: Any) -> float:
    """Step of a method whose steps are all of one size [s]; 0 of other methods, and of steps by a tolerance."""
    return getattr(method, "h", 0.0) if getattr(method, "tolerance", None) is None else 0.0


def _step(run: Trajectory) -> float:
    """The longest step that the run may have taken; an event-driven one finds its impacts within none."""
    h = getattr(run.method, "h", 0.0)
    return min(h, LONGEST * float(run.t[-1] - run.scene.t_span[0]) / max(1, run.counts.steps))


def _logged(run: Trajectory, c: int) -> float:
    """The fastest that the gap was seen to close or open at an event."""
    own = run.impacts[run.impacts.contact == c]
    return float(np.max(np.abs(np.concatenate([own.before, own.after])), initial=0.0))


def _acceleration(scene: Scene, states: list[tuple[float, Array, Array]]) -> tuple[Array, Array]:
    """How fast the coordinates would be accelerated at most without contacts, roughly; and their masses."""
    fastest, masses = zip(*(_accelerated(scene, *x) for x in states), strict=True)
    return np.max(fastest, axis=0), masses[0]


def _accelerated(scene: Scene, t: float, q: Array, v: Array) -> tuple[Array, Array]:
    """The same at one state, where forces of a linear system do not cancel each other."""
    system, at, shape = scene.system, (t, q, v), (scene.n_q,)
    M = mass(scene, t, q, v)
    if isinstance(system, System):
        f = evaluate("system.force", system.force, scene, at, shape)
    else:
        matrices: Any = system.C, system.K
        C, K = matrices
        if isinstance(system.force, Harmonic):
            f = np.sum(np.abs(system.force.terms(scene.n_q)), axis=0)
        else:
            given: Any = system.force
            f = evaluate("system.force", given, scene, at, shape)
        f = np.abs(f) + np.abs(C @ v) + np.abs(K @ q)
        if system.frame is not None:
            c = evaluate("system.frame", system.frame, scene, at, (scene.n_q, 3))
            f += np.abs(K @ c[:, 0]) + np.abs(C @ c[:, 1]) + np.abs(M @ c[:, 2])
    masses = np.asarray(M.diagonal(), dtype=float)
    return np.abs(f) / masses, masses
