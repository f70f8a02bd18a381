"""Proofs of periodic orbits in ball arithmetic: `prove` an orbit, `prove_speed` where it is at a bifurcation.

    from lcpstep.analysis import prove

A linear scene is turned into formulas (`formulas`, `obstacles`, `written`), its orbit into equations from impact to
impact (`shooting`) whose zero is proved (`newton`, with derivatives by `jets`); then its flights are shown to touch
nothing (`flights`, `case`). What cannot be proved raises `NotProved`, with the reason.
"""

from __future__ import annotations

from lcpstep.errors import MissingSolver

try:
    import flint  # noqa: F401
except ImportError as error:
    raise MissingSolver("proofs need python-flint: pip install 'lcpstep[proofs]'") from error

from lcpstep.analysis.proofs.errors import NotProved
from lcpstep.analysis.proofs.orbit import prove
from lcpstep.analysis.proofs.report import Enclosure, Proof, ProvedImpact, ProvedSpeed
from lcpstep.analysis.proofs.speeds import prove_speed

__all__ = ["Enclosure", "NotProved", "Proof", "ProvedImpact", "ProvedSpeed", "prove", "prove_speed"]
