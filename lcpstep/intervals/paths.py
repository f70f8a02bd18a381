"""The ways through a function that is evaluated on intervals: where it branches, both ways are taken.

A function is called for many windows at once. Where a condition holds in some windows and fails in others, or holds
in a part of one, the call goes one way, and another call, of the windows concerned alone, is noted for the other.
Results of a window that several calls have reached are united; such a window holds a branch, and the function need
not be smooth in it.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.bool_]
MOST = 32  # ways through a function
LONGEST = 10_000  # decisions on one way: a loop whose end numbers tell need not end for intervals
UNDER_WAY = threading.local()  # the evaluation of each thread


class NotEnclosed(Exception):
    """Why a function cannot be evaluated on intervals."""


class NoValue(NotEnclosed):
    """A function has no value on the way that it has taken, for any of the numbers between the bounds."""


IMPOSSIBLE = NoValue, IndexError, ValueError, ZeroDivisionError


class Paths:
    """One evaluation of a function for n windows.

    at       the windows that the call at hand is about, (k,)
    active   which of them follow the way that it has taken, (k,)
    branched : (n,)   windows in which the function need not be smooth

    Parameters
    ----------
    n : int
    """

    def __init__(self, n: int) -> None:
        self.branched = np.zeros(n, dtype=bool)
        self.visits = np.zeros(n, dtype=np.intp)
        self.at, self.active = np.arange(n), np.ones(n, dtype=bool)
        self.script: list[Hashable] = []
        self.made = 0
        self.pending: list[tuple[list[Hashable], NDArray[np.intp]]] = [([], self.at)]

    def follow(self, call: Callable[[NDArray[np.intp]], Any], unite: Callable[..., None]) -> None:
        """Call(windows) for every way; unite(result, windows, active) takes what it gives for the active ones.

        A way on which the function has no value is none that its numbers take, if there is another one.
        """
        outer, UNDER_WAY.paths = getattr(UNDER_WAY, "paths", None), self
        ways, failure = 0, None
        try:
            while self.pending:
                ways += 1
                if ways > MOST:
                    raise NotEnclosed(f"there are more than {MOST} ways through it")
                self.script, self.at = self.pending.pop()
                self.active, self.made = np.ones(len(self.at), dtype=bool), 0
                try:
                    result = call(self.at)
                except IMPOSSIBLE as error:
                    failure = error
                    self.branched[self.at] = True
                    continue
                self.visits[self.at[self.active]] += 1
                unite(result, self.at, self.active)
        finally:
            UNDER_WAY.paths = outer
        if failure is not None and np.any(self.visits == 0):
            raise failure
        self.branched |= self.visits > 1

    def choose(self, options: list[tuple[Hashable, Mask]]) -> Hashable:
        """Which of several ways the call takes; each with the windows of `at` in which it may be taken."""
        if self.made < len(self.script):
            key = self.script[self.made]
        else:
            possible = [(k, m) for k, m in ((k, mask & self.active) for k, mask in options) if np.any(m)]
            if not possible:
                possible = [(options[0][0], self.active)]
            key = possible[0][0]
            for other, mask in possible[1:]:
                self.pending.append(([*self.script, other], self.at[mask]))
            if len(self.pending) > MOST:
                raise NotEnclosed(f"there are more than {MOST} ways through it")
            self.script.append(key)
        self.made += 1
        if self.made > LONGEST:
            raise NotEnclosed(f"it decides more than {LONGEST} times what to do")
        for k, mask in options:
            if k == key:
                self.active = self.active & mask
        return key

    def need(self, holds: Any, what: str) -> None:
        """Windows in which it does not hold do not follow this way; NoValue where none is left."""
        self.active = self.active & self.spread(holds)
        if not np.any(self.active):
            raise NoValue(what)

    def mark(self, where: Any) -> None:
        """The function need not be smooth in these of the windows at hand."""
        self.branched[self.at[self.spread(where) & self.active]] = True

    def spread(self, mask: Any) -> Mask:
        """A truth value for every window at hand."""
        mask = np.asarray(mask, dtype=bool)
        return mask if mask.shape == self.at.shape else np.broadcast_to(mask, self.at.shape)


def current() -> Paths:
    """The evaluation under way; NotEnclosed where there is none."""
    paths: Paths | None = getattr(UNDER_WAY, "paths", None)
    if paths is None:
        raise NotEnclosed("a comparison of intervals has no one answer")
    return paths
