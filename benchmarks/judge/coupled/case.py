"""One scene of coupled bodies before the judge: methods agree, and starts moved by rounding end together.

Such motions may grow small errors by many orders, impact by impact, and whatever moves them by 1e-10 says by how
much. What moves them by 1e-13 then has to stay nearer by about as much. Where it does not, and has been nearer by far
a moment before, rounding has decided something, as which of two contacts opens, that the motion itself does not leave
open. (A run's own rounding, of some 1e-12, grows as steadily.)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.judge.agree import finer_by, positions
from benchmarks.judge.case import SHARE, Verdict, chance, said
from benchmarks.judge.checks import in_order, reaches_the_end
from benchmarks.judge.coupled.scenes import Coupled, energy
from benchmarks.judge.runs import REFERENCE, WAYS, Finding, Hung, Run, run
from lagrangian import LinearSystem

LOOKS, WAYS_OUT = 100, 3  # in time; directions in which a start is moved
ROUNDING, LITTLE = 1e-13, 1e-10  # by which it is [m], [rad]
SEEN, SUDDEN = 1e-6, 1e3  # from which on it is looked at; times what it was a look before
STEADY = 0.1  # of those moved by LITTLE, 1000 times as far at first; roots, as of grazes, leave 30 of that
NEAR, FARTHER, FACTOR, CONVERGED = 3e-6, 100.0, 10.0, 0.02
GAINED = 1e-5  # J, or what is asked of a run; steps of `Moreau` gain more, along what bends
# Of the energy: what steps of order two, and this loose a tolerance, make
OF_ENERGY = {"located": 2e-6, "event-driven-loose": 2e-6}


def judged(
    d: Coupled,
    methods: Iterable[str] = tuple(WAYS),
    tell: Callable[[str], None] = lambda name: None,
    share: float = SHARE,
    without: tuple[str, ...] = (),
) -> Verdict:
    """Runs of the methods on a scene, as `benchmarks.judge.case.judged` has them.

    `share`: of the runs of other methods than the reference whose starts are moved as well.
    """
    endings: dict[str, str] = {}
    findings: list[Finding] = []
    methods = list(methods)
    looks, reference = np.linspace(0.0, d.length, LOOKS + 1), None
    for name in dict.fromkeys([REFERENCE, *methods]):
        if name in without:
            continue
        tell(name)
        try:
            r = run(d, name)
            found = list(check(d, r))
            far = None
            if r.done and (name == REFERENCE or chance(d, name, 1).random() < share):
                near, far = (spread(d, r, by, looks) for by in (ROUNDING, LITTLE))
                found += parts(name, near, far, looks)
            if name in methods:
                endings[name] = r.ending
                findings += said(r, found)
            if name == REFERENCE and r.done:
                reference, foretold = r, far
            elif reference is not None and r.done and name in methods:
                findings += said(r, agrees(d, r, reference, NEAR + FARTHER * foretold, looks))
        except Hung as error:
            endings[name] = "hang"
            findings.append(Finding(name, "hang", str(error)))
    return Verdict(endings, findings, {})


def check(d: Coupled, r: Run) -> Iterator[Finding]:
    """What physics demands of one run."""
    if r.motion is None:
        return
    if not r.done:
        yield Finding(r.method, f"ends early: {r.status}", r.text)
    for each in (reaches_the_end, in_order):
        yield from each(d, r)
    if isinstance(r.motion.scene.system, LinearSystem) and not r.method.startswith("moreau"):
        each, tolerance = energy(r.motion), getattr(r.motion.method, "tolerance", None) or 0.0
        gained, share = np.max(np.diff(each), initial=0.0), OF_ENERGY.get(r.method, 0.0)
        if gained > max(GAINED, tolerance, share * np.max(np.abs(each))):
            yield Finding(r.method, "gains energy", f"{gained:.3g} J")


def apart(r: Run, q: Any, looks: Any) -> Any:
    """How far a run has been from places q until each look; infinite beyond its end."""
    found = np.full(len(looks), np.inf)
    there = looks <= r.motion.t[-1] if r.usable else np.zeros(len(looks), dtype=bool)
    if np.any(there):
        found[there] = np.max(np.abs(positions(r, looks[there]) - q[there]), axis=1)
    return np.maximum.accumulate(found)


def spread(d: Coupled, r: Run, by: float, looks: Any) -> Any:
    """How far from a run those have been whose starts are moved."""
    moved = (run(replace(d, moved=by, way=k), r.method, keep=looks) for k in range(WAYS_OUT))
    return np.max([apart(x, positions(r, looks), looks) for x in moved], axis=0)


def parts(name: str, near: Any, far: Any, looks: Any) -> Iterator[Finding]:
    """Whether starts moved by rounding part at once, as far as others do, when that is first seen."""
    k = int(np.argmax(near > SEEN))
    sudden = k > 0 and near[k] > max(SEEN, SUDDEN * near[k - 1])
    if sudden and (near[k] == np.inf or near[k] > STEADY * far[k]):
        text = f"{near[k]:.3g} apart at t = {looks[k]:.9g} from {ROUNDING}, {far[k]:.3g} from {LITTLE}"
        yield Finding(name, "parts by rounding", text)


def agrees(d: Coupled, r: Run, reference: Run, allowed: Any, looks: Any) -> Iterator[Finding]:
    """Whether a method converges to another motion than the reference; finer steps must not come nearer to that."""
    q = positions(reference, looks)
    finer = run(d, r.method, finer_by(r))
    own, distance = apart(finer, positions(r, looks), looks), apart(finer, q, looks)
    bad = np.flatnonzero((own < CONVERGED) & (distance > FACTOR * own + allowed))
    if len(bad):
        k = int(bad[0])
        finest = apart(run(d, r.method, finer_by(r) ** 3), q, looks)[k]
        if 0.3 * distance[k] < finest < np.inf:  # a run that ends early says nothing of where it converges to
            text = f"{distance[k]:.3g}, finer {finest:.3g} from {reference.method} at t = {looks[k]:.9g}"
            yield Finding(r.method, "disagrees", f"{text}, {own[k]:.3g} from itself with a finer step")
