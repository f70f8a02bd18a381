"""The double pendulum that strikes a wall, in arithmetic of many digits: Taylor series and Newton's method (mpmath).

`python -m tests.lagrangian.reference_double_pendulum` prints the numbers kept in `lagrangian.scenes.double_pendulum`.
"""

from __future__ import annotations

import mpmath as mp

WALL, RESTITUTION, GRAVITY = "0", "0.7", "9.81"
START = ("-1", "-1.2")
STEP = "0.015625"


def acceleration(y):
    a, b, da, db = y
    s, c, g = mp.sin(a - b), mp.cos(a - b), mp.mpf(GRAVITY)
    f1, f2 = -s * db**2 - 2 * g * mp.sin(a), s * da**2 - g * mp.sin(b)
    det = 2 - c * c
    return (f1 - c * f2) / det, (2 * f2 - c * f1) / det


def multiply(x, y, k):
    return mp.fsum(x[i] * y[k - i] for i in range(k + 1))


def series(y, order):
    """Taylor coefficients of a, b by recurrences for sine, cosine and the linear system."""
    g = mp.mpf(GRAVITY)
    a, b = [y[0], y[2]], [y[1], y[3]]
    d = []
    sd, cd, sa, ca, sb, cb = [], [], [], [], [], []
    c2, da2, db2 = [], [], []
    for k in range(order - 1):
        d.append(a[k] - b[k])
        for s, c, x in ((sd, cd, d), (sa, ca, a), (sb, cb, b)):
            if k == 0:
                s.append(mp.sin(x[0]))
                c.append(mp.cos(x[0]))
            else:
                s.append(mp.fsum(i * x[i] * c[k - i] for i in range(1, k + 1)) / k)
                c.append(-mp.fsum(i * x[i] * s[k - i] for i in range(1, k + 1)) / k)
        rate = [[(i + 1) * x[i + 1] for i in range(k + 1)] for x in (a, b)]
        da2.append(multiply(rate[0], rate[0], k))
        db2.append(multiply(rate[1], rate[1], k))
        c2.append(multiply(cd, cd, k))
        f1 = -multiply(sd, db2, k) - 2 * g * sa[k]
        f2 = multiply(sd, da2, k) - g * sb[k]
        # 2 A + c B = f1, c A + B = f2, for the coefficients A, B of the accelerations
        acc = [[(i + 2) * (i + 1) * x[i + 2] for i in range(k)] for x in (a, b)]
        f1 -= mp.fsum(cd[k - i] * acc[1][i] for i in range(k))
        f2 -= mp.fsum(cd[k - i] * acc[0][i] for i in range(k))
        det = 2 - cd[0] ** 2
        A, B = (f1 - cd[0] * f2) / det, (2 * f2 - cd[0] * f1) / det
        a.append(A / ((k + 2) * (k + 1)))
        b.append(B / ((k + 2) * (k + 1)))
    return a, b


def at(coefficients, tau):
    a, b = (c[::-1] for c in coefficients)
    (qa, va), (qb, vb) = mp.polyval(a, tau, derivative=True), mp.polyval(b, tau, derivative=True)
    return [qa, qb, va, vb]


def gap(y):
    return mp.mpf(WALL) - mp.sin(y[0]) - mp.sin(y[1])


def struck(y):
    a, b, da, db = y
    n1, n2, c = -mp.cos(a), -mp.cos(b), mp.cos(a - b)
    det = 2 - c * c
    w1, w2 = (n1 - c * n2) / det, (2 * n2 - c * n1) / det
    u = n1 * da + n2 * db
    p = -(1 + mp.mpf(RESTITUTION)) * u / (n1 * w1 + n2 * w2)
    return [a, b, da + p * w1, db + p * w2]


def reference(times, digits=40, order=30):
    """Times of the impacts, and the states (a, b, a', b') at the times asked for."""
    with mp.workdps(digits):
        t, y = mp.mpf(0), [mp.mpf(START[0]), mp.mpf(START[1]), mp.mpf(0), mp.mpf(0)]
        impacts, states = [], []
        for wanted in map(mp.mpf, times):
            while t < wanted:
                c = series(y, order)
                h = min(mp.mpf(STEP), wanted - t)
                end = at(c, h)
                if gap(end) < 0:
                    h = mp.findroot(
                        lambda x, c=c: gap(at(c, x)),
                        (0, h),
                        solver="anderson",
                        tol=mp.mpf(10) ** (4 - 2 * digits),
                    )
                    end = struck(at(c, h))
                    impacts.append(t + h)
                t, y = t + h, end
            states.append(list(y))
        return impacts, states


if __name__ == "__main__":
    hits, found = reference(["0.5", "1", "1.5", "2", "2.5", "3"])
    print([mp.nstr(x, 20) for x in hits])
    for row in found:
        print([mp.nstr(x, 20) for x in row])
