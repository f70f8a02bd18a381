"""States between those that are kept of a run, as its steps move from each of them to the next.

Kept are times t (n,), increasing, and states q, v (n, n_q); each of the times asked for goes on from the state of its
row. All arrays of numbers are contiguous.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices, small_numbers


@cython.ccall
def last_rows(t: Any, times: Any, least: int, most: int) -> Any:
    """Rows of the last kept state at or before each time (m,), none below `least` and none above `most`.

    From the row of the time before on, in longer and longer strides.
    """
    count, n, found = len(times), len(t), np.empty(len(times), dtype=np.intp)
    kept, asked, out = doubles(t), doubles(times), indices(found)
    with cython.nogil:
        low = -1
        for j in range(count):
            x, high, stride = asked[j], low + 1, 1
            if low >= 0 and not kept[low] <= x:
                low, high = -1, low
            while high < n and kept[high] <= x:
                low, high, stride = high, high + stride, 2 * stride
            if high > n:
                high = n
            while high - low > 1:
                middle = (low + high) // 2
                if kept[middle] <= x:
                    low = middle
                else:
                    high = middle
            row = low
            if row > most:
                row = most
            if row < least:
                row = least
            out[j] = row
    return found


@cython.ccall
def on_lines(t: Any, q: Any, v: Any, times: Any, rows: Any) -> tuple[Any, Any]:
    """Positions and velocities linear within a step: the theta-method."""
    count, n = len(times), q.shape[1]
    found_q, found_v = np.empty((count, n)), np.empty((count, n))
    kept, x, x_t, asked, row = doubles(t), doubles(q), doubles(v), doubles(times), indices(rows)
    out, out_t = doubles(found_q), doubles(found_v)
    with cython.nogil:
        for j in range(count):
            k = row[j]
            share = (asked[j] - kept[k]) / (kept[k + 1] - kept[k])
            for i in range(n):
                a, b = k * n + i, (k + 1) * n + i
                out[j * n + i] = (1.0 - share) * x[a] + share * x[b]
                out_t[j * n + i] = (1.0 - share) * x_t[a] + share * x_t[b]
    return found_q, found_v


@cython.ccall
def on_parabolas(t: Any, q: Any, v: Any, jumps: Any, times: Any, rows: Any) -> tuple[Any, Any]:
    """The parabola through both positions that leaves with the first velocity; the last state at its time.

    Its velocity is bent to meet that of the next state, but where that may have jumped there: jumps (n,) of uint8;
    nowhere where there are none (0,). As within a step: v + s a + (s / h)^2 (v_next - v - h a), where the parabola
    alone would leave a gap of order two.
    """
    last, count, n, bent = len(t) - 1, len(times), q.shape[1], len(jumps) > 0
    found_q, found_v = np.empty((count, n)), np.empty((count, n))
    kept, x, x_t, jumped = doubles(t), doubles(q), doubles(v), small_numbers(jumps)
    asked, row, out, out_t = doubles(times), indices(rows), doubles(found_q), doubles(found_v)
    with cython.nogil:
        for j in range(count):
            k = row[j]
            at_end, tau, length = asked[j] == kept[last], asked[j] - kept[k], kept[k + 1] - kept[k]
            share = tau / length if bent and not at_end and not jumped[k + 1] else 0.0
            for i in range(n):
                q0, q1, v0 = x[k * n + i], x[(k + 1) * n + i], x_t[k * n + i]
                half = (q1 - q0 - length * v0) / (length * length)
                out[j * n + i] = x[last * n + i] if at_end else q0 + tau * (v0 + tau * half)
                rate = x_t[last * n + i] if at_end else v0 + 2.0 * tau * half
                if share != 0.0:
                    arrives = 2.0 * (q1 - q0) / length - v0  # the parabola's velocity at the end of the step
                    rate += share * share * (x_t[(k + 1) * n + i] - arrives)
                out_t[j * n + i] = rate
    return found_q, found_v


@cython.ccall
def accelerated(t: Any, q: Any, v: Any, a: Any, times: Any, rows: Any) -> tuple[Any, Any]:
    """Under the acceleration a (n, 1, n_q) kept with each state; none is known beyond the last one."""
    last, count, n = len(t) - 1, len(times), q.shape[1]
    found_q, found_v = np.empty((count, n)), np.empty((count, n))
    kept, x, x_t, own = doubles(t), doubles(q), doubles(v), doubles(a)
    asked, row, out, out_t = doubles(times), indices(rows), doubles(found_q), doubles(found_v)
    with cython.nogil:
        for j in range(count):
            k = row[j] * n
            tau, known = asked[j] - kept[row[j]], asked[j] < kept[last]
            for i in range(n):
                bend = own[k + i] if known else 0.0
                out[j * n + i] = x[k + i] + tau * (x_t[k + i] + 0.5 * tau * bend)
                out_t[j * n + i] = x_t[k + i] + tau * bend
    return found_q, found_v


@cython.ccall
def by_dense_output(t: Any, q: Any, v: Any, length: Any, F: Any, times: Any, rows: Any) -> tuple[Any, Any]:
    """By the dense output F (n, terms, 2 n_q) of the step after each state, of that length (n,); `RungeKutta.at`."""
    terms, count, n = F.shape[1], len(times), q.shape[1]
    found_q, found_v = np.empty((count, n)), np.empty((count, n))
    kept, x, x_t, long, own = doubles(t), doubles(q), doubles(v), doubles(length), doubles(F)
    asked, row, out, out_t = doubles(times), indices(rows), doubles(found_q), doubles(found_v)
    with cython.nogil:
        for j in range(count):
            k = row[j]
            tau = asked[j] - kept[k]
            share = tau / long[k] if long[k] > 0.0 else tau
            for i in range(2 * n):
                moved = 0.0
                for term in range(terms):
                    factor = share if term % 2 == 0 else 1.0 - share
                    moved = (moved + own[(k * terms + terms - 1 - term) * 2 * n + i]) * factor
                if tau == 0.0:
                    moved = 0.0
                if i < n:
                    out[j * n + i] = x[k * n + i] + moved
                else:
                    out_t[j * n + i - n] = x_t[k * n + i - n] + moved
    return found_q, found_v
