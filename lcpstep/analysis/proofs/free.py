"""Orbits without impacts: the steady motion of the linear system, and that it touches nothing.

With E = exp(2 pi A) in parts, x = E_xx x + E_xf (1, cos, sin), which has one solution unless a multiplier is one.
"""

from __future__ import annotations

import math

from flint import arb, arb_mat

from lcpstep.analysis.orbits import PeriodicOrbit
from lcpstep.analysis.proofs.case import given_state, moduli
from lcpstep.analysis.proofs.errors import NotProved
from lcpstep.analysis.proofs.flights import Flight
from lcpstep.analysis.proofs.formulas import Formulas
from lcpstep.analysis.proofs.jets import Jet
from lcpstep.analysis.proofs.report import Enclosure, Proof, Unique, verdict
from lcpstep.analysis.proofs.shooting import forcing


def prove_free(orbit: PeriodicOrbit, f: Formulas, bits: int) -> Proof:
    """The proof of an orbit O(1, 0)."""
    if orbit.periods != 1:
        raise NotProved(f"{orbit.name}: a motion without impacts repeats after 1 of these periods already")
    n2, phase, slowness = 2 * f.n, 2 * arb.pi() * arb(orbit.phase), 1 / f.omega
    A = f.A0 + slowness * f.A1 + slowness**2 * f.A2
    E = (2 * arb.pi() * A).exp()
    D = arb_mat([[E[i, j] for j in range(n2)] for i in range(n2)])
    harmonics = [y.c[0] for y in forcing(f, Jet([phase]))]
    pushed = arb_mat([[E[i, n2 + j] for j in range(3)] for i in range(n2)]) * arb_mat(3, 1, harmonics)
    one = arb_mat(n2, n2, [int(i == j) for i in range(n2) for j in range(n2)])
    try:
        x = (one - D).solve(pushed).entries()
    except ZeroDivisionError:
        raise NotProved(f"{orbit.name}: resonance: the motion without impacts is not isolated") from None
    start = arb_mat(n2 + 3, 1, [*x, *harmonics])
    Flight(f, A, phase, start, phase + 2 * arb.pi(), -1, -1).show_clear()
    largest = moduli(D)
    state = given_state(f, Jet([slowness]), phase, [Jet([y]) for y in x])
    return Proof(
        name="O(1, 0)", periods=1, period=Enclosure.of(2 * arb.pi() / f.omega), x=(state,), impacts=(),
        multipliers=largest, stability=verdict(largest), unique=Unique(math.inf, math.inf, math.inf), bits=bits,
    )  # fmt: skip
