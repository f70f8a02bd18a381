"""Impacts of two logs matched together, of all contacts that leave no question, as kernels; see `pairs`."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.errorbar.layout import IMPULSE, JUMP, LATE_BY, OF_PAIR, START, STOP
from lcpstep.pointers import Doubles, Indices, abs, inf, max, min
from lcpstep.trajectory import Kind

IMPACT, ACCUMULATION = int(Kind.IMPACT), int(Kind.ACCUMULATION)
ALIKE = 0.5  # of the larger jump, by which those of partners may differ
NEAR = 0.5  # of the time to the next impact of the contact


class Log:
    """The columns of an impact log; `end`: impacts beyond it do not count [s]."""

    def __init__(self, log: Any, end: float) -> None:
        log = np.asarray(log)  # record arrays look their fields up slowly
        self.times, self.impulses = np.array(log["time"]), np.array(log["impulse"])
        self.jumps = np.abs(log["after"] - log["before"])
        self.contacts, self.kinds = log["contact"].astype(np.intp), log["kind"].astype(np.intp)
        self.n, self.end = len(log), end
        self.time, self.impulse, self.jump = doubles(self.times), doubles(self.impulses), doubles(self.jumps)
        self.contact, self.kind = indices(self.contacts), indices(self.kinds)

    def strikes(self, k: int) -> bool:
        """Whether line k is an impact."""
        return self.kind[k] == IMPACT and self.time[k] <= self.end


@cython.ccall
def summary(a: Log, b: Log) -> tuple[int, float, bool]:
    """One more than the largest number of a contact, the largest jump of an impact, whether chattering ends."""
    most, other = most_contacts(a), most_contacts(b)
    largest = max(largest_jump(a), largest_jump(b))
    return (most if most > other else other), largest, has_chattering(a) or has_chattering(b)


def most_contacts(a: Log) -> int:
    """One more than the largest number of a contact."""
    most = 0
    for k in range(a.n):
        if a.contact[k] >= most:
            most = a.contact[k] + 1
    return most


def largest_jump(a: Log) -> float:
    """Of all impacts."""
    largest = 0.0
    for k in range(a.n):
        if a.strikes(k):
            largest = max(largest, a.jump[k])
    return largest


def has_chattering(a: Log) -> bool:
    """Whether chattering ends at any contact."""
    found = False
    for k in range(a.n):
        found = found or a.kind[k] == ACCUMULATION
    return found


def paired(a: Log, b: Log, most: int) -> tuple[Any, Any, Any]:
    """Rows (k, 2) of impacts in the same place of the order of their contact, those of each contact together.

    Of contacts that strike as often in both logs, and where no chattering ends; all (most,) are marked 1 if they
    are such, 2 if they do not strike, else 0. And the differences of times (k,).
    """
    n = a.n if a.n < b.n else b.n
    found, good, work = np.empty((n, 2), np.intp), np.empty(most, np.intp), np.empty(2 * most, np.intp)
    late = np.empty(n)
    rows, marks, room, apart = indices(found), indices(good), indices(work), doubles(late)
    n = find_pairs(a, b, most, rows, marks, room, apart)
    return found[:n], good, late[:n]


@cython.cfunc
def find_pairs(a: Log, b: Log, most: int, rows: Indices, good: Indices, work: Indices, late: Doubles) -> int:
    """Kernel of `paired`."""
    with cython.nogil:
        for c in range(most):
            good[c], work[c], work[most + c] = 1, 0, 0
        for k in range(a.n):
            c = a.contact[k]
            if a.kind[k] == ACCUMULATION:
                good[c] = 0
            if a.strikes(k):
                work[c] += 1
        for k in range(b.n):
            c = b.contact[k]
            if b.kind[k] == ACCUMULATION:
                good[c] = 0
            if b.strikes(k):
                work[most + c] += 1
        n = 0
        for c in range(most):  # places where the pairs of each contact begin
            strikes = work[c]
            if strikes != work[most + c]:
                good[c] = 0
            elif strikes == 0 and good[c] != 0:
                good[c] = 2  # nothing to do
            work[c] = work[most + c] = n
            if good[c] == 1:
                n += strikes
        for k in range(a.n):
            c = a.contact[k]
            if good[c] == 1 and a.strikes(k):
                rows[2 * work[c]] = k
                work[c] += 1
        for k in range(b.n):
            c = b.contact[k]
            if good[c] == 1 and b.strikes(k):
                rows[2 * work[most + c] + 1] = k
                work[most + c] += 1
        for k in range(n):
            late[k] = abs(a.time[rows[2 * k]] - b.time[rows[2 * k + 1]])
    return n


def without_doubt(
    a: Log, b: Log, rows: Any, good: Any, late: float, weak: float, resolution: float
) -> tuple[Any, Any, Any]:
    """Numbers (k, OF_PAIR) and rows in the first log of those pairs, and the contacts that are left to strike.

    late : pairs that are later than this are in doubt, and with each its contact
    """
    n = len(rows)
    found, own = np.empty((n, OF_PAIR)), np.empty(n, np.intp)
    pairs, marks, numbers, first = indices(rows), indices(good), doubles(found), indices(own)
    mark(a, b, n, pairs, marks, late, weak, resolution)
    n = write_pairs(a, b, n, pairs, marks, numbers, first)
    return found[:n], own[:n], np.flatnonzero(good == 0)


@cython.cfunc
def mark(
    a: Log, b: Log, n: int, rows: Indices, good: Indices, late: float, weak: float, resolution: float
) -> None:
    """Contacts with a pair that may be none are not good."""
    with cython.nogil:
        for k in range(n):
            if not is_pair(a, b, n, rows, k, late, weak, resolution):
                good[a.contact[rows[2 * k]]] = 0


def is_pair(
    a: Log, b: Log, n: int, rows: Indices, k: int, late: float, weak: float, resolution: float
) -> bool:
    """Whether the impacts of a pair are near in time, alike, and far from the contact's others."""
    i, j, before, following = rows[2 * k], rows[2 * k + 1], inf, inf
    if k > 0 and a.contact[rows[2 * k - 2]] == a.contact[i]:
        before = min(a.time[i] - a.time[rows[2 * k - 2]], b.time[j] - b.time[rows[2 * k - 1]])
    if k + 1 < n and a.contact[rows[2 * k + 2]] == a.contact[i]:
        following = min(a.time[rows[2 * k + 2]] - a.time[i], b.time[rows[2 * k + 3]] - b.time[j])
    apart, jump = abs(a.time[i] - b.time[j]), max(a.jump[i], b.jump[j])
    if abs(a.jump[i] - b.jump[j]) > ALIKE * jump + weak or apart > NEAR * min(before, following) + resolution:
        return False
    return before > resolution and apart <= max(late, resolution)


@cython.cfunc
def write_pairs(a: Log, b: Log, n: int, rows: Indices, good: Indices, numbers: Doubles, own: Indices) -> int:
    """The numbers of the pairs of good contacts."""
    with cython.nogil:
        count = 0
        for k in range(n):
            i, j = rows[2 * k], rows[2 * k + 1]
            if good[a.contact[i]] == 0:
                continue
            p = count * OF_PAIR
            numbers[p + START], numbers[p + STOP] = min(a.time[i], b.time[j]), max(a.time[i], b.time[j])
            numbers[p + LATE_BY] = abs(a.time[i] - b.time[j])
            numbers[p + IMPULSE] = abs(a.impulse[i] - b.impulse[j])
            numbers[p + JUMP], own[count] = max(a.jump[i], b.jump[j]), i
            count += 1
    return count
