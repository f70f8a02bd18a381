"""Why a method fails a check, where that has been looked into; shown beside the failures, and only there."""

from __future__ import annotations

from lcpstep.hard.methods import LOCATED, MOREAU

# (method, scene, part of what is checked) -> why
REASONS: dict[tuple[str, str, str], str] = {
    (LOCATED, "bouncing-ball", "steps"): "rounding of 5e5 steps",
    (LOCATED, "slider-crank", "energy"): "order two: the free mechanism gains as much at this step",
    (LOCATED, "pendulum-stop", "tension"): "order two: the phase that 100 steps a period lose, as tension",
    (LOCATED, "double-pendulum", "states"): "order two, times the growth of errors in a chaotic motion",
    (
        LOCATED,
        "cam-follower",
        "states",
    ): "order two, times the growth of errors from impact to impact",
    (MOREAU, "bouncing-ball", "rest"): "at rest to rounding, not exactly",
    (MOREAU, "superball", "states"): "each impact is late by up to a step, and the phase drifts",
    (
        MOREAU,
        "mass-on-shaken-belt",
        "states",
    ): "the sliding turns about at the ends of steps only",
    (MOREAU, "elastic-ball", ""): "each impact is late by up to a step, and the phase drifts",
    (
        MOREAU,
        "ball-on-table",
        "multipliers",
    ): "impacts move by whole steps: the derivatives are those of the grid",
    (MOREAU, "jumping-table", "struck"): "an impact noticed a step early or late meets the other velocity",
    (MOREAU, "chaotic-oscillator", "statistics"): "impacts rounded to the grid bias the means",
    (MOREAU, "cam-follower", "statistics"): "impacts rounded to the grid bias the means",
    (MOREAU, "cam-follower", "states"): "order one, times the growth of errors from impact to impact",
    (
        MOREAU,
        "grazing",
        "",
    ): "a dip within a step is not seen: only the gap predicted at its middle is looked at",
    (
        MOREAU,
        "bowl",
        "states",
    ): "it lands up to a step late, and slides on with that delay",
    (MOREAU, "elastic-gas", ""): "impacts that share a step are solved as one simultaneous impact",
    (
        MOREAU,
        "heavy-on-light",
        "",
    ): "the answer of the complementarity problem is judged unsolved at this ratio",
}


def reason(method: str, scene: str, what: str) -> str:
    """Why this method fails this check; empty where that is not known."""
    for (by, at, part), why in REASONS.items():
        if (by, at) == (method, scene) and part in what:
            return why
    return ""
