"""What physics demands of every run: each check is a function of the scene and the run, and gives findings."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from benchmarks.judge import physics
from benchmarks.judge.describe import Description
from benchmarks.judge.runs import WAYS, Finding, Run, run
from lcpstep.trajectory import Kind

CPU, CPU_EACH = 0.5, 1e-4  # seconds of a run, and of each of its steps and events
ROUNDING = 1e-9  # of the size of what is compared
EXACT = ("event-driven", "located-exact")


def finite(d: Description, r: Run) -> Iterator[Finding]:
    """No state and no impulse is infinite or not a number."""
    m = r.motion
    for name in ("t", "q", "v", "impulse", "joint_impulse"):
        bad = ~np.isfinite(getattr(m, name))
        if np.any(bad):
            yield Finding(r.method, "not finite", f"{name} in {int(np.sum(bad))} entries, status {r.status}")
    if r.status == "NOT_FINITE":
        yield Finding(r.method, "not finite", r.text)


def reaches_the_end(d: Description, r: Run) -> Iterator[Finding]:
    """DONE means that the end of the span has been reached, by increasing times."""
    t = r.motion.t
    if r.done and not (t[0] == d.t_span[0] and t[-1] == d.t_span[1]):
        yield Finding(r.method, "wrong span", f"states from {t[0]!r} to {t[-1]!r}, asked for {d.t_span}")
    if np.any(np.diff(t) < 0.0):
        yield Finding(r.method, "wrong span", "times decrease")


def in_time(d: Description, r: Run) -> Iterator[Finding]:
    """CPU time within a bound per step and event; asked again, for the first run may have compiled."""
    work = r.motion.counts.steps + r.motion.counts.events
    if r.cpu > CPU + CPU_EACH * work:
        again = run(d, r.method).cpu
        if again > CPU + CPU_EACH * work:
            yield Finding(r.method, "slow", f"{again:.3g} s for {work} steps and events")


def between(d: Description, r: Run) -> Iterator[Finding]:
    """States between the kept ones are told, right up to the end of what was computed."""
    t = r.motion.t
    try:
        q, v = r.motion.at(np.array([t[0], 0.5 * (t[0] + t[-1]), t[-1]]))
    except (IndexError, ValueError) as error:
        yield Finding(r.method, "no states between", f"{type(error).__name__}: {error}, status {r.status}")
        return
    if not (
        np.array_equal(q[-1], r.motion.q[-1])
        or np.allclose(q[-1], r.motion.q[-1], rtol=1e-9, atol=1e-9 * size(r))
    ):
        yield Finding(
            r.method, "no states between", f"at the end {q[-1].tolist()}, kept {r.motion.q[-1].tolist()}"
        )


def size(r: Run) -> float:
    """How far the motion goes, at least a rounding of where it is."""
    q = r.motion.q
    return float(max(np.max(np.ptp(q, axis=0)), 1e-9 * np.max(np.abs(q)), 1e-9))


def impulses(d: Description, r: Run) -> Iterator[Finding]:
    """Impulses are not negative, and nothing is pressed that is open."""
    m, log = r.motion, r.motion.impacts
    if not d.contacts:
        return
    largest = float(max(np.max(m.impulse, initial=0.0), np.max(log.impulse, initial=0.0)))
    least = float(min(np.min(m.impulse, initial=0.0), np.min(log.impulse, initial=0.0)))
    if least < -ROUNDING * largest:
        yield Finding(r.method, "negative impulse", f"{least:.3g} beside {largest:.3g}")
    yield from open_impulses(d, r, largest)


def open_impulses(d: Description, r: Run, largest: float) -> Iterator[Finding]:
    """An impulse between two kept states asks for a gap that is closed at one of them (every event is kept)."""
    m = r.motion
    if len(m.t) < 2:
        return
    g = physics.gaps(d, m.t, m.q)
    u = physics.rates(d, m.t, m.q, m.v)
    h = np.diff(m.t)[:, None]
    if r.method.startswith("moreau"):
        low = g[:-1] + 0.5 * h * u[:-1]
    else:
        low = np.minimum(g[:-1], g[1:])
    reach = np.max(np.abs(u), axis=0) * np.max(h)
    allowed = ROUNDING * (size(r) + np.max(np.abs(g), axis=0)) + allowed_gap(d, r, reach)
    bad = (m.impulse[1:] > 1e-6 * largest) & (low > allowed)
    if np.any(bad):
        k, c = np.argwhere(bad)[0]
        text = f"impulse {m.impulse[k + 1, c]:.3g} of contact {c} while its gap is {low[k, c]:.3g} at t = {m.t[k + 1]:.9g}"
        yield Finding(r.method, "impulse while open", text)


def allowed_gap(d: Description, r: Run, reach: Any) -> Any:
    """How far off a gap may be that counts as closed: its tolerance, and what curvature adds within a step."""
    curved = 1e-2 * reach if d.curved or d.moving else 0.0
    return WAYS[r.method].tolerance * size(r) + (0.0 if r.method in EXACT else curved)


def penetration(d: Description, r: Run) -> Iterator[Finding]:
    """Nothing lies within an obstacle, but for what the order of the method explains."""
    if not d.contacts:
        return
    deep = depth(d, r)
    allowed = ROUNDING * size(r) + 10.0 * WAYS[r.method].tolerance * (1.0 + size(r)) + 1e-13 * place(d, r)
    if deep <= allowed:
        return
    if r.method in EXACT or (r.method.startswith("located") and not (d.curved or d.moving)):
        yield Finding(
            r.method, "penetration", f"{deep:.3g} in a motion of size {size(r):.3g}, status {r.status}"
        )
        return
    finer = run(d, r.method, 0.25)
    if finer.motion is None or not finer.done or deep < 1e-3 * size(r):
        return
    if depth(d, finer) > 0.7 * deep:
        text = f"{deep:.3g} in a motion of size {size(r):.3g}, and {depth(d, finer):.3g} with a quarter of the step"
        yield Finding(r.method, "penetration", text)


def place(d: Description, r: Run) -> float:
    """How large the numbers are that gaps are made of."""
    q = np.max(np.abs(r.motion.q), axis=0)
    bent = d.row("bend", d.contacts) * np.max(q) * max(1.0, np.max(q)) if d.curved else 0.0
    return float(np.max(np.abs(np.array(d.G)) @ q + np.abs(d.offset) + np.abs(bent), initial=0.0))


def depth(d: Description, r: Run) -> float:
    """The deepest place."""
    return float(-min(0.0, np.min(physics.gaps(d, r.motion.t, r.motion.q))))


def energy(d: Description, r: Run) -> Iterator[Finding]:
    """Nothing that is not fed gains energy, but for what the order of the method explains."""
    if physics.fed(d):
        return
    gained, scale = gain(d, r)
    tolerance = WAYS[r.method].tolerance
    events = r.motion.counts.events + r.motion.counts.steps
    allowed = ROUNDING + 1e-13 * events + 100.0 * tolerance * (1.0 + 0.01 * events)
    if gained <= allowed:
        return
    if r.method in EXACT:
        yield Finding(r.method, "energy gained", f"{gained:.3g} of {scale:.3g} J")
        return
    if gained < 1e-3:
        return
    finer = run(d, r.method, 0.25)
    if finer.done and gain(d, finer)[0] > 0.7 * gained:
        text = f"{gained:.3g} of {scale:.3g} J, and {gain(d, finer)[0]:.3g} with a quarter of the step or tolerance"
        yield Finding(r.method, "energy gained", text)


def gain(d: Description, r: Run) -> tuple[float, float]:
    """Largest rise of the energy above what it was before, relative to the largest energies, and these."""
    kinetic, potential = physics.energy(d, r.motion.q, r.motion.v)
    total = kinetic + potential
    scale = float(np.max(kinetic) + np.ptp(potential) + 1e-300)
    return float(np.max(total - np.minimum.accumulate(total))) / scale, scale


def impact_law(d: Description, r: Run) -> Iterator[Finding]:
    """An impact leaves u+ >= -r u-, exactly that where it is the only contact, and never with a negative impulse."""
    log = r.motion.impacts
    log = log[log.kind == Kind.IMPACT]
    if not len(log):
        return
    wanted = -d.rates()[log.contact] * np.minimum(log.before, 0.0)
    scale = np.max(np.abs(log.before)) + np.max(np.abs(log.after))
    off = wanted - log.after
    if d.contacts == 1 and r.method.startswith(("event", "located")):
        off = np.abs(off)
    k = int(np.argmax(off))
    if off[k] > 1e-7 * scale and not r.method.startswith("moreau"):
        e = log[k]
        text = f"contact {e.contact} from {e.before:.6g} to {e.after:.6g} at t = {e.time:.9g}"
        yield Finding(r.method, "law of impact", text)


CHECKS: tuple[Callable[[Description, Run], Iterator[Finding]], ...] = (
    finite, reaches_the_end, in_time, between, impulses, penetration, energy, impact_law
)  # fmt: skip


def check(d: Description, r: Run) -> list[Finding]:
    """All findings of one run."""
    if r.status == "raised":
        return [Finding(r.method, "raised", r.text)]
    if r.motion is None or not len(r.motion.t):
        return []
    found = list(finite(d, r))
    return found or [x for each in CHECKS[1:] for x in each(d, r)]
