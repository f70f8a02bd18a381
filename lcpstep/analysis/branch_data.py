"""A branch of periodic orbits as a labelled dataset."""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.analysis.orbits import OrbitBranch
from lcpstep.dataset import labelled, provenance

TAKEN = {  # names in the dataset
    "point", "state", "special", "x", "stable", "name", "multiplier_real", "multiplier_imag", "multiplier_modulus",
    "special_kind", "special_p", "special_x", "special_after",
}  # fmt: skip


def branch_dataset(
    ways: list[OrbitBranch], parameter: str, p_range: tuple[float, float], scene: Any, method: Any
) -> Any:
    """Both directions, from the same orbit, as one branch; and its special points."""
    down = ways[0]
    up = ways[1] if len(ways) > 1 else down
    last = len(down.orbits) - 1
    order = [(down, k) for k in range(last, -1, -1)]
    special = [s._replace(after=last - 1 - s.after) for s in down.special]
    if len(ways) > 1:
        order += [(up, k) for k in range(1, len(up.orbits))]
        special += [s._replace(after=last + s.after) for s in up.special]
    multipliers = np.array([way.points.multipliers[k] for way, k in order])
    places = np.array([s.x for s in special]).reshape(len(special), multipliers.shape[1])
    variables = {
        "x": (("point", "state"), np.array([way.points.x[k] for way, k in order])),
        "stable": (("point",), np.array([way.orbits[k].stable for way, k in order], dtype=np.int8)),
        "multiplier_real": (("point", "state"), multipliers.real),
        "multiplier_imag": (("point", "state"), multipliers.imag),
        "multiplier_modulus": (("point", "state"), np.abs(multipliers)),
        "name": (("point",), np.array([way.orbits[k].name for way, k in order])),
        "special_kind": (("special",), np.array([s.kind for s in special], dtype=str)),
        "special_p": (("special",), np.array([s.p for s in special])),
        "special_x": (("special", "state"), places),
        "special_after": (("special",), np.array([s.after for s in special], dtype=np.int64)),
    }
    values = np.array([way.points.p[k] for way, k in order])
    attributes = provenance(scene, method) | {
        "parameter": parameter, "phase": down.phase, "range": p_range, "labels": list(scene.labels)
    }  # fmt: skip
    return labelled(variables, {parameter: (("point",), values)}, attributes)
