"""Tables in Markdown, and errors read off between levels."""

from __future__ import annotations

import math

import numpy as np

from lcpstep.accuracy.work_precision import Study


def table(head: list[str], rows: list[list[str]]) -> str:
    """Rows under a head."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def error_at(study: Study, method: str, seconds: float) -> float | None:
    """Error reached within a CPU time, between levels only; that of the finest level where time is left."""
    levels = [x for x in study.curve(method, "sup_position", trusted=False) if x.errors["sup_position"] > 0.0]
    levels.sort(key=lambda x: x.seconds)
    if not levels or levels[0].seconds > seconds:
        return None
    x = np.log([level.seconds for level in levels])
    y = np.log([level.errors["sup_position"] for level in levels])
    return math.exp(float(np.interp(math.log(seconds), x, y)))
