"""What steps miss, piece by piece, and what that adds up to, as kernels: the sums of `drift` and `missed`."""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.arrays import doubles, small_numbers
from lcpstep.audit.limits import JUMP, RELEASED
from lcpstep.pointers import Doubles, Flags, abs, inf, max, min


@cython.ccall
def changes(t: Any, v: Any, jumps: Any, cuts: Any, first: Any, second: Any, size: Any) -> None:
    """How accelerations change from piece to piece, and how that changes: the largest of a piece and its neighbours.

    Parameters
    ----------
    t : (m + 1,);  v : (m + 1, n_q)
    jumps : (m + 1,) uint8   states where the velocity may have jumped, JUMP, or motion is free again, RELEASED
    cuts : (k,)   corners: pieces that one touches are not compared with others
    first, second : (m, n_q), zeros   found here;  size : (n_q,), zeros   the integral of |a|
    """
    n, n_q, n_cuts = len(first), v.shape[1], len(cuts)
    times, speeds, corner, jump = doubles(t), doubles(v), doubles(cuts), small_numbers(jumps)
    one, two, whole = doubles(first), doubles(second), doubles(size)
    with cython.nogil:
        for j in range(n_q):
            i, a, turn, smooth, known = 0, 0.0, 0.0, False, False
            for k in range(n):
                last, turned, was, had = a, turn, smooth, known
                h = times[k + 1] - times[k]
                a = (speeds[(k + 1) * n_q + j] - speeds[k * n_q + j]) / h if h > 0.0 else inf
                while i < n_cuts and corner[i] < times[k]:
                    i += 1
                cut = i < n_cuts and corner[i] <= times[k + 1]
                smooth = a - a == 0.0 and jump[k + 1] != JUMP and not cut
                known = smooth and was and jump[k] == 0
                turn = a - last if known else 0.0
                if smooth:
                    whole[j] += h * abs(a)
                one[k * n_q + j] = abs(turn)
                if k > 0:
                    one[(k - 1) * n_q + j] = max(one[(k - 1) * n_q + j], abs(turn))
                    two[(k - 1) * n_q + j] = abs(turn - turned) if known and had else 0.0
        beside(one, n, n_q, 1.0, jump)
        beside(two, n, n_q, 1.0, jump)


def beside(x: Doubles, n: int, n_q: int, share: float, jump: Flags) -> None:
    """The largest of each piece and its neighbours of the same motion, (n, n_q), times a share, in its place."""
    for j in range(n_q):
        before = 0.0
        for k in range(n):
            own = x[k * n_q + j]
            after = x[(k + 1) * n_q + j] if k + 1 < n and jump[k + 1] != RELEASED else 0.0
            before = before if jump[k] != RELEASED else 0.0
            x[k * n_q + j] = share * max(own, max(before, after))
            before = own


@cython.ccall
def add_up(t: Any, jumps: Any, place: Any, speed: Any, rate: Any, gone: Any) -> None:
    """How far the positions may be off in each piece, (m, n_q), into `gone`; see `drift`.

    t, jumps : as of `changes`;  place, speed : (m, n_q)   what each piece errs by in position and velocity
    rate : (n_q,)   what holds the coordinates, 0 where nothing does
    """
    n, n_q = len(place), place.shape[1]
    times, jump = doubles(t), small_numbers(jumps)
    one, two, held, out = doubles(place), doubles(speed), doubles(rate), doubles(gone)
    with cython.nogil:
        for j in range(n_q):
            off = fast = moved = 0.0
            for k in range(n):
                if jump[k] != 0:
                    off = fast = moved = 0.0
                h = times[k + 1] - times[k]
                off += one[k * n_q + j]
                fast += two[k * n_q + j]
                moved += h * fast
                out[k * n_q + j] = off + (min(moved, fast / held[j]) if held[j] > 0.0 else moved)


@cython.ccall
def missed(t: Any, q: Any, v: Any, jumps: Any, out: Any) -> None:
    """How far the parabolas between states may be from the motion, (m, n_q): half of what their velocities miss."""
    n, n_q = len(out), q.shape[1]
    times, places, speeds, jump = doubles(t), doubles(q), doubles(v), small_numbers(jumps)
    found = doubles(out)
    with cython.nogil:
        for k in range(n):
            h = times[k + 1] - times[k]
            for j in range(n_q):
                i, x = k * n_q + j, 0.0
                if h > 0.0 and jump[k + 1] != JUMP:
                    end = 2.0 * (places[i + n_q] - places[i]) / h - speeds[i]
                    x = h * abs(speeds[i + n_q] - end)
                found[i] = x if x - x == 0.0 else 0.0
        beside(found, n, n_q, 0.5, jump)
