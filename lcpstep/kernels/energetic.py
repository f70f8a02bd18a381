"""The impact that is integrated over its normal impulse, through slip, reversal and stick; several in turn.

    du_N = (W_NN + W_NT f) dp,   du_T = (W_TN + W_TT f) dp,   dp_T = f dp,   dp > 0

    f = -mu sign(u_T) while it slides;  -W_TN / W_TT while it sticks, as long as that is no more than mu

Compression ends at u_N = 0, the impact where the normal has given back e^2 of the work that it took by then
(Stronge). Both parts are straight lines in p between the ends of sliding, of which there is one: all is in closed
form. Neither the normal nor friction does positive work on the whole, so no energy is created.

Contacts that strike together do so in turn, the one that approaches fastest first, until what is left is small: that
is taken by one plastic impact of all. Sources: E. J. Routh, Dynamics of a System of Rigid Bodies (1905), volume 1,
chapter 5; W. J. Stronge, Impact Mechanics (Cambridge 2000), chapters 3 and 5.
"""

from __future__ import annotations

from math import sqrt

import cython

from lcpstep.kernels.coulomb import ContactProblem, solve_contacts
from lcpstep.kernels.vectors import clear, copy
from lcpstep.pointers import Doubles, abs, inf, max, min

PHASES = 4  # of a single impact: sliding, then rest or sliding back, the end of compression between any two
LOCKED = 1e-13  # of W_NN: a contact that sticks and has less mobility is wedged; of e: a smaller one is none
TURNS = 100  # impacts of each contact at one instant; in a narrow wedge they go on for ever
LEFT = 1e-6  # of the fastest approach: slower ones, and what is left after so many turns, end in a plastic impact
ROUNDING = 1e-15  # of the fastest approach
LIKE = 1e-9  # relative: contacts that approach equally fast strike in the order of their numbers; rest


def strike_in_turn(c: ContactProblem, restitution: Doubles, n_a: int, n_f: int, jams: int) -> bool:
    """Impulses of n_a contacts, n_f of them with tangents, into c.impulse, from their velocities in c.rate.

    restitution : (n_c,), of energy; none below c.slow, nor of what forces have made of an approach
    jams : the unknown that strikes first, though it does not approach: impact without collision; or -1
    """
    m = n_a + n_f
    u, fastest = c.z, 0.0
    copy(u, c.rate, m)
    clear(c.impulse, m)
    for a in range(n_a):
        fastest = max(fastest, -u[a])
    next_one = jams
    for _ in range(TURNS * n_a):
        if next_one < 0:
            next_one = fastest_of(u, n_a, LEFT * fastest)
        if next_one < 0:
            break
        e = 0.0
        if -u[next_one] >= c.slow[next_one]:
            e = restitution[c.ids[next_one]]
            if c.made[next_one] > 0.0:
                e *= max(0.0, 1.0 + c.made[next_one] / u[next_one])
        c.made[next_one] = 0.0  # by this impact
        if not strike_one(c, next_one, n_a, n_f, e, jams >= 0):
            return False
        if jams >= 0:
            jams = -1
            for a in range(n_a):
                fastest = max(fastest, -u[a])
        next_one = -1
    return settle(c, n_a, n_f, fastest)


def fastest_of(u: Doubles, n_a: int, slow: float) -> int:
    """The contact that approaches fastest, and faster than `slow`; or -1."""
    found, most = -1, slow
    for a in range(n_a):
        if -u[a] > most * (1.0 + LIKE):
            found, most = a, -u[a]
    return found


def strike_one(c: ContactProblem, a: int, n_a: int, n_f: int, e: float, jams: bool) -> bool:
    """The impact of unknown a alone, which may jam: its impulses and what they do to the velocities are added."""
    m, T, W, p = n_a + n_f, -1, c.mobility, c.b
    for f in range(n_f):
        if c.carrier[f] == a:
            T = n_a + f
    p[1] = 0.0
    if T < 0:
        if not W[a * m + a] > 0.0:
            return False
        p[0] = -(1.0 + e) * c.z[a] / W[a * m + a]
    elif not integrate(
        W[a * m + a], W[a * m + T], W[T * m + a], W[T * m + T], c.mu[c.ids[a]], e, c.z[a], c.z[T], jams, p
    ):
        return False
    c.impulse[a] += p[0]
    for b in range(m):
        c.z[b] += W[b * m + a] * p[0]
    if T >= 0:
        c.impulse[T] += p[1]
        for b in range(m):
            c.z[b] += W[b * m + T] * p[1]
    return True


def integrate(
    W_NN: float, W_NT: float, W_TN: float, W_TT: float, mu: float, e: float, u: float, slip: float, jams: bool,
    p: Doubles,
) -> bool:  # fmt: skip
    """Impulses p (2,) of one contact that approaches with u <= 0 and slides with `slip`; False where none end it.

    jams : its sliding ends whatever the normal does; then the mobility of the normal is not positive, up to rounding
    """
    taken, back, compressed, fall = 0.0, 0.0, False, -u
    p[0] = p[1] = 0.0
    for _ in range(PHASES):
        sticks = slip == 0.0 and abs(W_TN) <= mu * W_TT
        share = 0.0
        if not sticks:
            share = -mu if slip > 0.0 or (slip == 0.0 and W_TN > 0.0) else mu
        elif W_TT > 0.0:
            share = -W_TN / W_TT
        du, dslip = W_NN + W_NT * share, 0.0 if sticks else W_TN + W_TT * share
        length = -slip / dslip if slip * dslip < 0.0 else inf
        if jams and slip != 0.0 and not compressed:
            du = min(du, 0.0)
        if compressed:
            if du <= LOCKED * W_NN:
                return True
            step = 2.0 * back / (u + sqrt(u * u + 2.0 * du * back))
        else:
            step = -u / du if du > LOCKED * W_NN else inf
        ends = step <= length
        step = step if ends else length
        if step == inf:  # wedged: with normal and tangent in one direction both come to rest at once
            return -u <= LIKE * fall
        work = step * (u + 0.5 * du * step)
        p[0] += step
        p[1] += share * step
        u, slip = u + du * step, slip + dslip * step if ends else 0.0
        if ends and (compressed or e < LOCKED or taken <= work):
            return True
        if compressed:
            back -= work
        else:
            taken -= work
            if ends:
                u, compressed, back = 0.0, True, e * e * taken
    return compressed


def settle(c: ContactProblem, n_a: int, n_f: int, fastest: float) -> bool:
    """The plastic impact of what still approaches, beside the impulses found; `fastest` made the largest of these."""
    m, left = n_a + n_f, 0.0
    for a in range(n_a):
        left = max(left, -c.z[a])
    if left <= ROUNDING * fastest:
        return True
    for i in range(m):
        c.rate[i] = c.z[i] / left
    copy(c.sum, c.impulse, m)
    done = solve_contacts(c, n_a, n_f)
    for i in range(m):
        c.impulse[i] = c.sum[i] + c.impulse[i] * left
    return done
