"""The lowest place of a function beside three equidistant samples, for whoever can evaluate it: by parabolas.

The caller keeps the function, and asks where to look:

    turn.begin(x, h, f_0, f_1, f_2)         of the function at x - h, x, x + h
    while turn.seek():
        turn.take(f)                        of the function at turn.x
    turn.lowest, turn.least                 where it was seen lowest, and what it is there

Parabolas through samples ever nearer to each other follow a smooth turn to eight digits of its depth. Where the
samples show none the search ends. It never looks beyond the two outer samples: what is there is not the caller's.
"""

from __future__ import annotations

import cython

from lcpstep.pointers import abs, max, min

ROUNDS = 4  # parabolas
NEARER = 0.25  # of the distance of samples, each time


class Turn:
    """Three samples, and the place to look at.

    x                the place to look at;  lowest, least  the best one so far, and the function there
    low, high        the outer samples that it began with
    at, h            the middle sample, and how far the others are;  f_0, f_1, f_2  of the function
    rounds, sample   parabolas left, and which sample of the next one is looked at
    """

    def __init__(self) -> None:
        self.begin(0.0, 0.0, 0.0, 0.0, 0.0)

    def begin(self, x: float, h: float, f_0: float, f_1: float, f_2: float) -> None:
        """Seek beside x, with the function known there and at x - h and x + h."""
        self.at = self.lowest = self.x = x
        self.low, self.high = x - h, x + h
        self.h, self.f_0, self.f_1, self.f_2, self.least = h, f_0, f_1, f_2, f_1
        self.rounds, self.sample = ROUNDS, 0

    def seek(self) -> bool:
        """Move x to the next place to look at; False where there is no more to be seen."""
        if self.sample == 0:
            bend = self.f_0 - 2.0 * self.f_1 + self.f_2
            if self.rounds == 0 or not bend > 0.0:
                return False
            move = 0.5 * self.h * (self.f_0 - self.f_2) / bend
            if abs(move) > self.h:
                return False
            self.h *= NEARER
            self.at = min(max(self.at + move, self.low + self.h), self.high - self.h)
            self.rounds -= 1
            self.x = self.at
        else:
            self.x = max(self.at - self.h, self.low) if self.sample == 1 else min(self.at + self.h, self.high)
        return True

    def take(self, f: float) -> None:
        """The function at x."""
        if self.sample == 0:
            self.f_1 = f
        elif self.sample == 1:
            self.f_0 = f
        else:
            self.f_2 = f
        if f < self.least:
            self.lowest, self.least = self.x, f
        self.sample = (self.sample + 1) % 3
