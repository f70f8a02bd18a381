"""Interval arithmetic on arrays of bounds, and users' functions evaluated on it."""

from lcpstep.intervals.callbacks import enclose
from lcpstep.intervals.moving import Moving
from lcpstep.intervals.numbers import Interval
from lcpstep.intervals.paths import NotEnclosed

__all__ = ["Interval", "Moving", "NotEnclosed", "enclose"]
