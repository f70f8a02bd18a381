"""All looks at a finished run, in turn, those that tell most first: what the first of them says that has anything."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lagrangian import Contacts
from lcpstep.doubts.depth import too_deep
from lcpstep.doubts.hops import too_short
from lcpstep.doubts.jolts import jolted
from lcpstep.doubts.leaps import leapt
from lcpstep.doubts.outrun import outrun
from lcpstep.doubts.resolution import unresolved
from lcpstep.doubts.shared_normals import slide_on_one
from lcpstep.doubts.turned import turned
from lcpstep.warned import warn

if TYPE_CHECKING:
    from lcpstep.trajectory import Trajectory


def doubt(run: Trajectory) -> str:
    """What is to be doubted of a run, in words; empty for nothing."""
    return (
        _of_obstacles(run)
        or leapt(run)
        or jolted(run)
        or too_deep(run)
        or unresolved(run)
        or turned(run)
        or outrun(run)
        or too_short(run)
        or slide_on_one(run)
    )


def _of_obstacles(run: Trajectory) -> str:
    """Which obstacle has left no room, or has no normal or no inside, in words; a flat one always has all three."""
    if not isinstance(run.scene.contacts, Contacts):
        return ""
    from lcpstep.doubts.normals import no_normal
    from lcpstep.doubts.room import no_room
    from lcpstep.doubts.sides import passed_through

    return no_room(run) or no_normal(run) or passed_through(run)


def warn_of_fast_gaps(run: Trajectory) -> None:
    """A warning where a gap turns fast with the place, and the method looks for events at times."""
    if getattr(run.method, "audit", True) or not isinstance(run.scene.contacts, Contacts):
        return
    from lcpstep.doubts.fast_gaps import fast_gap
    from lcpstep.turns.stops import FastTurn

    words = fast_gap(run)
    if words:
        warn(f"{run.scene.name!r}: {words}", FastTurn)
