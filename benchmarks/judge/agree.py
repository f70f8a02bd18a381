"""Whether a method agrees with the reference, as far as the motion can be foretold.

X(h) and X(0.23 h) say how far the method is from where it goes; companions of the reference, disturbed a little, say
how far the motion itself can be told, and `grazes` what none of them sees. Where the method has converged and the
reference stays where it is when disturbed, the two have to be at one place. A suspicion is confirmed by finer steps,
which must not come nearer, and by companions disturbed by as much as the method errs, none of which may reach as far
(behind a discontinuity they do).
"""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from typing import Any

import numpy as np

from benchmarks.judge import physics
from benchmarks.judge.describe import Description, numbers
from benchmarks.judge.graze import grazes
from benchmarks.judge.hops import highest_hop, left_within
from benchmarks.judge.runs import WAYS, Finding, Run, run
from benchmarks.judge.scales import EPS
from benchmarks.judge.start import along, joined
from benchmarks.judge.told import look_up, looks, told_until

SMALL = 1e-9  # disturbance that tells how far the motion can be foretold
FACTOR, NOISE = 30.0, 100.0
CONVERGED, TOLD = 0.02, 1e-3  # of the size of the motion
COMPANIONS = 6
MANY = 20_000  # steps of the finest run
DEAR = 200_000  # steps that a tolerance has taken: a smaller one may take any number
EARLY, CLEAR = (
    8,
    30.0,
)  # looks at which the order is seen; of the error of the reference: what is far above it


def disturbed(d: Description, share: float, size: float, seed: int) -> Description:
    """The scene with everything a little different, but what is closed, at rest, or 0 or 1; joints hold at its start.

    share : of every number; places are moved by that share of `size`
    """
    rng = np.random.default_rng([seed, 99])
    share = min(share, 0.1)

    def off(values: Any) -> Any:
        return numbers(np.asarray(values) * (1.0 + share * rng.uniform(-1.0, 1.0, np.shape(values))))

    own = np.abs(np.concatenate([d.row("q0"), d.row("offset", d.contacts), d.length * d.row("v0")])).max(
        initial=0.0
    )
    moved = min(share * size, 0.1 * own) if own > 0.0 else share * size  # a motion may have gone to 1e36 m
    q0 = np.array(d.q0) + moved * rng.uniform(-1.0, 1.0, d.n)
    t, faster = d.t_span[0], 1.0 + share * rng.uniform(-1.0, 1.0)
    rougher = 1.0 + share * rng.uniform(-1.0, 1.0, len(d.T))
    new = replace(
        d, q0=numbers(q0), v0=numbers(faster * np.array(d.v0)), constant=off(d.constant), cosine=off(d.cosine),
        sine=off(d.sine),
        mu=numbers(rougher * d.row("mu", len(d.T))), mu_s=numbers(rougher * np.array(d.mu_s)) if d.mu_s else (),
        slip=numbers(faster * np.array(d.slip)), sway=numbers(faster * np.array(d.sway)),
        restitution=numbers([min(r * (1.0 + share * rng.uniform(-1.0, 1.0)), 0.5 + 0.5 * r) for r in d.rates()]),
    )  # fmt: skip
    if d.J:
        new = replace(joined(new, q0), v0=numbers(along(physics.joint_rows(d, q0), np.array(new.v0))))
    if not d.contacts:
        return new
    g = physics.gaps(d, t, np.array(d.q0))
    wanted = np.where(g > 1e-15, np.maximum(off(g), 0.0), 0.0)
    offset = d.row("offset", d.contacts)
    for _ in range(2):
        offset = offset + wanted - physics.gaps(replace(new, offset=tuple(offset)), t, q0)
    return replace(new, offset=numbers(offset))


class Reference:
    """The motion that the others are held against, and how far it can be told."""

    def __init__(self, d: Description, r: Run) -> None:
        self.d, self.run = d, r
        m = r.motion
        self.looks = looks(d, float(m.t[-1]))
        self.q = m.at(self.looks)[0]
        self.size = r.scales(d).length
        self.noise = np.zeros(len(self.looks))
        for k in range(2):
            self.noise = np.maximum(self.noise, self.companion(SMALL, k))
        # What grazes after a plastic impact does so however it is disturbed, and rounding decides whether it strikes
        self.noise = np.maximum(self.noise, self.apart(run(d, r.method, finer_by(r))))
        self.until = told_until(d, r)
        self.orders: dict[str, float] = {}  # seen of the methods that were held against it

    def companion(self, share: float, k: int) -> Any:
        """How far a companion disturbed by so much has been from the reference until then; infinite where unknown."""
        r = run(disturbed(self.d, share, self.size, k), self.run.method)
        return self.apart(r)

    def apart(self, r: Run) -> Any:
        """How far another motion has been from this one until each look."""
        found = np.full(len(self.looks), np.inf)
        if r.motion is None or not len(r.motion.t):
            return found
        there = self.looks <= r.motion.t[-1]
        if np.any(there):
            found[there] = np.max(np.abs(positions(r, self.looks[there]) - self.q[there]), axis=1)
        return np.maximum.accumulate(found)

    def see_order(self, r: Run, coarse: Any, fine: Any, told: Any) -> None:
        """Note by which order the error of steps of one size goes down at the first looks where it is clear.

        Later the motion, which grows errors or forgets them, hides it.
        """
        own = self.run.tolerance * (1.0 + self.size) * np.maximum(1.0, self.noise / (SMALL * self.size))
        clear = told & (fine > CLEAR * own) & (coarse < CONVERGED * self.size)
        early = np.flatnonzero(clear)[:EARLY]
        if len(early) and r.tolerance == 0.0:
            ratio = coarse[early] / fine[early]
            self.orders[r.method] = float(np.median(np.log(ratio)) / -np.log(finer_by(r)))


def positions(r: Run, times: Any) -> Any:
    """Coordinates at times of a run; not a number where the run does not tell (a finding of its own)."""
    try:
        return r.at(times)[0]
    except (IndexError, ValueError):
        return np.full((len(times), r.motion.q.shape[1]), np.nan)


def apart(a: Run, b: Run, looks: Any) -> Any:
    """How far two motions have been from each other until each look, infinite beyond the end of one."""
    found = np.full(len(looks), np.inf)
    there = looks <= min(a.motion.t[-1], b.motion.t[-1])
    if np.any(there):
        found[there] = np.max(np.abs(positions(a, looks[there]) - positions(b, looks[there])), axis=1)
    return np.maximum.accumulate(found)


def finer_by(r: Run) -> float:
    """By how much the step or the tolerance is made smaller.

    Grids must not lie within each other: impacts of `Moreau`, and releases at order two, err by how far they are from
    the time before. Just behind one that all grids have, the error would be the same for every step.
    """
    return 0.0625 if r.tolerance > 0.0 else 0.23


def agrees(reference: Reference, r: Run) -> list[Finding]:
    """Findings where the method has converged to another motion, misses its tolerance, or does not converge."""
    if not r.usable or r.method == reference.run.method or r.motion.counts.steps > DEAR:
        return []
    ref, d = reference, reference.d
    finer = run(d, r.method, finer_by(r))
    if not finer.usable:
        return []
    look_up(d, finer, ref.looks)
    until = min([ref.until, *(told_until(d, x) for x in (r, finer))])
    own, distances = apart(r, finer, ref.looks) + _scatter(ref, r), [ref.apart(x) for x in (r, finer)]
    rounding = 1e-7 * ref.size + 1e3 * EPS * float(np.max(np.abs(ref.q))) + NOISE * ref.noise
    promised = 10.0 * r.tolerance * (1.0 + ref.size) * np.maximum(1.0, ref.noise / (SMALL * ref.size))
    told = (ref.noise < TOLD * ref.size) & (ref.looks < until)
    for x in (r, finer):
        if not x.done:  # what ends early, and says so, is counted among the endings
            told &= ref.looks <= x.motion.t[-1]
    ref.see_order(r, *distances, told)
    converged = told & (own < CONVERGED * ref.size)
    settled = converged & (own > 1e-5 * ref.size) & (ref.noise < 1e3 * SMALL * ref.size)
    tests = {
        "disagrees": converged & (distances[1] > FACTOR * own + rounding + promised),
        "tolerance missed": told & (r.tolerance > 0.0) & (distances[0] > promised + rounding),
        "finer tolerance missed": told
        & (r.tolerance > 0.0)
        & (distances[1] > finer_by(r) * promised + rounding),
        "no order": settled
        & (r.tolerance == 0.0)
        & (distances[1] > 0.7 * distances[0] + rounding + _scatter(ref, r)),
    }
    before = np.where(np.isfinite(own), own, 0.0)  # of a graze, which magnifies it
    before[1:] = before[:-1]
    for kind, bad in tests.items():
        where = np.flatnonzero(bad)
        if len(where) and ref.looks[where[0]] < grazes(
            d, ref.run.motion, ref.looks, before + rounding + promised
        ):
            return _confirmed(ref, r, kind, int(where[0]), float(own[where[0]]), distances)
    return []


def _scatter(ref: Reference, r: Run) -> float:
    """What a method leaves of places open, in whichever steps.

    Impacts rounded to a grid fall where they happen to, and hops between two of its times are rest. Hops that are
    shorter than a step have the one acceleration of a piece of order two: what damping takes from them is known to no
    digit, and places but for their height.
    """
    if r.method == "moreau":
        return 0.25 * ref.d.h * max(float(np.max(np.abs(x.motion.v))) for x in (r, ref.run))
    return highest_hop(ref.d, r.motion) if r.method == "located" else 0.0


def nearer(ref: Reference, r: Run, k: int, distance: float) -> bool:
    """Whether finer steps come nearer to the reference, or cannot be taken: a 16th, and less where the order says so.

    A contact that lets go within a step may do so at its beginning; where that is so of all these steps, they differ
    by nothing, and lie within (h / time)^order of the motion's size. So do those of `Moreau` that leave a contact
    deeper than it hops (`left_within`).
    """
    d, sizes, order = ref.d, r.scales(ref.d), WAYS[r.method].order
    for power in count(2):
        factor = finer_by(r) ** power
        finest = run(d, r.method, factor)
        if not finest.usable or ref.apart(finest)[k] < 0.3 * distance:
            return True
        explained = sizes.length * (factor * d.h / sizes.time) ** order
        if r.method == "moreau":
            explained += left_within(d, ref.run.motion, factor * d.h, float(ref.looks[k]))
        if r.tolerance > 0.0 or distance > explained or d.length * finer_by(r) > MANY * factor * d.h:
            break
    return False


def _confirmed(ref: Reference, r: Run, kind: str, k: int, own: float, distances: list[Any]) -> list[Finding]:
    """The finding, unless a still finer step comes nearer, or a disturbed companion goes as far."""
    if "tolerance" in kind:
        own = r.tolerance * ref.size * (1.0 if kind == "tolerance missed" else finer_by(r))
    which = 0 if kind == "tolerance missed" else 1
    distance = float(distances[which][k])
    if which and nearer(ref, r, k, distance):
        return []
    share = max(3.0 * own / ref.size, 1e-8)
    for i in range(COMPANIONS):
        if ref.companion(share, 10 + i)[k] > 0.1 * distance:
            return []
    text = (
        f"{distance:.3g} from {ref.run.method} at t = {ref.looks[k]:.9g} in a motion of size {ref.size:.3g}, "
        f"{own:.3g} from itself with a finer step or tolerance"
    )
    return [Finding(r.method, kind, text)]
