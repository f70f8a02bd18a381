"""What the loop over a system with modes works on: bounds, memory, and the places of its numbers."""

from __future__ import annotations

from typing import Any, NamedTuple

from lcpstep.compiled import by_address

# Why the loop returned
FINISHED, BUFFER_FULL, NOT_FINITE, TOO_MANY_EVENTS, STEP_TOO_SMALL, ENDLESS, NOT_TRANSVERSAL = range(7)
# Places in the array of counters
STEP, ROW, SWITCH, FORCES, MODE, EVENTS, STALLED, BEGUN, CULPRIT = range(9)
N_COUNTERS = 9
# Places in the array of numbers
NOW, NEXT, LAST_SWITCH, EVENT_AT, WAS_ARMED = range(5)
N_NUMBERS = 5
# In a row: time, duration and mode of the step that follows; then the state
TIME, LENGTH, ROW_MODE, LEAD = range(4)
# In a line of the switch log: time, modes left and entered, guard; then the states before and after
SWITCH_LEAD = 4


@by_address
class Flow(NamedTuple):
    """Span, tolerances and bounds."""

    t_end: float
    rtol: float
    atol: float
    longest: float  # step
    max_events: int


@by_address
class Memory(NamedTuple):
    """What a run knows of its guards, and where it writes."""

    armed: Any  # (guards,) whether each has been below its band since the mode began
    band: Any  # (guards,)
    states: Any  # (DEGREE + 1 + CHECKS, n) samples of a step
    rows: Any  # (rows, LEAD + n)
    dense: Any  # (rows, 7, n); no rows where nothing but switches is kept
    log: Any  # (switches, SWITCH_LEAD + 2 n)


@by_address
class Loop(NamedTuple):
    """Everything that the loop is handed."""

    m: Any  # the system, a `field.Machine`
    flow: Any
    memory: Any
    scan: Any  # of guards, a `roots.Scan`
    w: Any  # of the Runge-Kutta method
    count: Any  # (N_COUNTERS,)
    x: Any  # (N_NUMBERS,)
