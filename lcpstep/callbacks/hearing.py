"""Interrupts of the keyboard while C calls functions that stay in Python.

Python raises an interrupt wherever it is; between C and the user's function that is where nobody can catch it, and it
would be dropped, with the function's answer. There it is noted instead (`callbacks.faults`), as one that the function
itself has heard, for the run to raise.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from functools import wraps
from types import CodeType, FrameType
from typing import Any, ParamSpec, TypeVar

import numpy as np

from lcpstep.callbacks.faults import LOCAL, NOTHING, Fault, cause, interrupted, note, set_aside, take_up

P = ParamSpec("P")
T = TypeVar("T")
EXPECTED = False  # until there is a function that C calls: handlers take their time
BETWEEN: set[CodeType] = set()  # of functions that C calls, and that call the user's


def between(f: Callable[..., Any]) -> Callable[..., Any]:
    """Mark a function that C calls; it sets `LOCAL.asking` while the user's is at work."""
    BETWEEN.add(f.__code__)
    return f


class Hearing:
    """A handler of interrupts that does as the one before it, and notes what this raises where C would drop it."""

    def __init__(self, before: Callable[[int, FrameType | None], Any]) -> None:
        self.before = before

    def __call__(self, number: int, frame: FrameType | None) -> None:
        """Handle the signal."""
        try:
            self.before(number, frame)
        except KeyboardInterrupt as error:
            if not _is_between(frame):
                raise
            note(Fault("an interrupt", 0.0, np.zeros(0), np.zeros(0), "heard", error))


def _is_between(frame: FrameType | None) -> bool:
    """Whether C waits for the code at work, and the user's function is not at work, which has its own way out."""
    while frame is not None and frame.f_code not in BETWEEN:
        frame = frame.f_back
    return frame is not None and not LOCAL.asking


class Open(threading.local):
    """Of a thread: how many runs are under way, and what handles its interrupts."""

    runs = 0
    handler: Hearing | None = None


OPEN = Open()


def expect() -> None:
    """A function that C calls has been made: from now on runs hear interrupts there, the one under way as well."""
    global EXPECTED
    EXPECTED = True
    if OPEN.runs and OPEN.handler is None:
        _begin()


def _begin() -> None:
    """Hear interrupts wherever they come; only the main thread is told of them."""
    if threading.current_thread() is not threading.main_thread():
        return
    before = signal.getsignal(signal.SIGINT)
    if callable(before):
        OPEN.handler = Hearing(before)
        signal.signal(signal.SIGINT, OPEN.handler)


def _end() -> None:
    """Hand over to the handler before, unless somebody else has taken over."""
    own, OPEN.handler = OPEN.handler, None
    if own is not None and signal.getsignal(signal.SIGINT) is own:
        signal.signal(signal.SIGINT, own.before)


def hearing(run: Callable[P, T]) -> Callable[P, T]:
    """A function that makes a run, in which interrupts are heard wherever they come."""

    @wraps(run)
    def heard(*given: P.args, **named: P.kwargs) -> T:
        before = set_aside()
        OPEN.runs += 1
        try:
            if EXPECTED and OPEN.handler is None:
                _begin()
            made = run(*given, **named)
            if interrupted():  # by what was called beside the motion
                cause()
            return made
        finally:
            take_up(before if OPEN.runs > 1 else NOTHING)
            OPEN.runs -= 1
            if OPEN.runs == 0 and OPEN.handler is not None:
                _end()

    return heard
