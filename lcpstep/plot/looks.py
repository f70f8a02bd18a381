"""How several things in one picture are told apart: by colour; in a copy in grey by dashes, marks, shades."""

from __future__ import annotations

from typing import Any

STYLES = ("-", "--", "-.", ":")
MARKS = "os^DvPX*"
LIGHTEST = 0.92  # of a scale of shades: what is lighter is lost on white


def line(k: int) -> dict[str, Any]:
    """Colour, dashes and width of the k-th of several curves; the first eight differ without their colours."""
    return {"color": f"C{k % 10}", "ls": STYLES[k % len(STYLES)], "lw": 1.0 + 0.7 * (k // len(STYLES) % 2)}


def mark(k: int) -> str:
    """Mark of the k-th of several sets of points."""
    return MARKS[k % len(MARKS)]


def points(k: int) -> dict[str, Any]:
    """Colour and marks of the k-th of several sets of points that no line joins."""
    return {"color": f"C{k % 10}", "ls": "none", "marker": mark(k), "ms": 3.0}


def shades(n: int) -> Any:
    """Colours (n, 3) of n areas, from dark to light, so that they differ without their hues."""
    import numpy as np
    from matplotlib import colormaps

    return colormaps["viridis"](np.linspace(0.0, LIGHTEST, n) if n > 1 else [0.5 * LIGHTEST])[:, :3]
