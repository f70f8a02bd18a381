"""What motions have in common and what sets them apart: orbits, attractors, diagrams, basins, proofs."""

from __future__ import annotations

from typing import Any


def __getattr__(name: str) -> Any:
    """`prove` and `prove_speed`, loaded where they are asked for."""
    if name not in ("prove", "prove_speed"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from lcpstep.analysis import proofs

    return getattr(proofs, name)
