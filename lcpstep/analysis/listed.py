"""Impacts and landings of many runs as two long lists: however many a period has, none is left out.

A table with a place for every impact of every period would be as wide as the longest chattering sequence, and nearly
empty. Each impact carries where it belongs instead: the parameter's index, the run, the period, and its number in it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.maps.batch import Periods

Array = NDArray[np.float64]
Arrays = dict[str, Any]
PLACE = ("value", "run", "period", "number")  # where an impact or a landing belongs


def listed(found: Periods, period: float, value: int) -> Arrays:
    """The impacts and landings of runs at the `value`-th value of a parameter.

    Parameters
    ----------
    found : what became of the runs
    period : of the forcing [s]
    value : index of the parameter's value

    Returns
    -------
    impact_value, impact_run, impact_period, impact_number (from 1), impact_phase in [0, 1), impact_before,
    impact_after [m/s]; landing_value, .. landing_phase: arrays of one length each, in the order of time; also
    impact_contact and landing_contact, 0 of a system with modes
    """
    result: Arrays = {}
    for name, time, contact in (
        ("impact", found.time, found.struck),
        ("landing", found.landed, found.resting),
    ):
        run, kept, number = np.nonzero(np.isfinite(time))
        places = (np.full(len(run), value), run, kept, number + 1)
        result |= {f"{name}_{k}": x.astype(np.int32) for k, x in zip(PLACE, places, strict=True)}
        result[f"{name}_contact"] = contact[run, kept, number].astype(np.int32)
        result[f"{name}_phase"] = time[run, kept, number] / period % 1.0
        if name == "impact":
            result["impact_before"] = found.before[run, kept, number]
            result["impact_after"] = found.after[run, kept, number]
    return result


def joined(parts: list[Arrays]) -> Arrays:
    """The lists of many values as one, in the order of the values."""
    whole = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    order = {kind: np.argsort(whole[f"{kind}_value"], kind="stable") for kind in ("impact", "landing")}
    return {name: x[order[name.split("_")[0]]] for name, x in whole.items()}


def column(data: Any, name: str, k: int) -> tuple[Array, NDArray[np.int64]]:
    """One column of a diagram: `name` (such as "impact_phase") at the k-th value, and the period of each entry."""
    kind = name.split("_")[0]
    values = data[f"{kind}_value"].values
    here = slice(*np.searchsorted(values, [k, k + 1]))
    return data[name].values[here], data[f"{kind}_period"].values[here]
