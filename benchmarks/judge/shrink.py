"""An anomaly made small: hypothesis looks for the simplest part of its scene on which the same goes wrong."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import hypothesis
import numpy as np
from hypothesis import strategies as st
from hypothesis.errors import NoSuchExample

from benchmarks.judge import physics
from benchmarks.judge.describe import PER_ROW, Description
from benchmarks.judge.shapes import digits

EMPTY = {
    "K": (), "C": (), "cosine": (), "sine": (), "constant": (), "amplitude": (), "frame": (), "pendulum": 0.0,
    "slip": (), "sway": (), "mu_s": (),
    "spread": 0.0, "general": False, "function": False, "form": 0, "round": (), "bend": (), "restitution": 0.0,
}  # fmt: skip
PER_JOINT = ("J", "joint_offset", "joint_bend")
PER_COORDINATE = ("q0", "v0", "constant", "cosine", "sine", "frame", "b")
ROUNDED = ("M", "K", "C", "v0", "q0", "constant", "cosine", "sine", "G", "b", "force_omega", "omega", "h")
EXAMPLES = 400


def parts(d: Description) -> st.SearchStrategy[Description]:
    """Simpler scenes; hypothesis prefers zeros, and a zero leaves out."""
    names = [x for x, nothing in EMPTY.items() if getattr(d, x) != nothing]
    kept = st.integers(0, 9)

    def made(
        fields: list[int], contacts: list[int], joints: list[int], coordinates: list[int], others: list[int]
    ) -> Any:
        new = replace(d, **{x: EMPTY[x] for x, k in zip(names, fields, strict=True) if k == 0})
        new = _chosen(new, PER_ROW, [i for i, k in enumerate(contacts) if k])
        new = _chosen(new, PER_JOINT, [i for i, k in enumerate(joints) if k])
        new = _smaller(new, [i for i, k in enumerate(coordinates) if k])
        length, start, n = others
        span = new.length * 0.5 ** (9 - length)
        t = new.t_span[0] if start else 0.0
        new = replace(new, t_span=(t, t + max(span, new.h)))
        return _rounded(new, d, n) if n < 9 else new

    def several(n: int) -> st.SearchStrategy[list[int]]:
        return st.lists(kept, min_size=n, max_size=n)

    return st.builds(
        made, several(len(names)), several(d.contacts), several(len(d.J)), several(d.n),
        st.tuples(st.integers(0, 9), kept, st.integers(1, 9)).map(list),
    )  # fmt: skip


def _chosen(d: Description, names: tuple[str, ...], rows: list[int]) -> Description:
    """Only these contacts or joints."""
    values = {x: getattr(d, x) for x in names}
    return replace(
        d, **{x: tuple(v[i] for i in rows) for x, v in values.items() if isinstance(v, tuple) and v}
    )


def _smaller(d: Description, places: list[int]) -> Description:
    """Only these coordinates; all of them if none would be left."""
    if not places or len(places) == d.n:
        return d
    rows = {x: tuple(getattr(d, x)[i] for i in places) for x in PER_COORDINATE if getattr(d, x)}
    square = {
        x: tuple(tuple(getattr(d, x)[i][j] for j in places) for i in places) for x in "MKC" if getattr(d, x)
    }
    wide = {x: tuple(tuple(row[j] for j in places) for row in getattr(d, x)) for x in "GTJ" if getattr(d, x)}
    return replace(d, **rows, **square, **wide)


def _rounded(d: Description, old: Description, n: int) -> Description:
    """Numbers of n digits, with the gaps at the start as they were."""

    def short(x: Any) -> Any:
        return tuple(map(short, x)) if isinstance(x, tuple) else digits(x, n)

    new = replace(d, **{x: short(getattr(d, x)) for x in ROUNDED})
    if not d.contacts:
        return new
    wanted = np.vectorize(lambda x: digits(x, n))(physics.gaps(d, d.t_span[0], np.array(d.q0)))
    off = physics.gaps(new, new.t_span[0], np.array(new.q0)) - np.where(np.abs(wanted) < 1e-12, 0.0, wanted)
    return replace(new, offset=tuple(map(float, new.row("offset", d.contacts) - off)))


def shrunk(d: Description, wrong: Callable[[Description], bool], seconds: float) -> Description:
    """The simplest scene found within a time on which `wrong` holds; the scene itself where there is none."""
    best, end = d, time.monotonic() + seconds

    def condition(new: Description) -> bool:
        nonlocal best
        if time.monotonic() > end:
            return False
        try:
            new.scene()
        except (ValueError, ZeroDivisionError):
            return False
        if not wrong(new):
            return False
        best = new if len(repr(new)) <= len(repr(best)) else best
        return True

    settings = hypothesis.settings(
        max_examples=EXAMPLES,
        derandomize=True,
        deadline=None,
        database=None,
        suppress_health_check=list(hypothesis.HealthCheck),
    )
    try:
        return hypothesis.find(parts(d), condition, settings=settings)
    except (NoSuchExample, hypothesis.errors.Flaky):  # out of time: what has been found until then
        return best
