"""A module as users write them: functions that numba compiles, called by the module's name."""

import numba

SCALE = 1.0


@numba.njit
def item(x, k):
    return x[k]


@numba.njit
def down(x, k, n):
    return down(x, k, n - 1) if n > 0 else SCALE * item(x, k)
