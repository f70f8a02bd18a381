"""The table of all checks: importing the modules registers them."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from lagrangian.scenes import CATALOGUE
from lcpstep.errors import UnknownName
from lcpstep.hard import (
    balls,
    beads,
    cams,
    chaos,
    friction,
    oscillators,
    pendulums,
    piles,
    stick_slip,
    tables,
)
from lcpstep.hard.check import CHECKS, Row, run_check
from lcpstep.hard.methods import METHODS

FAMILIES = (balls, tables, oscillators, pendulums, beads, piles, cams, friction, stick_slip, chaos)


def table(
    scenes: Iterable[str] = (),
    methods: Iterable[str] = (),
    full: bool = False,
    progress: Callable[[Row], None] | None = None,
) -> list[Row]:
    """Run the checks.

    Parameters
    ----------
    scenes, methods : names of those wanted; all where none is given
    full : the heavy checks too, which take minutes
    progress : called with each line as it is done

    Raises
    ------
    UnknownName   a scene or method that does not exist
    """
    wanted, by = list(scenes), list(methods)
    for name in wanted:
        if name not in CATALOGUE:
            raise UnknownName("scene", name, CATALOGUE)
    for name in by:
        if name not in METHODS:
            raise UnknownName("method", name, METHODS)
    rows = []
    for c in sorted(CHECKS, key=lambda c: list(CATALOGUE).index(c.scene)):
        if (c.heavy and not full) or (wanted and c.scene not in wanted):
            continue
        for method in METHODS:
            if method in c.bounds and (not by or method in by):
                rows.append(run_check(c, method))
                if progress is not None:
                    progress(rows[-1])
    return rows
