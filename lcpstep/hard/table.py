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
from lcpstep.pace import counted

HEAVY = 20.0  # how many times as long a heavy check is expected to take, for progress
FAMILIES = (balls, tables, oscillators, pendulums, beads, piles, cams, friction, stick_slip, chaos)


def table(
    scenes: Iterable[str] = (),
    methods: Iterable[str] = (),
    full: bool = False,
    progress: Callable[[Row], None] | None = None,
    bars: bool = False,
) -> list[Row]:
    """Run the checks.

    Parameters
    ----------
    scenes, methods : names of those wanted; all where none is given
    full : the heavy checks too, which take minutes
    progress : called with each line as it is done
    bars : give the runs error bars

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
    checks = [
        (c, method)
        for c in sorted(CHECKS, key=lambda c: list(CATALOGUE).index(c.scene))
        for method in METHODS
        if (full or not c.heavy)
        and (not wanted or c.scene in wanted)
        and method in c.bounds
        and (not by or method in by)
    ]
    rows = []
    for c, method in counted(checks, [HEAVY if c.heavy else 1.0 for c, _ in checks]):
        rows.append(run_check(c, method, bars))
        if progress is not None:
            progress(rows[-1])
    return rows
