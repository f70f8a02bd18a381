"""What to follow over periods of the forcing, how far, and where the answers go."""

from __future__ import annotations

from typing import Any, NamedTuple

UNREACHED = -1  # no target
INSIDE = -1  # among the codes: a start inside of the obstacle
IMPACTS, ENDS = 0, 1  # places in the counts of a period: impacts, chattering sequences or landings


class Task(NamedTuple):
    """M runs, of each of which `kept` periods are looked at; arrays are contiguous, those of counts of intp."""

    t_start: float
    t_end: float  # one period later
    drop: int  # periods before the kept ones
    periods: int  # in all
    starts: Any  # (m, 2) states (q, v) at t_start
    targets: Any  # (k, 2) a run ends where it comes near one of these
    radius: Any  # (k,) how near, in units of `scale`
    scale: Any  # (2,)
    states: Any  # (m, kept, 2) after each kept period
    impacts: Any  # (m, kept, most, 3) time and gap velocities before and after; the first ones of each period
    struck: Any  # (m, kept, most) contact of each impact
    resting: Any  # (m, kept, most) contact of each landing
    landings: Any  # (m, kept, most) time of each landing in it; the first ones
    counts: Any  # (m, kept, 2) see IMPACTS, ENDS
    tangents: Any  # (m, kept, 2, 2) derivative of each kept period's end by its start; (m, 0, 2, 2) for none
    reached: Any  # (m,) the target that was reached, or UNREACHED
    taken: Any  # (m,) periods taken
    final: Any  # (m, 2) the last state
    codes: Any  # (m,) why the loop over events returned
    strict: bool  # a start inside of the obstacle ends its run
