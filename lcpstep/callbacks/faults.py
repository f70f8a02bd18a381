"""Exceptions of the user's functions, in machine code and in plain Python: of which, and what it was called with.

Machine code does not pass an exception on: it leaves `out` not-a-number and notes it here (`callbacks.guarded`), and
so a kernel that overlooks the number is found out. What Python raises is kept, for the run to raise from.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrangian.checks import shown

Array = NDArray[np.float64]
Callback = Callable[..., Any]  # f(t, q, v, p, out) or f(t, x, p, out)


class Fault(NamedTuple):
    """An exception of a callback: of which, what it was called with, and what it said; in machine code it is mute."""

    name: str
    t: float
    q: Array
    v: Array
    said: str = "an exception that it raises in machine code only (integers have 64 bits there)"
    error: BaseException | None = None  # itself, where Python raised it

    def __str__(self) -> str:
        at = f"t = {self.t:.9g}, q = {shown(self.q)}, v = {shown(self.v)}"
        return f"{self.name} at {at}: {self.said}"


class Noted(threading.local):
    """Of a thread: the first exception since `forget`, and whether a user's function is at work in Python."""

    fault: Fault | None = None
    asking: bool = False


LOCAL = Noted()
NOTHING = None, False  # what a thread has noted outside of all runs


def name_of(f: Callback) -> str:
    """The name that the user has given."""
    return str(getattr(f, "__qualname__", None) or type(f).__qualname__)


def note(noted: Fault) -> None:
    """Keep the first exception of this thread, for those that follow may follow from it; an interrupt does not."""
    if fault() is None or isinstance(noted.error, KeyboardInterrupt):
        LOCAL.fault = noted


def fault() -> Fault | None:
    """The first exception of a callback in this thread since `forget`."""
    return LOCAL.fault


def set_aside() -> tuple[Fault | None, bool]:
    """What this thread has noted, for a run of its own, which a callback of another may have made."""
    before = LOCAL.fault, LOCAL.asking
    LOCAL.fault = None
    return before


def take_up(before: tuple[Fault | None, bool]) -> None:
    """What was set aside, in the place of all that was noted since but an interrupt that is still to be heard."""
    LOCAL.asking = before[1]
    if not interrupted():
        LOCAL.fault = before[0]


def forget_all() -> None:
    """Leave out of account all that callbacks have raised up to here."""
    LOCAL.fault = None


def forget() -> None:
    """The same, but for an interrupt of the keyboard, which the run has yet to hear."""
    if not interrupted():
        forget_all()


def interrupted() -> bool:
    """Whether a callback has heard an interrupt of the keyboard that its run has yet to hear."""
    noted = fault()
    return noted is not None and isinstance(noted.error, KeyboardInterrupt)


def cause() -> BaseException | None:
    """The exception itself, where Python has raised it; an interrupt of the keyboard goes on its way, once."""
    noted = fault()
    error = None if noted is None else noted.error
    if isinstance(error, KeyboardInterrupt):
        forget_all()
        raise error
    return error
