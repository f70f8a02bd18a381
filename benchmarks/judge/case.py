"""One scene before the judge: all runs, all checks."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from benchmarks.judge.agree import Reference, agrees
from benchmarks.judge.checks import check
from benchmarks.judge.describe import Description
from benchmarks.judge.runs import REFERENCE, SAID, WAYS, Clock, Finding, Hung, Run, run
from benchmarks.judge.told import look_up, looks
from benchmarks.judge.vary import varied

SHARE, SEVERAL = 0.25, 2
LONG = 20_000  # steps beyond which a run is looked at for itself only: finer ones would take minutes


class Verdict(NamedTuple):
    """How each method ended, what was found, and the orders that were seen."""

    endings: dict[str, str]
    findings: list[Finding]
    orders: dict[str, float]


def judged(
    d: Description,
    methods: Iterable[str] = tuple(WAYS),
    tell: Callable[[str], None] = lambda name: None,
    share: float = SHARE,
    without: tuple[str, ...] = (),
) -> Verdict:
    """Runs of the methods on a scene; `tell` is called with the name of the method that is at work.

    `share`: of the runs that are held against others of the same question in other words; with 1 everything is done.
    `without`: methods that are left out, the reference too.
    """
    endings, findings, reference, Clock.evaluations = {}, [], None, 0
    compared = d.length < LONG * d.h
    methods = list(methods)
    with np.errstate(all="ignore"):
        for name in dict.fromkeys([REFERENCE, *methods]):
            if name in without:
                continue
            tell(name)
            try:
                asked = beginning(d, name)
                r = run(asked, name)
                if compared and r.usable:
                    look_up(d, r, looks(d, float(r.motion.t[-1])))
                if name in methods:
                    endings[name] = r.ending
                    findings += said(r, check(asked, r))
                    rng = chance(d, name, 1)
                    if compared and rng.random() < share:
                        findings += said(r, varied(d, r, rng, SEVERAL))
                if name == REFERENCE:
                    if r.usable and compared and not r.doubt:
                        Clock.evaluations = r.motion.counts.force_evaluations
                        reference = Reference(d, r)
                elif reference is not None and r.status != "NOT_FINITE":
                    findings += said(r, agrees(reference, r))
            except Hung as error:
                endings[name] = "hang"
                findings.append(Finding(name, "hang", str(error)))
    return Verdict(endings, findings, reference.orders if reference else {})


def beginning(d: Description, method: str) -> Description:
    """The scene, or of one too long to be compared the beginning: what a method by a tolerance is asked.

    It shares the tolerance over the span, so that its steps grow as the power 3/2 of that: 42 million of a groove.
    """
    if not method.endswith("-tolerance") or d.length < LONG * d.h:
        return d
    start = d.t_span[0]
    return replace(d, t_span=(start, start + LONG * d.h))


def said(r: Run, findings: Iterable[Finding]) -> list[Finding]:
    """Findings, of a run that says itself that it is wrong by another name: these are not silent."""
    return [x._replace(kind=SAID + x.kind) if r.doubt else x for x in findings]


def chance(d: Description, method: str, what: int) -> Any:
    """Random numbers that depend on the scene and the method alone."""
    return np.random.default_rng([zlib.crc32(repr(d).encode()), list(WAYS).index(method), what])
